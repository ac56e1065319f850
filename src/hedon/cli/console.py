"""The console that all commands print on."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

FILE_WIDTH = 110
"""Columns if the output goes to a file: wide enough for every table."""


def make_console() -> "Console":
    """A console as wide as the terminal, or wide enough for every table if there is no terminal."""
    from rich.console import Console

    console = Console(highlight=False)
    return console if console.is_terminal else Console(highlight=False, width=FILE_WIDTH)
