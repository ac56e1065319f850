"""One run in its own process, which reports its progress to the parent process."""

import os
import signal
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING

from hedon.error import HedonError
from hedon.experiment.interrupt import SIGNALS
from hedon.experiment.plan import Display, Moment, RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.record.manifest import Manifest

if TYPE_CHECKING:  # it draws figures: a process that makes a run must not wait for that
    from hedon.replication.run.plan import Job


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
            os.kill(os.getpid(), signal.SIGTERM)


def work(job: "Job", threads: int, link: Connection) -> None:
    """Makes a job's run in a new process; see `answer`."""
    answer(link, lambda display: _make(job, threads, display).status)


def answer(link: Connection, make: Callable[[Display], str]) -> None:
    """Does some work that makes a run, and sends its moments and, at the end, its `Outcome`. Call it in a new process.

    The process leaves its parent's session: a terminal sends Ctrl-C only to the parent, which passes it on as soon as
    the run counts signals. The process starts with signals blocked and unblocks them here, so none ends it directly.

    Args:
        link: to the parent.
        make: gets a display for its moments, and returns the status of an `Outcome`.
    """
    os.setsid()
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    try:
        outcome = Outcome(make(_Teller(link)))
    except HedonError as error:
        outcome = Outcome("failed", str(error))
    with suppress(OSError):  # the parent may have ended; what is on disk says it too
        link.send(outcome)


def _make(job: "Job", threads: int, display: Display) -> Manifest:
    if job.begun:
        return resume(job.folder, job.steps, threads, display)
    return run(RunPlan(job.config, job.seeds, job.steps, job.folder, threads, job.frames), display)
