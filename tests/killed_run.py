"""A run in a separate process, to be killed: small, but with several worlds, frames, births and deaths."""

import multiprocessing
import signal
import sys
import traceback
from multiprocessing.process import BaseProcess
from pathlib import Path

from resumed_run import small_run

from hedon.experiment.resume import resume
from hedon.record.folder import holds_run

FAULT = 3
"""Exit code of a process that failed."""
STEPS = 1500
SEEDS = (1, 2)

_context = multiprocessing.get_context("forkserver")
_context.set_forkserver_preload(["hedon.experiment.resume", "hedon.experiment.run", "pydantic"])


def go(folder: Path, checkpoint_seconds: float = 0.0) -> None:
    """Starts the run, or resumes it if the folder holds one. By default, a checkpoint follows every piece."""
    if holds_run(folder):
        resume(folder, threads=1, checkpoint_seconds=checkpoint_seconds)
    else:
        small_run(folder, STEPS, seeds=SEEDS, frames=50, checkpoint_seconds=checkpoint_seconds)


def start(folder: Path) -> BaseProcess:
    """Runs `go` in a new process, forked from one that has already imported everything."""
    process = _context.Process(target=_go_in_process, args=(folder,))
    process.start()
    return process


def _go_in_process(folder: Path) -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # until the run handles Ctrl-C, it ends the process at once
    try:
        go(folder)
    except Exception:
        traceback.print_exc()
        sys.exit(FAULT)
