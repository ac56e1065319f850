"""Counts signals and closed pipes instead of raising exceptions; the host loop checks the count."""

import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
PIPE = 13
"""Number of the signal SIGPIPE, which Windows lacks. Python ignores the signal, and a write reveals a closed pipe."""
_noted: list[int] = []
"""Signals that this process has counted; the last one sets the exit code of a command."""
_counting: list["Interrupts"] = []
"""Active counters."""


@dataclass(slots=True)
class Interrupts:
    """Number of times that the user or the system has asked the run to end."""

    count: int = 0


@contextmanager
def count_interrupts() -> Iterator[Interrupts]:
    """Counts the signals that ask the run to end, until the block ends. A pipe closed before counts too."""
    interrupts = Interrupts(_noted.count(PIPE))
    with ExitStack() as stack:
        _counting.append(interrupts)
        stack.callback(_counting.remove, interrupts)
        try:
            for number in SIGNALS:
                if number != signal.SIGINT and signal.getsignal(number) is signal.SIG_IGN:
                    continue  # nohup ignores SIGHUP so that its process survives
                stack.callback(signal.signal, number, signal.signal(number, lambda number, frame: note(number)))
        except ValueError:  # not in the main thread, where Python handles no signals
            pass
        yield interrupts


def note(number: int) -> None:
    """Counts a signal or an equivalent event."""
    _noted.append(number)
    for interrupts in _counting:
        interrupts.count += 1


def interrupted_code() -> int:
    """Exit code of a command that a signal has ended early, by the shells' convention: 128 plus the signal's number."""
    return 128 + (_noted[-1] if _noted else signal.SIGINT)
