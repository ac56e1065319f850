"""Runs jobs in processes, as many at a time as fill the processors, and forwards Ctrl-C and SIGTERM to them."""

import signal
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

from hedon.ensemble.job import Job, Outcome, work
from hedon.experiment.interrupt import SIGNALS, count_interrupts
from hedon.experiment.plan import Moment
from hedon.record.provenance import usable_cpus

_LOOK_SECONDS = 0.2
"""Longest time between two checks for Ctrl-C [s]."""


T = TypeVar("T", bound=Job)
T_contra = TypeVar("T_contra", contravariant=True)


@dataclass
class _Worker(Generic[T]):
    """A process that works on a job.

    Attributes:
        job: The job that it works on.
        threads: Number of threads that it uses.
        process, link: The process, and our end of the pipe to it.
        told: Number of signals forwarded to it.
        ready: Whether its run has started, so that it counts signals.
    """

    job: T
    threads: int
    process: BaseProcess
    link: Connection
    told: int = 0
    ready: bool = False


class JobListener(Protocol[T_contra]):
    """Is notified of the progress and the end of several runs; for example, a progress display."""

    def update(self, job: T_contra, moment: Moment) -> None:
        """Shows a moment of a run; called about five times a second for each."""
        ...

    def end(self, job: T_contra, outcome: Outcome) -> None:
        """Shows how a run ended."""
        ...


def make_jobs(
    jobs: Sequence[T], display: JobListener[T], threads: int = 0, ray: str | None = None
) -> dict[Path, Outcome]:
    """Runs jobs, each in its own process; runs that were started before are continued.

    Args:
        jobs: The jobs to run.
        display: Listener that is notified of each job's end and, on this machine, of its progress.
        threads: Threads on this machine, or processors of a local cluster; 0 for all.
        ray: Address of a Ray cluster; None to run on this machine.

    Returns:
        How each job ended, by the folder of its run; jobs that never started are missing.

    Raises:
        EnsembleError: Ray is not installed, or there is no cluster at the address.
    """
    if ray is None:
        return make_here(jobs, threads or usable_cpus(), display)
    from hedon.ensemble.cluster import make_on_ray

    return make_on_ray(jobs, ray, display, threads)


def make_here(jobs: Sequence[T], threads: int, display: JobListener[T]) -> dict[Path, Outcome]:
    """Runs jobs, each in its own process, as many at a time as fill the threads.

    Ctrl-C or SIGTERM stops every run after its current window, and a second signal stops it immediately; jobs that have
    not started are not run. A run that fails does not stop the others.

    Args:
        jobs: The jobs to run, in this order.
        threads: Threads to divide among the processes.
        display: Listener that is notified of each job's progress and end.

    Returns:
        How each job ended, by the folder of its run; jobs that never started are missing.
    """
    waiting, workers = list(jobs), list[_Worker[T]]()
    outcomes: dict[Path, Outcome] = {}
    if sys.platform != "win32":
        # Otherwise Python would start this helper with the first process, and unblock signals at that moment.
        resource_tracker.ensure_running()
    with count_interrupts() as interrupted:
        while workers or (waiting and not interrupted.count):
            while not interrupted.count and (
                thread_count := next_share(waiting, [w.threads for w in workers], threads)
            ):
                workers.append(_start(waiting.pop(0), thread_count))
            for link in wait([worker.link for worker in workers], _LOOK_SECONDS):
                worker = next(worker for worker in workers if worker.link is link)
                if (outcome := _hear(worker, display)) is not None:
                    worker.process.join()
                    worker.link.close()
                    workers.remove(worker)
                    outcomes[worker.job.folder] = outcome
                    display.end(worker.job, outcome)
            for worker in workers:
                while worker.ready and worker.told < interrupted.count:
                    _pass_on(worker)
    return outcomes


def next_share(waiting: Sequence[Job], taken: Sequence[int], threads: int) -> int:
    """Threads for the next job: as many as it can use, all free ones for the last job, or 0 if it must wait."""
    if not waiting:
        return 0
    free, needed = threads - sum(taken), min(waiting[0].threads, threads)
    if free < needed:
        return 0
    return free if len(waiting) == 1 else needed


def _pass_on(worker: _Worker[Any]) -> None:
    """Forwards one signal through the pipe, since Windows has no signals between processes."""
    worker.told += 1
    with suppress(OSError):  # it has just ended, and its last message is still in the pipe
        worker.link.send(SIGNALS[0])


def _start(job: T, threads: int) -> _Worker[T]:
    context = get_context("spawn")  # a fork would copy the engine's memory without its threads
    parent_link, child_link = context.Pipe()
    process = context.Process(target=work, args=(job, threads, child_link), name=job.folder.name)
    with _blocked_signals():
        process.start()
    child_link.close()
    return _Worker(job, threads, process, parent_link)


@contextmanager
def _blocked_signals() -> Iterator[None]:
    """Blocks signals, so that a new process starts with them blocked; this process receives them afterwards."""
    if sys.platform == "win32":  # a new process receives Ctrl-C until it leaves the terminal
        yield
        return
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


def _hear(worker: _Worker[T], display: JobListener[T]) -> Outcome | None:
    """Reads one message of a worker: a moment, which is displayed, or the outcome of its run, which is returned."""
    try:
        message = worker.link.recv()
    except (EOFError, OSError):  # it ended without a message, for example because it was killed for lack of memory
        worker.process.join()
        code = worker.process.exitcode or 0
        cause = (
            f"was killed by signal {-code}, perhaps because memory ran out"
            if code < 0
            else f"ended with exit code {code}"
        )
        return Outcome("failed", f"its process {cause}; the same command continues it")
    if isinstance(message, Moment):
        worker.ready = True
        display.update(worker.job, message)
        return None
    return message
