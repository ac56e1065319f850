"""One run in its own process, which reports its progress to the parent process."""

import os
import signal
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection

from hedon.error import HedonError
from hedon.experiment.interrupt import SIGNALS
from hedon.experiment.plan import Moment, RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.record.manifest import Manifest
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


def work(job: Job, threads: int, link: Connection) -> None:
    """Makes a job's run, and sends its moments and, at the end, its `Outcome`. Call it in a new process.

    The process leaves its parent's session: a terminal sends Ctrl-C only to the parent, which passes it on as soon as
    the run counts signals. The process starts with signals blocked and unblocks them here, so none ends it directly.
    """
    os.setsid()
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    try:
        outcome = Outcome(_make(job, threads, _Teller(link)).status)
    except HedonError as error:
        outcome = Outcome("failed", str(error))
    with suppress(OSError):  # the parent may have ended; the manifest says it too
        link.send(outcome)


def _make(job: Job, threads: int, teller: _Teller) -> Manifest:
    if job.begun:
        return resume(job.folder, job.steps, threads, teller)
    return run(RunPlan(job.config, job.seeds, job.steps, job.folder, threads), teller)
