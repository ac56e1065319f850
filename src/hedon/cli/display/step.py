"""Progress of commands that take seconds: the current step and the remaining time, on stderr."""

import time
from collections.abc import Callable

from rich.console import Console

from hedon.cli.console import make_console
from hedon.cli.display.run import duration
from hedon.cli.display.screen import Screen
from hedon.text import printable

QUIET_SECONDS = 2.0
"""Time without any output, except on a terminal, where the output disappears at the end [s]."""


class StepDisplay(Screen):
    """Steps of a command. Use it as a context manager, and call it before each step.

    Args:
        what: Description of what the command does.
        console: Console to print on; by default stderr.
        clock: Function that returns the current time [s].
    """

    def __init__(self, what: str, console: Console | None = None, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(console or make_console(stderr=True), clock=clock)
        self._what, self._begun = what, clock()

    def __call__(self, done: int, of: int, step: str) -> None:
        """Announces the next step, and the remaining time, estimated from the steps done."""
        seconds = self._clock() - self._begun
        if not self.is_due() or (self._live is None and seconds < QUIET_SECONDS):
            return
        left = f", about {duration(seconds / done * (of - done))} left" if done and seconds > 1.0 else ""
        self.show(lambda: printable(f"hedon: {self._what}: {step}, step {done + 1} of {of}{left}"))
