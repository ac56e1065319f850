"""Continues a run that was interrupted, killed or finished, with the same bits as if it had never stopped."""

import os
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from hedon.config.dump import digest
from hedon.config.load import load_config
from hedon.experiment import argument
from hedon.experiment.checkpoint import check_head, require_undriven, restore, same_backend
from hedon.experiment.device import device_problem, is_device
from hedon.experiment.interrupt import count_interrupts
from hedon.experiment.memory import require_memory
from hedon.experiment.plan import Callback, RunPlan, together
from hedon.experiment.recorder import Start
from hedon.experiment.rule import changed_files
from hedon.experiment.run import advance, run, set_initial_state
from hedon.experiment.session import next_manifest
from hedon.experiment.simulation import BACKEND_VARIABLE, Simulation
from hedon.record.checkpoint import Checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import CHECKPOINT_SECONDS, CONFIG, holds_run
from hedon.record.founder_table import load_founders
from hedon.record.lock import FolderLock
from hedon.record.manifest import Manifest
from hedon.record.network import load_networks
from hedon.record.provenance import git_revision
from hedon.record.reader import open_run
from hedon.record.rollback import find_checkpoint, roll_back, verify_parts
from hedon.record.writer import Writer
from hedon.text import brief


@dataclass(frozen=True, slots=True)
class Resumption:
    """A run that is ready to continue.

    Attributes:
        plan: Plan of the run, with the total steps.
        manifest: Manifest from the last session.
        checkpoint: Where it continues; None for a run that was killed before its first checkpoint.
        notes: Messages for the user, such as on a damaged checkpoint or a changed source.
    """

    plan: RunPlan
    manifest: Manifest
    checkpoint: Checkpoint | None
    notes: tuple[str, ...]

    @property
    def step(self) -> int:
        """Step at which it continues."""
        return self.checkpoint.head.step if self.checkpoint else 0


@contextmanager
def lock(
    folder: Path | str, steps: int | None = None, threads: int = 0, checkpoint_seconds: float = CHECKPOINT_SECONDS
) -> Iterator[Resumption]:
    """Locks a run's folder and plans how the run continues. Changes nothing else; see `continue_run`.

    Args:
        folder: Folder of the run.
        steps: Total steps of each world; None for the last session's total.
        threads: Number of threads; 0 for all processors. Changes no result.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.

    Raises:
        RecordError: The folder is not a run or is in use, no steps are left, or the checkpoint does not fit; the
            message gives the reason.
        ConfigError: Its config cannot be read.
        FounderError: Its table of founders cannot be read.
        NetworkError: Its file of networks cannot be read.
        ArgumentError: A number is out of bounds.
    """
    folder = argument.folder("folder", folder)
    open_run(folder)  # before the lock, which creates the folder
    with FolderLock(folder):
        manifest = open_run(folder).manifest
        config = load_config(folder / CONFIG)
        require_undriven(folder, config)
        checkpoint, faults = find_checkpoint(folder)
        if checkpoint is not None:
            check_head(checkpoint.head, config, manifest.seeds, f"the checkpoint of {folder}")
            verify_parts(folder, checkpoint.head.parts)
        total = manifest.steps_asked if steps is None else argument.integer("steps", steps, 1, argument.MAX_STEPS)
        founders, networks = load_founders(folder, config), load_networks(folder, config)
        plan = RunPlan(
            config,
            manifest.seeds,
            total,
            folder,
            threads,
            manifest.frames,
            checkpoint_seconds,
            founders,
            networks,
            rules=manifest.rules,
        )
        notes = [f"{fault}: continuing from the checkpoint before it" for fault in faults]
        notes += [*_device_notes(manifest), *_source_notes(manifest), *_rule_notes(manifest)]
        resumption = Resumption(plan, manifest, checkpoint, tuple(notes))
        _check_steps(resumption)
        yield resumption


def resume(
    folder: Path | str,
    steps: int | None = None,
    threads: int = 0,
    callbacks: Iterable[Callback] = (),
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
) -> Manifest:
    """Continues a run from its newest undamaged checkpoint. Later records are removed and computed again.

    Args:
        folder: Folder of the run.
        steps: Total steps of each world; None for the last session's total.
        threads: Number of threads; 0 for all processors. Changes no result.
        callbacks: Functions of a `Moment`, called about five times a second and at the end.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.

    Returns:
        The manifest as saved at the end.

    Raises:
        RecordError: As in `lock`, or the folder cannot be written.
        ArgumentError: As in `lock`.
        MemoryNeedError: The run needs more memory than there is.
        EngineError: A world reports an error.
    """
    with lock(folder, steps, threads, checkpoint_seconds) as resumption:
        return continue_run(resumption, callbacks)


def make(plan: RunPlan, callbacks: Iterable[Callback] = ()) -> Manifest:
    """Completes the run of a plan: starts it, continues it, or only reads it if it is finished.

    Raises:
        RecordError: The folder holds a run with other settings, founders or seeds.
        HedonError: As in `run` and `resume`.
    """
    if not holds_run(plan.out):
        return run(plan, callbacks)
    require_setting(plan.out, digest(plan.config), plan.seeds)
    manifest = open_run(plan.out).manifest
    if is_finished(manifest, plan.steps):
        return manifest
    steps = max(plan.steps, *manifest.steps_done, 1)
    return resume(plan.out, steps, plan.threads, callbacks, plan.checkpoint_seconds)


def is_finished(manifest: Manifest, steps: int) -> bool:
    """Whether a run has completed its steps, or all its worlds have died out.

    Args:
        manifest: Manifest of the run.
        steps: Number of steps that it should have [step].
    """
    all_extinct = bool(manifest.extinct_steps) and None not in manifest.extinct_steps
    return manifest.status == "finished" and (all_extinct or max(manifest.steps_done) >= steps)


def require_setting(folder: Path, config_digest: str, seeds: Sequence[int] | None = None) -> None:
    """Refuses a folder that holds a run of another condition.

    Raises:
        RecordError: The run has other settings, founders or seeds.
    """
    if not holds_run(folder):
        return
    manifest = open_run(folder).manifest
    if manifest.config_digest != config_digest or seeds not in (None, manifest.seeds):
        raise RecordError(
            f"{brief(str(folder))} holds a run with other settings, founders or seeds: give another folder with --out"
        )


def continue_run(found: Resumption, callbacks: Iterable[Callback] = ()) -> Manifest:
    """Continues a run that `lock` has locked; see `resume`.

    Returns:
        The manifest as saved at the end.

    Raises:
        RecordError: The checkpoint does not fit, or the folder cannot be written.
        MemoryNeedError: The run needs more memory than there is.
        EngineError: A world reports an error.
    """
    plan, checkpoint = found.plan, found.checkpoint
    with count_interrupts() as interrupted:
        require_memory(plan.config, len(plan.seeds), plan.threads)
        backend = same_backend(found.manifest.backend)
        simulation = Simulation(plan.config, plan.seeds, plan.threads, backend, plan.rules)
        start = Start()
        if checkpoint is None:
            set_initial_state(simulation, plan)
        else:
            start = restore(simulation, checkpoint, f"the checkpoint of {plan.out}")
        parts = checkpoint.head.parts if checkpoint else {}
        roll_back(plan.out, parts, start.step)
        manifest = next_manifest(found.manifest, plan, simulation, start.step)
        with Writer(plan.out, "", manifest, parts=parts) as writer:
            return advance(simulation, plan, manifest, writer, start, together(callbacks), interrupted)


def _device_notes(manifest: Manifest) -> list[str]:
    """A note if the run's device cannot be used to continue it."""
    backend = manifest.backend
    if backend is None or not is_device(backend) or os.environ.get(BACKEND_VARIABLE):
        return []
    problem = device_problem(backend)
    return [f"{problem}: continuing on the processor, with the same bits"] if problem else []


def _check_steps(resumption: Resumption) -> None:
    plan, manifest, step = resumption.plan, resumption.manifest, resumption.step
    finished = manifest.status == "finished"
    if finished and all(extinct is not None for extinct in manifest.extinct_steps):
        raise RecordError(
            f"{plan.out} is finished: every world has died out, the last at step {max(manifest.steps_done):,}"
        )
    if finished and plan.steps == step:
        raise RecordError(f"{plan.out} has already done all its {step:,} steps: give a larger total with --steps")
    if plan.steps < step:
        raise RecordError(
            f"--steps: {plan.out} has already done {step:,} steps, which is more than the total of {plan.steps:,}"
        )


def _source_notes(manifest: Manifest) -> list[str]:
    """A note if hedon's source has changed since, which can change results."""
    previous = manifest.sessions[-1].git_revision if manifest.sessions else manifest.git_revision
    current, _ = git_revision(Path(__file__).resolve().parent)
    if previous is None or current is None or previous == current:
        return []
    return [
        f"hedon's source has changed since (revision {previous[:12]}, now {current[:12]}): "
        "only the same source is certain to give the same results"
    ]


def _rule_notes(manifest: Manifest) -> list[str]:
    """Notes on rules whose files have changed since, which changes nothing."""
    return [
        f"{path} has changed since: continuing with the text that the manifest keeps "
        "(`hedon branch --set` goes on with another)"
        for path in changed_files(manifest.rules)
    ]
