"""The host loop: advances a simulation, writes its records and checkpoints, and shows its progress."""

import time
from collections.abc import Iterable, Iterator
from contextlib import nullcontext, suppress
from dataclasses import replace

from hedon.config.dump import dump_toml
from hedon.error import ArgumentError, EngineError
from hedon.experiment.interrupt import Interrupts, count_interrupts
from hedon.experiment.memory import require_memory
from hedon.experiment.plan import Callback, RunPlan, together
from hedon.experiment.recorder import Recorder, Start
from hedon.experiment.sample import snapshot
from hedon.experiment.session import end_of, first_manifest, last_manifest
from hedon.experiment.simulation import Simulation
from hedon.record.error import RecordError
from hedon.record.founder import FOUNDERS
from hedon.record.lock import FolderLock
from hedon.record.manifest import Manifest
from hedon.record.network import NETWORKS
from hedon.record.snapshot import save_snapshot
from hedon.record.writer import Writer
from hedon.text import brief

PIECE_SECONDS = 0.2
"""Longest time in the engine between two checks for Ctrl-C [s]; a device is not interrupted within a window."""


def run(plan: RunPlan, callbacks: Iterable[Callback] = ()) -> Manifest:
    """Runs a plan and writes its records; prints nothing.

    Ctrl-C or SIGTERM ends it after the current window, a second one immediately; both keep all results.
    `hedon.experiment.resume.resume` continues it, even if it was killed.

    Args:
        plan: What to run, and where its records go.
        callbacks: Functions of a `Moment`, called about five times a second and at the end.

    Returns:
        The manifest as saved at the end.

    Raises:
        ArgumentError: The plan is not a `RunPlan`, or a callback is not a function.
        RecordError: The folder already holds a run, is in use, or cannot be written.
        MemoryNeedError: The run needs more memory than there is.
        EngineError: A world reports an error; earlier records stay readable.
    """
    if not isinstance(plan, RunPlan):
        raise ArgumentError(f"plan: must be a RunPlan, not {brief(repr(plan))}")
    callback = together(callbacks)
    with count_interrupts() as interrupted:
        require_memory(plan.config, len(plan.seeds), plan.threads)
        simulation = Simulation(plan.config, plan.seeds, plan.threads, plan.backend, plan.rules)
        set_initial_state(simulation, plan)
        return start_run(simulation, plan, first_manifest(plan, simulation), Start(), callback, interrupted)


def set_initial_state(simulation: Simulation, plan: RunPlan) -> None:
    """Gives the founders of a new simulation the plan's genomes and networks.

    Raises:
        FounderError: The founders do not fit the simulation.
        NetworkError: The networks do not fit the simulation.
    """
    if plan.founders is not None:
        simulation.set_founders(plan.founders)
    if plan.networks is not None:
        simulation.set_networks(plan.networks)


def start_run(
    simulation: Simulation,
    plan: RunPlan,
    manifest: Manifest,
    start: Start,
    callback: Callback | None,
    interrupted: Interrupts,
) -> Manifest:
    """Creates and locks the folder of a run, and runs it; see `run`.

    Returns:
        The manifest as saved at the end.

    Raises:
        RecordError: The folder already holds a run, is in use, or cannot be written.
        EngineError: A world reports an error.
    """
    with FolderLock(plan.out), Writer(plan.out, dump_toml(plan.config), manifest, beginning=_beginning(plan)) as writer:
        return advance(simulation, plan, manifest, writer, start, callback, interrupted)


def _beginning(plan: RunPlan) -> dict[str, bytes]:
    """Files, besides the config, that define the initial state of the worlds."""
    files = {}
    if plan.founders is not None:
        files[FOUNDERS] = plan.founders.content
    if plan.networks is not None:
        files[NETWORKS] = plan.networks.content
    return files


def advance(
    simulation: Simulation,
    plan: RunPlan,
    manifest: Manifest,
    writer: Writer,
    start: Start,
    callback: Callback | None,
    interrupted: Interrupts,
) -> Manifest:
    """Advances a simulation to the end of its plan, or until it is interrupted or extinct, and records it; see `run`.

    Returns:
        The manifest as saved at the end.

    Raises:
        EngineError: A world reports an error; its state is in the folder `fault`, unless that cannot be written either.
        RecordError: The folder cannot be written.
    """
    recorder = Recorder(simulation, writer, plan.frames, start, plan.checkpoint_seconds)
    started = time.perf_counter()
    seconds, step, status = start.seconds, start.step, "failed"
    window, handled_count = plan.config.world.rollout_steps, 0
    try:
        recorder.checkpoint(step, seconds)
        for step in _steps(simulation, plan, start.step, interrupted):
            seconds = start.seconds + time.perf_counter() - started
            writer.require_folder()
            recorder.deaths()
            if step % window == 0:
                recorder.interval()
            if plan.frames and step % plan.frames == 0:
                recorder.frame()
            # Within a window a checkpoint would hold rollouts, which are larger than all else, so save one only if
            # asked to end.
            if interrupted.count > handled_count or (step % window == 0 and recorder.checkpoint_due):
                recorder.checkpoint(step, seconds)
                handled_count = interrupted.count
            if callback is not None and step < plan.steps:  # the last moment is shown below, with its own rows
                callback(recorder.moment(step, plan.steps, seconds - start.seconds))
        # First the checkpoint, then the rows of a window that may be incomplete: a resumed run removes those.
        recorder.checkpoint(step, seconds)
        recorder.interval()
        if callback is not None:
            callback(recorder.moment(step, plan.steps, seconds - start.seconds))
        status = "finished" if simulation.extinct or step == plan.steps else "interrupted"
    except EngineError as error:
        manifest = replace(manifest, fault=str(error))
        try:
            recorder.fault(seconds)
        except RecordError as lost:
            raise EngineError(f"{error} The state of its worlds could not be saved: {lost}") from error
        raise
    finally:
        with suppress(RecordError) if status == "failed" else nullcontext():  # the first error is already being raised
            recorder.living()
            world_ends = [end_of(world, failed=status == "failed") for world in simulation.worlds]
            manifest = last_manifest(manifest, world_ends, status, seconds, writer)
    save_snapshot(plan.out, snapshot(simulation.worlds[0]))
    return manifest


def _steps(simulation: Simulation, plan: RunPlan, step: int, interrupted: Interrupts) -> Iterator[int]:
    """Advances to each step that needs an action, and yields it."""
    window = plan.config.world.rollout_steps
    on_device = simulation.engine.device_count > 0
    piece = 64
    while step < plan.steps and not simulation.extinct:
        if interrupted.count > 1 or (interrupted.count == 1 and step % window == 0):
            return
        limits = [plan.steps, (step // window + 1) * window, step + piece]
        if plan.frames:
            limits.append((step // plan.frames + 1) * plan.frames)
        steps = min(limits) - step
        started = time.perf_counter()
        simulation.run(steps)
        seconds = max(time.perf_counter() - started, 1e-6)
        target = window if on_device else min(steps * PIECE_SECONDS / seconds, 4 * piece)
        # The engine keeps deaths until they are read: keep pieces so short that deaths fill an eighth of its space.
        full = 8 * max(world.waiting_deaths for world in simulation.worlds)
        piece = max(1, int(min(target, steps / full if full else 4 * steps)))
        step += steps
        yield step
