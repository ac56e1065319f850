"""Defines a job, and runs one in its own process, which reports its progress to the parent process."""

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
    """A picklable task that makes a run, identified by the folder of the run.

    It continues from its last checkpoint, which another machine may have written.
    """

    @property
    def folder(self) -> Path:
        """The folder of its run."""
        ...

    @property
    def seeds(self) -> Sequence[int]:
        """The seeds of its worlds."""
        ...

    @property
    def steps(self) -> int:
        """The total number of steps of each world [step]."""
        ...

    @property
    def world_steps(self) -> int:
        """Steps still to run, summed over its worlds, if none dies out [step]."""
        ...

    @property
    def threads(self) -> int:
        """The number of threads that it should get; the last of several jobs gets all free threads."""
        ...

    @property
    def label(self) -> str:
        """Its name in displays."""
        ...

    def newest(self) -> str:
        """The name of the checkpoint from which it would continue; empty if there is none."""
        ...

    def describe(self) -> str:
        """A short description of its worlds."""
        ...

    def make(self, threads: int, callback: Callback | None) -> str:
        """Starts, continues, or only reads its run.

        Args:
            threads: Threads of the engine.
            callback: Called with moments of the run, if not None.

        Returns:
            The status of an `Outcome`.

        Raises:
            HedonError: The run fails.
        """
        ...


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a job ended.

    Attributes:
        status: "finished" or "interrupted", as in the manifest, or "failed".
        fault: Why the job failed; empty otherwise.
    """

    status: str
    fault: str = ""


class _Teller:
    """Sends every moment to the parent; if the parent has ended, stops the run and keeps all results."""

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
    """Runs a job, and sends its moments and finally its `Outcome`. Call it in a new process.

    The process leaves the terminal, so Ctrl-C reaches only the parent, which forwards it through the pipe once the run
    counts signals. The process starts with signals blocked and unblocks them here, so no signal ends it directly.

    Args:
        job: The job to run.
        threads: Threads of the engine.
        link: The process's end of the pipe to the parent.
    """
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    _leave_terminal()
    Thread(target=_listen, args=(link,), daemon=True).start()
    outcome = attempt(job, threads, _Teller(link).update)
    with suppress(OSError):  # the parent may have ended; the records on disk show the outcome too
        link.send(outcome)


def _leave_terminal() -> None:
    if sys.platform == "win32":
        import ctypes

        ctypes.windll.kernel32.SetConsoleCtrlHandler(None, True)  # no Ctrl-C from now on
    else:
        os.setsid()
        signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)


def _listen(link: Connection) -> None:
    """Treats every number that the parent sends like a signal, until the parent has ended."""
    with suppress(EOFError, OSError):
        while True:
            _thread.interrupt_main(link.recv())


def attempt(job: Job, threads: int, callback: Callback | None = None) -> Outcome:
    """Runs a job in this process. A failure of the job is returned as an outcome.

    Args:
        job: The job to run.
        threads: Threads of the engine.
        callback: Called with moments of the run, if not None.
    """
    try:
        return Outcome(job.make(threads, callback))
    except HedonError as error:
        return Outcome("failed", str(error))
