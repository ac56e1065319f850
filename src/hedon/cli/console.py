"""The console that all commands print on."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

FILE_WIDTH = 110
"""Columns of text if the output goes to a file, in which tables are as wide as they need be."""


def make_console(*, stderr: bool = False) -> "Console":
    """A console as wide as the terminal; without a terminal, it prints lines that are wider in full."""
    from rich.console import Console

    class FileConsole(Console):
        def print(self, *objects: Any, **options: Any) -> None:
            options["crop"] = False
            super().print(*objects, **options)

    def plain(kind: type[Console], width: int | None = None) -> Console:
        # What users name is printed as it is: brackets and colons in a name are no markup.
        return kind(highlight=False, markup=False, emoji=False, stderr=stderr, width=width)

    console = plain(Console)
    return console if stderr or console.is_terminal else plain(FileConsole, FILE_WIDTH)
