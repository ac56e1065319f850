"""Shows what changes: in its place on a terminal, as a plain line now and then elsewhere."""

import time
from collections.abc import Callable
from typing import Any, Self

from rich.console import Console, RenderableType
from rich.live import Live

TERMINAL_SECONDS = 0.2
LINE_SECONDS = 30.0


class Screen:
    """What displays of many runs have in common. Use it as a context manager.

    Args:
        console: to print on.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self._live = Live(console=console, auto_refresh=False, transient=True) if console.is_terminal else None
        self._due = 0.0

    def __enter__(self) -> Self:
        if self._live is not None:
            self._live.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        if self._live is not None:
            self._live.__exit__(*error)

    def is_due(self) -> bool:
        """Whether so much time has passed that something should be shown again."""
        return time.monotonic() >= self._due

    def show(self, line: Callable[[], str], picture: Callable[[], RenderableType]) -> None:
        """Shows a picture on a terminal, prints a line elsewhere; only the one that is shown is made.

        Args:
            line: Makes the line.
            picture: Makes the picture.
        """
        self._due = time.monotonic() + (LINE_SECONDS if self._live is None else TERMINAL_SECONDS)
        if self._live is None:
            self._console.print(line(), soft_wrap=True)
        else:
            self._live.update(picture(), refresh=True)
