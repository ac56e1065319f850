"""Says what a command is doing that takes seconds, and how long it will still take; beside its output, on stderr."""

import time
from collections.abc import Callable

from rich.console import Console

from hedon.cli.console import make_console
from hedon.cli.display.run import duration
from hedon.cli.display.screen import Screen
from hedon.text import printable

QUIET_SECONDS = 2.0
"""So long nothing is said, except on a terminal, where it goes away again [s]."""


class StepDisplay(Screen):
    """The steps of a command. Use it as a context manager, and call it before each step.

    Args:
        what: the command does.
        console: to print on; by default that of stderr.
        clock: the time now [s].
    """

    def __init__(self, what: str, console: Console | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(console or make_console(stderr=True), clock=clock)
        self._what, self._begun = what, clock()

    def __call__(self, done: int, of: int, step: str) -> None:
        """Says which step comes next, and by the time of those before how long all others take."""
        seconds = self._clock() - self._begun
        if not self.is_due() or (self._live is None and seconds < QUIET_SECONDS):
            return
        left = f", about {duration(seconds / done * (of - done))} left" if done and seconds > 1.0 else ""
        self.show(lambda: printable(f"hedon: {self._what}: {step}, step {done + 1} of {of}{left}"))
