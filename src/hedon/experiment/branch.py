"""Continues from a checkpoint of a run with changed settings, as a new run that records its parent."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hedon.config.config import Config
from hedon.config.dump import diff, digest
from hedon.config.fixed import fixed_path
from hedon.config.load import load_config
from hedon.error import ArgumentError
from hedon.experiment import argument
from hedon.experiment.checkpoint import check_head, require_undriven, restore, same_backend
from hedon.experiment.interrupt import count_interrupts
from hedon.experiment.memory import require_memory
from hedon.experiment.plan import Callback, RunPlan, free_folder, together
from hedon.experiment.run import start_run
from hedon.experiment.session import first_manifest
from hedon.experiment.simulation import Simulation
from hedon.record.checkpoint import Checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import CHECKPOINT_SECONDS, CONFIG
from hedon.record.founder_table import load_founders
from hedon.record.manifest import Manifest, Parent
from hedon.record.network import load_networks
from hedon.record.provenance import to_unicode
from hedon.record.reader import open_run
from hedon.record.rollback import find_checkpoint
from hedon.record.schema import columns_of


@dataclass(frozen=True, slots=True)
class BranchPlan:
    """A branch that is ready to start.

    Attributes:
        run: Plan of the new run, with the total steps.
        parent: Run and step from which it starts.
        checkpoint: Worlds from which it starts.
        backend: Instruction set to use.
        only: Index of the parent's world from which all worlds continue; None if each continues from its own.
    """

    run: RunPlan
    parent: Parent
    checkpoint: Checkpoint
    backend: str
    only: int | None = None


def plan_branch(
    folder: Path | str,
    out: Path | str | None = None,
    overrides: Sequence[str] = (),
    at: int | None = None,
    steps: int | None = None,
    threads: int = 0,
    frames: int | None = None,
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
    seeds: Iterable[int] | None = None,
    of: int | None = None,
) -> BranchPlan:
    """Plans a branch of a run; changes nothing.

    Args:
        folder: Folder of the run to branch from.
        out: Folder of the new run; None for one next to the old one, named after the step.
        overrides: Settings to change, each as PATH=VALUE.
        at: Step of one of the run's checkpoints; None for the newest.
        steps: Total steps of each world; None for the number planned for the old run.
        threads: Number of threads; 0 for all processors.
        frames: Steps between two frames; None for the old run's.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
        seeds: Seeds of several futures of one world; None to continue with the seeds of the old run.
        of: With `seeds`, the seed of the old run's world; None for its only one.

    Raises:
        RecordError: The folder is not a run, its checkpoint is missing or damaged, or the run is already beyond
            `steps`.
        ConfigError: A setting is wrong, or determines the shape of the saved worlds.
        ArgumentError: Another argument is wrong.
    """
    folder = argument.folder("folder", folder)
    old = open_run(folder).manifest
    config = load_config(folder / CONFIG)
    require_undriven(folder, config)
    branch_config = load_config(folder / CONFIG, overrides=overrides)
    step = None if at is None else argument.integer("at", at, 0, argument.MAX_STEPS)
    checkpoint, _ = find_checkpoint(folder, step)
    if checkpoint is None:
        raise RecordError(f"{folder} has no checkpoint to branch from")
    name = f"the checkpoint of {folder}"
    check_head(checkpoint.head, config, old.seeds, name)
    _check_shape(config, branch_config)
    step = checkpoint.head.step
    total = old.steps_asked if steps is None else argument.integer("steps", steps, 1, argument.MAX_STEPS)
    if total <= step:
        raise RecordError(
            f"{name} is at step {step:,}: a branch needs more total steps than that, not {total:,}; "
            "give the total with --steps"
        )
    parent = Parent(to_unicode(folder.resolve().name), digest(config), step)
    branch_folder = out or free_folder(folder.parent / f"{folder.resolve().name}-branch{step}")
    frame_interval = old.frames if frames is None else frames
    founders, networks = load_founders(folder, config), load_networks(folder, config)
    only = _world_of(old, of, config, futures=seeds is not None)
    branch_seeds = old.seeds if seeds is None else argument.different(argument.seed_list(seeds))
    plan = RunPlan(
        branch_config,
        branch_seeds,
        total,
        branch_folder,
        threads,
        frame_interval,
        checkpoint_seconds,
        founders,
        networks,
        rules=old.rules,
    )
    parent = replace(parent, seed=None if only is None else old.seeds[only])
    return BranchPlan(plan, parent, checkpoint, same_backend(old.backend), only)


def start_branch(plan: BranchPlan, callbacks: Iterable[Callback] = ()) -> Manifest:
    """Starts a branch from `plan_branch`; see `branch`."""
    with count_interrupts() as interrupted:
        require_memory(plan.run.config, len(plan.run.seeds), plan.run.threads)
        simulation = Simulation(plan.run.config, plan.run.seeds, plan.run.threads, plan.backend, plan.run.rules)
        start = restore(simulation, plan.checkpoint, f"the checkpoint of {plan.parent.folder}", plan.only)
        manifest = replace(first_manifest(plan.run, simulation, start.step), parent=plan.parent)
        return start_run(simulation, plan.run, manifest, replace(start, seconds=0.0), together(callbacks), interrupted)


def branch(
    folder: Path | str,
    out: Path | str | None = None,
    overrides: Sequence[str] = (),
    at: int | None = None,
    steps: int | None = None,
    threads: int = 0,
    frames: int | None = None,
    callbacks: Iterable[Callback] = (),
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
    seeds: Iterable[int] | None = None,
    of: int | None = None,
) -> Manifest:
    """Continues from a checkpoint of a run, in a new folder, with changed settings or different random numbers.

    With `seeds`, one world of the old run gets several futures: the same agents, genes and networks, and from then on
    the random numbers of each seed. The new run's tables start at the checkpoint. `agents` has the agents alive then or
    born later. The first row of `population` counts from the last row before the checkpoint.

    Args:
        folder: Folder of the parent, which is only read.
        out: Folder of the new run, which must not hold a run; None for one next to the parent's.
        overrides: Strings `path=value`, as for `--set`.
        at: Step of the checkpoint; None for the newest.
        steps: Total steps of each world, including those before the checkpoint; None for the parent's.
        threads: Number of threads; 0 for all processors. Changes no result.
        frames: Steps between two frames; None for the parent's.
        callbacks: Functions of a `Moment`, called about five times a second and at the end.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
        seeds: Seeds of several futures of one world; None to continue with the seeds of the old run.
        of: With `seeds`, the seed of the old run's world; None for its only one.

    Returns:
        The manifest of the new run as saved at the end.

    Raises:
        RecordError: The checkpoint is missing or does not fit, or a changed setting, which the message gives, would
            change the shape of a world's arrays.
        ConfigError: An override is wrong.
        ArgumentError: A number is out of bounds.
        MemoryNeedError: The run needs more memory than there is.
        EngineError: A world reports an error.
    """
    plan = plan_branch(folder, out, overrides, at, steps, threads, frames, checkpoint_seconds, seeds, of)
    return start_branch(plan, callbacks)


def _world_of(old: Manifest, seed: int | None, config: Config, *, futures: bool) -> int | None:
    """Index of the world that gets several futures; None if each world only continues.

    Raises:
        ArgumentError: The world does not exist, must be specified, or has obstacles that depend on its seed.
    """
    if not futures:
        if seed is not None:
            raise ArgumentError(f"of = {seed}: names the world that has several futures: give their seeds, too")
        return None
    if config.obstacle.count:
        raise ArgumentError("seeds: the places of obstacles follow from a world's seed, so it cannot have another one")
    if seed is None and len(old.seeds) == 1:
        return 0
    if seed not in old.seeds:
        problem = "the run has several worlds: name one" if seed is None else "the run has no such world"
        raise ArgumentError(f"of = {seed}: {problem} of the seeds {', '.join(map(str, old.seeds))}")
    return old.seeds.index(seed)


def _check_shape(config: Config, branch_config: Config) -> None:
    fixed_paths = [
        path
        for path, _, _ in diff(config, branch_config)
        if fixed_path(path)
        or (path.endswith(".at_zero") and columns_of(config).causes != columns_of(branch_config).causes)
    ]
    if fixed_paths:
        raise RecordError(
            f"a branch cannot change {', '.join(fixed_paths)}: the saved worlds depend on it; begin a new run instead"
        )
