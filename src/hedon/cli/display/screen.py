"""Shows what changes: in its place on a terminal, as a plain line now and then elsewhere."""

import time
from collections.abc import Callable
from typing import Any, Self

from rich.console import Console, RenderableType
from rich.live import Live
from rich.text import Text

TERMINAL_SECONDS = 0.2
LINE_SECONDS = 30.0


class Screen:
    """What all displays of progress have in common. Use it as a context manager.

    Args:
        console: to print on.
        line_seconds: between two lines, where there is no terminal [s].
        clock: the time now [s].
    """

    def __init__(
        self, console: Console, line_seconds: float = LINE_SECONDS, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._console = console
        self._live = Live(console=console, auto_refresh=False, transient=True) if console.is_terminal else None
        self._gap = line_seconds if self._live is None else TERMINAL_SECONDS
        self._clock = clock
        self._due = 0.0

    def __enter__(self) -> Self:
        if self._live is not None:
            self._live.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        if self._live is not None:
            self._live.__exit__(*error)

    def is_due(self) -> bool:
        """Whether enough time has passed to show something again."""
        return self._clock() >= self._due

    def show(self, line: Callable[[], str], picture: Callable[[], RenderableType] | None = None) -> None:
        """Shows a picture on a terminal, prints a line elsewhere; only the one that is shown is made."""
        self._due = self._clock() + self._gap
        if self._live is None:
            self._console.print(Text(line()), soft_wrap=True)
        else:
            self._live.update(Text(line()) if picture is None else picture(), refresh=True)
