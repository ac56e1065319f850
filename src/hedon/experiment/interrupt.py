"""Counts Ctrl-C and SIGTERM, instead of raising an exception anywhere: the host loop checks the count."""

import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM)


@dataclass(slots=True)
class Interrupts:
    """How many times the user or the system has asked the run to end."""

    count: int = 0


@contextmanager
def count_interrupts() -> Iterator[Interrupts]:
    """Counts the signals that ask the run to end, until the block ends."""
    seen = Interrupts()

    def note(number: int, frame: Any) -> None:
        seen.count += 1

    with ExitStack() as stack:
        try:
            for number in SIGNALS:
                stack.callback(signal.signal, number, signal.signal(number, note))
        except ValueError:  # not in the main thread, where Python handles no signals
            pass
        yield seen
