"""The host loop: advances a simulation, writes its records, tells of its progress."""

import signal
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Protocol

from hedon.config.arena import walls
from hedon.config.config import Config
from hedon.config.dump import digest, dump_toml
from hedon.config.load import is_modified
from hedon.experiment.sample import PopulationSampler, Rows, agent_rows, frame_rows
from hedon.experiment.simulation import Simulation, World
from hedon.record.manifest import Manifest
from hedon.record.provenance import collect_provenance, utc_now
from hedon.record.snapshot import Snapshot, save_snapshot
from hedon.record.writer import Writer

PIECE_SECONDS = 0.2
"""Longest time in the engine without a look at the keyboard [s]."""
LIVING_SECONDS = 30.0
"""Time after which the file of the living agents is replaced [s]."""


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run.

    Attributes:
        config: What the worlds are.
        seeds: One world per seed.
        steps: Steps of each world.
        out: The run's folder; must not hold a run already.
        threads: Threads to use; 0 for all processors.
        frames: Steps between two frames; 0 for none.
    """

    config: Config
    seeds: tuple[int, ...]
    steps: int
    out: Path
    threads: int = 0
    frames: int = 0


@dataclass(frozen=True, slots=True)
class Moment:
    """Where a run is: what a progress display shows.

    Attributes:
        step: Steps completed.
        steps: Steps asked for.
        seconds: Time since the first step [s].
        rows: The last row of the table `population` of each world.
        extinct: The step at which each world died out, or None.
    """

    step: int
    steps: int
    seconds: float
    rows: tuple[Rows, ...]
    extinct: tuple[int | None, ...]


class Display(Protocol):
    """Something that shows progress."""

    def update(self, moment: Moment) -> None:
        """Shows a moment; called about five times a second."""
        ...


def run(plan: RunPlan, display: Display | None = None) -> Manifest:
    """Runs a plan and keeps its records, silently where no display is given.

    Ctrl-C ends it after the current window, with all results kept; a second one ends it at once, likewise.

    Returns:
        The manifest as it was saved at the end.

    Raises:
        RecordError: The folder holds a run already or cannot be written.
        EngineError: A world reports an error; what was recorded before stays readable.
    """
    with _interrupts() as interrupted:
        return _run(plan, display, interrupted)


def _run(plan: RunPlan, display: Display | None, interrupted: "_Interrupts") -> Manifest:
    simulation = Simulation(plan.config, plan.seeds, plan.threads)
    manifest = _first_manifest(plan, simulation)
    with Writer(plan.out, dump_toml(plan.config), manifest) as writer:
        recorder = _Recorder(simulation, writer)
        started = time.perf_counter()
        status = "failed"
        step = 0
        try:
            for step in _steps(simulation, plan, interrupted):
                recorder.deaths()
                if step % plan.config.learning.rollout_steps == 0 or step == plan.steps or simulation.extinct:
                    recorder.interval()
                if plan.frames and step % plan.frames == 0:
                    recorder.frame()
                if display is not None:
                    display.update(recorder.moment(step, plan.steps, time.perf_counter() - started))
            recorder.interval()  # after a second Ctrl-C: what happened since the last window began
            status = "finished" if simulation.extinct or step == plan.steps else "interrupted"
        finally:
            seconds = time.perf_counter() - started
            manifest = _last_manifest(manifest, simulation, status, seconds)
            recorder.living()
            writer.save_manifest(manifest)
    save_snapshot(plan.out, snapshot(simulation.worlds[0]))
    return manifest


def _steps(simulation: Simulation, plan: RunPlan, interrupted: "_Interrupts") -> Iterator[int]:
    """Advances to each step at which there is something to do, and yields it."""
    window = plan.config.learning.rollout_steps
    piece = 64
    step = 0
    while step < plan.steps and not simulation.extinct:
        if interrupted.count > 1 or (interrupted.count == 1 and step % window == 0):
            return
        ends = [plan.steps, (step // window + 1) * window, step + piece]
        if plan.frames:
            ends.append((step // plan.frames + 1) * plan.frames)
        steps = min(ends) - step
        begun = time.perf_counter()
        simulation.run(steps)
        seconds = max(time.perf_counter() - begun, 1e-6)
        # The engine keeps the deaths of a piece until they are read: let them fill an eighth of its room, not all.
        full = 8 * max(world.waiting_deaths for world in simulation.worlds)
        piece = max(1, int(min(steps * PIECE_SECONDS / seconds, 4 * piece, steps / full if full else steps * 4)))
        step += steps
        yield step


class _Recorder:
    """Moves what the engine knows into the records, at the ends of intervals."""

    def __init__(self, simulation: Simulation, writer: Writer) -> None:
        self.simulation = simulation
        self.writer = writer
        self.samplers = [PopulationSampler(world) for world in simulation.worlds]
        self.rows = [sampler.sample() for sampler in self.samplers]
        self.last_step = [0 for _ in simulation.worlds]
        self.living_due = 0.0
        self.shown = False

    def deaths(self) -> None:
        """Writes those who died since the last call. The engine has room for some, so this is done in every piece."""
        for i, world in enumerate(self.simulation.worlds):
            lives = self.simulation.engine.take_rows(i)
            if len(lives["agent_id"]):
                self.writer.append("agents", agent_rows(world, lives))

    def interval(self) -> None:
        """Writes what has not been written of the deaths and one population row per world that moved."""
        self.deaths()
        for i, world in enumerate(self.simulation.worlds):
            if world.step == self.last_step[i]:
                continue
            self.last_step[i] = world.step
            self.rows[i] = self.samplers[i].sample()
            self.writer.append("population", self.rows[i])
        if time.perf_counter() >= self.living_due:
            self.living()
        if not self.shown:  # the first rows reach the disk at once, so that a reader sees that the run is on
            self.writer.flush()
            self.shown = True

    def living(self) -> None:
        """Replaces the file of the living agents."""
        self.living_due = time.perf_counter() + LIVING_SECONDS
        engine = self.simulation.engine
        self.writer.replace_living(*(agent_rows(w, engine.living_rows(w.index)) for w in self.simulation.worlds))

    def frame(self) -> None:
        """Writes every agent and food of every living world as they are now."""
        for world in self.simulation.worlds:
            if not world.extinct:
                for rows in frame_rows(world):
                    self.writer.append("frames", rows)

    def moment(self, step: int, steps: int, seconds: float) -> Moment:
        extinct = tuple(world.extinct_step for world in self.simulation.worlds)
        return Moment(step, steps, seconds, tuple(self.rows), extinct)


def snapshot(world: World) -> Snapshot:
    """A world as it is now, for a picture."""
    lives, foods, config = world.agents(), world.foods(), world.config
    return Snapshot(
        world=world.index,
        seed=world.seed,
        step=world.step,
        **{name: lives[name] for name in ("agent_id", "x", "y", "angle", "energy")},
        rays=world.rays(),
        food_kind=foods["kind"],
        food_x=foods["x"],
        food_y=foods["y"],
        walls=walls(config.arena),
        food_kinds=tuple(config.food),
        radius=config.body.radius,
        food_radius=config.body.food_radius,
        ray_length=config.sensor.ray_length,
        ray_spread=config.sensor.ray_spread,
        mouth_spread=config.sensor.mouth_spread,
        energy_capacity=config.energy.capacity,
    )


def _first_manifest(plan: RunPlan, simulation: Simulation) -> Manifest:
    config = plan.config
    return Manifest(
        food_kinds=tuple(config.food),
        neutral_count=config.genome.neutral_count,
        seeds=plan.seeds,
        steps_asked=plan.steps,
        preset=config.preset,
        fidelity=config.fidelity,
        name=config.name,
        modified=is_modified(config),
        config_digest=digest(config),
        kernel=simulation.engine.kernel,
        threads=simulation.engine.threads,
        steps_done=tuple(0 for _ in plan.seeds),
        extinct_steps=tuple(None for _ in plan.seeds),
        food_colors=tuple(food.color for food in config.food.values()),
        **collect_provenance(),
    )


def _last_manifest(manifest: Manifest, simulation: Simulation, status: str, seconds: float) -> Manifest:
    return replace(
        manifest,
        status=status,
        ended=utc_now(),
        steps_done=tuple(world.step for world in simulation.worlds),
        extinct_steps=tuple(world.extinct_step for world in simulation.worlds),
        run_seconds=seconds,
    )


@dataclass(slots=True)
class _Interrupts:
    count: int = 0


@contextmanager
def _interrupts() -> Iterator[_Interrupts]:
    """Counts Ctrl-C instead of raising at an arbitrary place; the loop looks at the count."""
    seen = _Interrupts()

    def note(number: int, frame: Any) -> None:
        seen.count += 1

    try:
        previous = signal.signal(signal.SIGINT, note)
    except ValueError:  # not in the main thread, where Python handles no signals
        yield seen
        return
    try:
        yield seen
    finally:
        signal.signal(signal.SIGINT, previous)


def default_folder(config: Config, seeds: Sequence[int]) -> Path:
    """A folder of its own for a run that names none: runs/NAME-FIDELITY-sSEEDS, with a number where it is taken."""
    if len(seeds) == 1:
        span = f"s{seeds[0]}"
    elif tuple(seeds) == tuple(range(seeds[0], seeds[-1] + 1)):
        span = f"s{seeds[0]}-{seeds[-1]}"
    else:
        span = f"{len(seeds)}seeds"
    stem = "-".join((config.name, config.fidelity, span))
    folder, number = Path("runs") / stem, 2
    while folder.exists():
        folder, number = Path("runs") / f"{stem}-run{number}", number + 1
    return folder
