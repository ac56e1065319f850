"""One run in a process of its own, which tells its parent how it goes."""

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
from hedon.reproduce.plan import Job


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
    """Sends every moment to the parent; ends the run, with all results kept, where no parent is left to hear it."""

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
    """Makes a job's run, and sends its moments and at last its `Outcome`. To be called in a new process.

    The process leaves its parent's session: a terminal sends Ctrl-C to the parent alone, who passes it on once the
    run can hear it. Signals come blocked from the parent and count from here on, so none ends the process by itself.
    """
    os.setsid()
    for number in SIGNALS:
        signal.signal(number, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, SIGNALS)
    try:
        outcome = Outcome(_make(job, threads, _Teller(link)).status)
    except HedonError as error:
        outcome = Outcome("failed", str(error))
    with suppress(OSError):  # nobody may be left to hear it; the manifest says it too
        link.send(outcome)


def _make(job: Job, threads: int, teller: _Teller) -> Manifest:
    if job.begun:
        return resume(job.folder, job.steps, threads, teller)
    return run(RunPlan(job.config, job.seeds, job.steps, job.folder, threads), teller)
