"""A figure with the question that it answers and how to read it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # takes a third of a second to load
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class NamedFigure:
    """A figure with its name, question and caption.

    Attributes:
        name: Stem of the name of its file.
        question: The question that it answers, used as its heading.
        figure: The Matplotlib figure.
        caption: How to read it; may be empty.
    """

    name: str
    question: str
    figure: "Figure"
    caption: str = ""


@dataclass(frozen=True)
class FigureKind:
    """A kind of figure.

    Attributes:
        name: Stem of the name of its file.
        question: The question that it answers, used as its heading.
        caption: What the figure shows and how to read it.
    """

    name: str
    question: str
    caption: str

    def drawn(self, figure: "Figure") -> NamedFigure:
        """A figure of this kind."""
        return NamedFigure(self.name, self.question, figure, self.caption)
