"""Makes the runs of a plan, as many at a time as fill the processors, and passes on what ends them."""

import os
import signal
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path

from hedon.experiment.interrupt import SIGNALS, count_interrupts
from hedon.experiment.plan import Moment
from hedon.reproduce.plan import Job
from hedon.reproduce.progress import PlanDisplay
from hedon.reproduce.work import Outcome, work

_LOOK_SECONDS = 0.2
"""Longest time without a look at the keyboard [s]."""


@dataclass
class _Worker:
    """A process at work on a job.

    Attributes:
        job: that it makes.
        process, link: the process and the end of the pipe that it tells by.
        told: how many signals were passed on to it.
        ready: whether its run has begun, so that it counts signals.
    """

    job: Job
    process: BaseProcess
    link: Connection
    told: int = 0
    ready: bool = False


def conduct(jobs: Sequence[Job], threads: int, display: PlanDisplay) -> dict[Path, Outcome]:
    """Makes the runs, each in a process of its own.

    Ctrl-C or SIGTERM ends every run after its window, a second one at once; jobs that have not begun stay undone. A run
    that fails leaves the others alone.

    Args:
        jobs: in the order in which they begin.
        threads: to use in all.
        display: is told of every moment and end.

    Returns:
        How each job ended, by its run's folder; jobs that never began are missing.
    """
    together = parallel_runs(jobs, threads)
    waiting, workers = list(jobs), list[_Worker]()
    outcomes: dict[Path, Outcome] = {}
    with count_interrupts() as interrupted:
        while workers or (waiting and not interrupted.count):
            while waiting and len(workers) < together and not interrupted.count:
                workers.append(_start(waiting.pop(0), max(1, threads // together)))
            for link in wait([worker.link for worker in workers], _LOOK_SECONDS):
                worker = next(worker for worker in workers if worker.link is link)
                if (outcome := _hear(worker, display)) is not None:
                    worker.process.join()
                    workers.remove(worker)
                    outcomes[worker.job.folder] = outcome
                    display.end(worker.job, outcome)
            for worker in workers:
                while worker.ready and worker.told < interrupted.count:
                    worker.told += 1
                    os.kill(worker.process.pid or 0, signal.SIGINT)
    return outcomes


def parallel_runs(jobs: Sequence[Job], threads: int) -> int:
    """How many runs go on at a time: as many as leave every world of the largest a thread of its own."""
    largest = max((len(job.seeds) for job in jobs), default=1)
    return max(1, min(len(jobs), threads // largest))


def _start(job: Job, threads: int) -> _Worker:
    context = get_context("spawn")  # a fork would copy the engine's threads half
    ours, theirs = context.Pipe()
    process = context.Process(target=work, args=(job, threads, theirs), name=job.folder.name)
    with _blocked_signals():
        process.start()
    theirs.close()
    return _Worker(job, process, ours)


@contextmanager
def _blocked_signals() -> Iterator[None]:
    """Holds signals back, so that a new process begins with them blocked; they reach this one afterwards."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _hear(worker: _Worker, display: PlanDisplay) -> Outcome | None:
    """What a worker says: a moment, which is shown, or how it ended."""
    try:
        said = worker.link.recv()
    except (EOFError, OSError):  # gone without a word: killed, by the system for want of memory for example
        worker.process.join()
        return Outcome("failed", f"its process ended with exit code {worker.process.exitcode}")
    if isinstance(said, Moment):
        worker.ready = True
        display.update(worker.job, said)
        return None
    return said
