"""What a job is, and one job in its own process, which reports its progress to the parent process."""

import _thread
import os
import signal
import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from threading import Thread
from typing import Protocol

from hedon.error import HedonError
from hedon.experiment.interrupt import SIGNALS
from hedon.experiment.plan import Callback, Moment


class Job(Protocol):
    """Something that makes a run; it can be pickled, and the folder of its run tells it from the others.

    It continues from its last checkpoint, also from one that another machine wrote.
    """

    @property
    def folder(self) -> Path:
        """The folder of its run."""
        ...

    @property
    def seeds(self) -> Sequence[int]:
        """Of its worlds."""
        ...

    @property
    def steps(self) -> int:
        """Of each world in the end [step]."""
        ...

    @property
    def world_steps(self) -> int:
        """Steps still to run, summed over its worlds, if none dies out [step]."""
        ...

    @property
    def threads(self) -> int:
        """Most threads that it can use; the last job of several gets all that are free."""
        ...

    @property
    def label(self) -> str:
        """Its name in displays."""
        ...

    def newest(self) -> str:
        """The name of the last checkpoint from which it would go on; empty where there is none."""
        ...

    def describe(self) -> str:
        """What its worlds are, in a few words."""
        ...

    def make(self, threads: int, callback: Callback | None) -> str:
        """Begins, continues, or only reads its run.

        Returns:
            The status of an `Outcome`.

        Raises:
            HedonError: it fails.
        """
        ...


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a job ended.

    Attributes:
        status: "finished" or "interrupted", as in the manifest; or "failed".
        fault: why it failed; empty otherwise.
    """

    status: str
    fault: str = ""


class _Teller:
    """Sends every moment to the parent; if there is no parent any more, ends the run with all results kept."""

    def __init__(self, link: Connection) -> None:
        self._link = link
        self._alone = False

    def update(self, moment: Moment) -> None:
        if self._alone:
            return
        try:
            self._link.send(moment)
        except OSError:
            self._alone = True
            signal.raise_signal(signal.SIGTERM)


def work(job: Job, threads: int, link: Connection) -> None:
    """Does a job, and sends its moments and, at the end, its `Outcome`. Call it in a new process.

    The process leaves the terminal: Ctrl-C reaches only the parent, which passes it on by the pipe as soon as the run
    counts signals. The process starts with signals blocked and unblocks them here, so none ends it directly.
    """
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    _leave_terminal()
    Thread(target=_listen, args=(link,), daemon=True).start()
    outcome = attempt(job, threads, _Teller(link).update)
    with suppress(OSError):  # the parent may have ended; what is on disk says it too
        link.send(outcome)


def _leave_terminal() -> None:
    if sys.platform == "win32":
        import ctypes

        ctypes.windll.kernel32.SetConsoleCtrlHandler(None, True)  # no Ctrl-C from now on
    else:
        os.setsid()
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


def _listen(link: Connection) -> None:
    """Does for every number that the parent sends what a signal would, until the parent has ended."""
    with suppress(EOFError, OSError):
        while True:
            _thread.interrupt_main(link.recv())


def attempt(job: Job, threads: int, callback: Callback | None = None) -> Outcome:
    """Does a job in this process. A fault of the job is an outcome."""
    try:
        return Outcome(job.make(threads, callback))
    except HedonError as error:
        return Outcome("failed", str(error))
