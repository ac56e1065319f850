"""Shows changing output: updated in place on a terminal, as occasional plain lines elsewhere."""

import time
from collections.abc import Callable
from typing import Any, Self

from rich.console import Console, RenderableType
from rich.live import Live
from rich.text import Text

TERMINAL_SECONDS = 0.2
LINE_SECONDS = 30.0


class Screen:
    """Base of all progress displays. Use it as a context manager.

    Args:
        console: Console to print on.
        line_seconds: Time between two lines without a terminal [s].
        clock: Function that returns the current time [s].
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
        """Shows a picture on a terminal or prints a line elsewhere; creates only the one needed."""
        self._due = self._clock() + self._gap
        if self._live is None:
            self._console.print(Text(line()), soft_wrap=True)
        else:
            self._live.update(Text(line()) if picture is None else picture(), refresh=True)
