"""Counts Ctrl-C, SIGTERM and SIGHUP, instead of raising an exception anywhere: the host loop checks the count."""

import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
_noted: list[int] = []
"""The signals that this process has counted, so that a command can end with the exit code of the last one."""


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
        _noted.append(number)

    with ExitStack() as stack:
        try:
            for number in SIGNALS:
                if number != signal.SIGINT and signal.getsignal(number) is signal.SIG_IGN:
                    continue  # nohup ignores SIGHUP, and what it starts must live on
                stack.callback(signal.signal, number, signal.signal(number, note))
        except ValueError:  # not in the main thread, where Python handles no signals
            pass
        yield seen


def interrupted_code() -> int:
    """The exit code of a command that a signal has ended early, as shells have it: 128 plus the signal's number."""
    return 128 + (_noted[-1] if _noted else signal.SIGINT)
