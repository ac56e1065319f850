"""Continues from a checkpoint of a run with changed settings, as a new run that names its parent."""

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
    """A branch that is ready to begin.

    Attributes:
        run: What to run, with the total steps.
        parent: The run and the step that it starts from.
        checkpoint: The worlds to start from.
        backend: Instruction set to use.
        only: Index of the parent's world that all worlds go on from; None if each goes on from its own.
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
        folder: Of the run to branch from.
        out: Folder of the new run; None for one beside the old one, named after the step.
        overrides: Settings to change, each as PATH=VALUE.
        at: Step of one of the run's checkpoints; None for the newest.
        steps: Steps of each world in all; None for those that the old run was planned with.
        threads: Threads to use; 0 for all processors.
        frames: Steps between two frames; None for those of the old run.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
        seeds: Of several futures of one world, one each; None to go on with the seeds of the old run.
        of: With `seeds`, the seed of the old run's world; None for its only one.

    Raises:
        RecordError: It is not a run, has no such checkpoint or a damaged one, or has come further than `steps`.
        ConfigError: A setting is wrong, or fixes the shape of the saved worlds.
        ArgumentError: Another argument is wrong.
    """
    folder = argument.folder("folder", folder)
    old = open_run(folder).manifest
    config = load_config(folder / CONFIG)
    require_undriven(folder, config)
    changed = load_config(folder / CONFIG, overrides=overrides)
    step = None if at is None else argument.integer("at", at, 0, argument.MAX_STEPS)
    checkpoint, _ = find_checkpoint(folder, step)
    if checkpoint is None:
        raise RecordError(f"{folder} has no checkpoint to branch from")
    name = f"the checkpoint of {folder}"
    check_head(checkpoint.head, config, old.seeds, name)
    _check_shape(config, changed)
    step = checkpoint.head.step
    total = old.steps_asked if steps is None else argument.integer("steps", steps, 1, argument.MAX_STEPS)
    if total <= step:
        raise RecordError(
            f"{name} is at step {step:,}: a branch needs more total steps than that, not {total:,}; "
            "give the total with --steps"
        )
    parent = Parent(to_unicode(folder.resolve().name), digest(config), step)
    place = out or free_folder(folder.parent / f"{folder.resolve().name}-branch{step}")
    every = old.frames if frames is None else frames
    founders, networks = load_founders(folder, config), load_networks(folder, config)
    only = _world_of(old, of, config, futures=seeds is not None)
    mine = old.seeds if seeds is None else argument.different(argument.seed_list(seeds))
    plan = RunPlan(changed, mine, total, place, threads, every, checkpoint_seconds, founders, networks, rules=old.rules)
    parent = replace(parent, seed=None if only is None else old.seeds[only])
    return BranchPlan(plan, parent, checkpoint, same_backend(old.backend), only)


def start_branch(plan: BranchPlan, callbacks: Iterable[Callback] = ()) -> Manifest:
    """Begins a branch that `plan_branch` planned; see `branch`."""
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
    """Continues from a checkpoint of a run, in a new folder, with some settings changed or with other chances.

    With `seeds`, one world of the old run has several futures: the same agents, genes and networks, and from then on
    the chances of each seed. The new run's tables begin at the checkpoint. `agents` has the agents that lived then or
    were born later. The first row of `population` counts from the last row before the checkpoint.

    Args:
        folder: Folder of the parent, which is only read.
        out: Folder of the new run; must not hold a run already. None for one next to the parent's.
        overrides: Texts `path=value`, as for `--set`.
        at: Step of the checkpoint; None for the newest one.
        steps: Total steps of each world, including those before the checkpoint; None for the parent's.
        threads: Threads to use; 0 for all processors. Changes no result.
        frames: Steps between two frames; None for the parent's.
        callbacks: Functions of a `Moment`, called about five times a second and at the end.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
        seeds: Of several futures of one world, one each; None to go on with the seeds of the old run.
        of: With `seeds`, the seed of the old run's world; None for its only one.

    Returns:
        The manifest of the new run as it was saved at the end.

    Raises:
        RecordError: The checkpoint is not there or does not fit, or a changed setting would change the shape of a
            world's arrays; the message names it.
        ConfigError: An override is wrong.
        ArgumentError: A number is out of bounds.
        MemoryNeedError: It needs more memory than there is.
        EngineError: A world reports an error.
    """
    plan = plan_branch(folder, out, overrides, at, steps, threads, frames, checkpoint_seconds, seeds, of)
    return start_branch(plan, callbacks)


def _world_of(old: Manifest, of: int | None, config: Config, *, futures: bool) -> int | None:
    """The index of the world that has several futures; None where each world only goes on.

    Raises:
        ArgumentError: There is no such world, it must be named, or its obstacles follow from its seed.
    """
    if not futures:
        if of is not None:
            raise ArgumentError(f"of = {of}: names the world that has several futures: give their seeds, too")
        return None
    if config.obstacle.count:
        raise ArgumentError("seeds: the places of obstacles follow from a world's seed, so it cannot have another one")
    if of is None and len(old.seeds) == 1:
        return 0
    if of not in old.seeds:
        said = "the run has several worlds: name one" if of is None else "the run has no such world"
        raise ArgumentError(f"of = {of}: {said} of the seeds {', '.join(map(str, old.seeds))}")
    return old.seeds.index(of)


def _check_shape(config: Config, changed: Config) -> None:
    fixed = [
        path
        for path, _, _ in diff(config, changed)
        if fixed_path(path) or (path.endswith(".at_zero") and columns_of(config).causes != columns_of(changed).causes)
    ]
    if fixed:
        raise RecordError(
            f"a branch cannot change {', '.join(fixed)}: the saved worlds depend on it; begin a new run instead"
        )
