"""The console that all commands print on."""

from functools import partial
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

FILE_WIDTH = 110
"""Columns if the output goes to a file: wide enough for every table."""


def make_console(*, stderr: bool = False) -> "Console":
    """A console as wide as the terminal, or wide enough for every table if there is no terminal."""
    from rich.console import Console

    # What users name is printed as it is: brackets and colons in a name are no markup.
    plain = partial(Console, highlight=False, markup=False, emoji=False, stderr=stderr)
    console = plain()
    return console if stderr or console.is_terminal else plain(width=FILE_WIDTH)
