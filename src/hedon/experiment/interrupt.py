"""Counts signals and closed pipes, instead of raising an exception anywhere: the host loop checks the count."""

import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

SIGNALS = (signal.SIGINT, signal.SIGTERM, *([signal.SIGHUP] if hasattr(signal, "SIGHUP") else []))
PIPE = 13
"""The number of the signal SIGPIPE, which Windows does not know. Python ignores it: a write tells of a closed pipe."""
_noted: list[int] = []
"""The signals that this process has counted, so that a command can end with the exit code of the last one."""
_counting: list["Interrupts"] = []
"""Those who count now."""


@dataclass(slots=True)
class Interrupts:
    """How many times the user or the system has asked the run to end."""

    count: int = 0


@contextmanager
def count_interrupts() -> Iterator[Interrupts]:
    """Counts the signals that ask the run to end, until the block ends. A pipe that was closed before counts too."""
    seen = Interrupts(_noted.count(PIPE))
    with ExitStack() as stack:
        _counting.append(seen)
        stack.callback(_counting.remove, seen)
        try:
            for number in SIGNALS:
                if number != signal.SIGINT and signal.getsignal(number) is signal.SIG_IGN:
                    continue  # nohup ignores SIGHUP, and what it starts must live on
                stack.callback(signal.signal, number, signal.signal(number, lambda number, frame: note(number)))
        except ValueError:  # not in the main thread, where Python handles no signals
            pass
        yield seen


def note(number: int) -> None:
    """Counts a signal, or what amounts to one."""
    _noted.append(number)
    for seen in _counting:
        seen.count += 1


def interrupted_code() -> int:
    """The exit code of a command that a signal has ended early, as shells have it: 128 plus the signal's number."""
    return 128 + (_noted[-1] if _noted else signal.SIGINT)
