"""The console for the output of all commands."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rich.console import Console

FILE_WIDTH = 110
"""Width of output to a file [characters]; tables may be wider."""


def make_console(*, stderr: bool = False) -> "Console":
    """A console as wide as the terminal; without a terminal, wider lines are printed in full."""
    from rich.console import Console

    class FileConsole(Console):
        def print(self, *objects: Any, **options: Any) -> None:
            options["crop"] = False
            super().print(*objects, **options)

    def plain(kind: type[Console], width: int | None = None) -> Console:
        # Names from users are printed literally: brackets and colons in them are not markup.
        return kind(highlight=False, markup=False, emoji=False, stderr=stderr, width=width)

    console = plain(Console)
    return console if stderr or console.is_terminal else plain(FileConsole, FILE_WIDTH)
