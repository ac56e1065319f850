"""A figure with the question that it answers and how it is read."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # takes a third of a second to load
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class NamedFigure:
    """A figure.

    Attributes:
        name: names its file.
        question: that it answers, its heading.
        figure: itself.
        caption: how to read it; may be empty.
    """

    name: str
    question: str
    figure: "Figure"
    caption: str = ""


@dataclass(frozen=True)
class FigureKind:
    """A kind of figure.

    Attributes:
        name: names its file.
        question: that it answers, its heading.
        caption: what is drawn and how to read it.
    """

    name: str
    question: str
    caption: str

    def drawn(self, figure: "Figure") -> NamedFigure:
        """A figure of this kind."""
        return NamedFigure(self.name, self.question, figure, self.caption)
