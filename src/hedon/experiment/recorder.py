"""Copies data from the engine into the records: deaths, intervals, frames, living agents, checkpoints."""

import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version

import numpy as np

from hedon.config.dump import dump_toml
from hedon.error import EngineError
from hedon.experiment.plan import Moment
from hedon.experiment.sample import PopulationSampler, Rows, agent_rows, frame_rows
from hedon.experiment.simulation import Simulation
from hedon.experiment.world import World
from hedon.record.array_file import ArrayWriter
from hedon.record.checkpoint import CheckpointHead, Sampled
from hedon.record.folder import CHECKPOINT_SECONDS, checkpoint_path
from hedon.record.writer import Writer

FLUSH_SECONDS = 30.0
"""Time after which rows are written, so that readers see them [s]."""
FLUSH_GROWTH = 0.005
"""The same as a share of the session so far. Each part costs about 10 kB for its footer, and each reader an open file,
so parts become rarer as a run gets longer: a run of many hours has some hundreds of them."""

PACE = 19
"""Minimum time between two checkpoints, as a multiple of the time that saving the earlier one took."""


@dataclass(frozen=True, slots=True)
class Start:
    """Start of a session, at step 0 or at a checkpoint.

    Attributes:
        step: Steps completed.
        seconds: Time spent on steps before [s].
        sampled: Counts from which the next rows of the table `population` start, one per world and species; empty at
            step 0.
    """

    step: int = 0
    seconds: float = 0.0
    sampled: tuple[Sampled, ...] = ()


class Recorder:
    """Writes the records of a simulation.

    Args:
        simulation: Simulation in the state of `start`.
        writer: Writer of the rows.
        frames: Steps between two frames; stored in checkpoints.
        start: Start of the session.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
        worlds: Worlds to record; None for all.
    """

    def __init__(
        self,
        simulation: Simulation,
        writer: Writer,
        frames: int,
        start: Start,
        checkpoint_seconds: float = CHECKPOINT_SECONDS,
        worlds: Sequence[World] | None = None,
    ) -> None:
        self.simulation = simulation
        self.worlds = list(simulation.worlds if worlds is None else worlds)
        self.left: list[Rows] = []  # living agents of worlds that have left, as they were then
        self.writer = writer
        self.frames = frames
        sampled = [(world, species) for world in self.worlds for species in range(len(world.config.species))]
        previous = start.sampled or (None,) * len(sampled)
        self.samplers = [PopulationSampler(*pair, sample) for pair, sample in zip(sampled, previous, strict=True)]
        self.rows = [sampler.row() for sampler in self.samplers]
        self.last_deaths: dict[tuple[int, int], int] = {}  # by world and species
        self.first = start.step
        self.begun = time.perf_counter()
        self.flush_due = 0.0
        self.shown = False
        self.checkpoint_seconds = checkpoint_seconds
        self.next_checkpoint = self.begun + checkpoint_seconds
        self.saved = start.step if checkpoint_path(writer.folder, start.step).exists() else None  # what it starts from

    def deaths(self, *, partial: bool = False) -> None:
        """Writes the agents that died since the last call. The engine can store only a few, so call it often.

        Raises:
            EngineError: Too many agents died since the last call, so some are lost, and `partial` is false.
        """
        for world in self.worlds:
            dead_agents = world._take_deaths(partial=partial)
            if len(dead_agents["agent_id"]):
                self.writer.append("agents", agent_rows(world, dead_agents))
            for species in np.unique(dead_agents["species"]).tolist():
                last_step = int(dead_agents["death_step"][dead_agents["species"] == species].max())
                self.last_deaths[world.row, species] = last_step
        if time.perf_counter() >= self.flush_due:
            self.living()

    def interval(self) -> None:
        """Writes one population row per world and species that advanced since its last row."""
        advanced = [i for i, sampler in enumerate(self.samplers) if sampler.world.step != sampler.since.step]
        for i in advanced:
            self.rows[i] = self.samplers[i].row()
            self.samplers[i].advance()
        if advanced:
            self.writer.append("population", *(self.rows[i] for i in advanced))
        if not self.shown:  # write the first rows immediately, so that a reader sees that the run has started
            self.living()
            self.writer.flush()
            self.shown = True

    def living(self) -> None:
        """Writes all rows so far and the living agents, so that readers see this moment. Write all deaths before."""
        now = time.perf_counter()
        self.flush_due = now + max(FLUSH_SECONDS, FLUSH_GROWTH * (now - self.begun))
        rows = [*self.left]
        for world in self.worlds:
            with suppress(EngineError):  # of a world whose slots were found inconsistent
                rows.append(agent_rows(world, world.agents()))
        self.writer.replace_living(*rows)

    def leave(self, world: World) -> None:
        """Ends the records of one world, while others continue."""
        self.deaths()
        self.interval()
        self.left.append(agent_rows(world, world.agents()))
        remaining = [i for i, sampler in enumerate(self.samplers) if sampler.world is not world]
        self.samplers, self.rows = [self.samplers[i] for i in remaining], [self.rows[i] for i in remaining]
        self.worlds.remove(world)

    def frame(self) -> None:
        """Writes the current state of every agent and food of every world that is not extinct."""
        rows = [row for world in self.worlds if not world.extinct for row in frame_rows(world)]
        if rows:
            self.writer.append("frames", *rows)

    @property
    def checkpoint_due(self) -> bool:
        """Whether a checkpoint is due. Saving takes at most a twentieth of the time, so large worlds have fewer
        checkpoints, unless 0 s asks for one at every opportunity.
        """
        return time.perf_counter() >= self.next_checkpoint

    def checkpoint(self, step: int, seconds: float) -> None:
        """Saves a checkpoint, unless this step has one. All rows are then on disk.

        Deaths and frames of this step must be written before.

        Args:
            step: Steps completed by every world that is alive [step].
            seconds: Time spent on steps so far, over all sessions [s].
        """
        self.living()
        if step == self.saved:
            self.writer.flush()
            return
        started = time.perf_counter()
        self.writer.save_checkpoint(self._head(step, seconds), self._fill)
        self.saved, now = step, time.perf_counter()
        self.next_checkpoint = now
        if self.checkpoint_seconds > 0:
            self.next_checkpoint += max(self.checkpoint_seconds, PACE * (now - started))

    def fault(self, seconds: float) -> None:
        """Saves the worlds after one of them has stopped at a fault, and the agents that died before it."""
        self.deaths(partial=True)
        step = max(world.step for world in self.worlds)
        self.writer.save_fault(self._head(step, seconds), self._fill)

    def _head(self, step: int, seconds: float) -> CheckpointHead:
        simulation = self.simulation
        digests = [""] * len(self.worlds)
        for i, world in enumerate(self.worlds):
            with suppress(EngineError):  # of a world whose slots were found inconsistent
                digests[i] = world.digest()
        return CheckpointHead(
            step=step,
            config=dump_toml(simulation.config),
            seeds=tuple(world.seed for world in self.worlds),
            backend=simulation.engine.backend,
            hedon_version=version("hedon"),
            frames=self.frames,
            run_seconds=seconds,
            sampled=tuple(sampler.since for sampler in self.samplers),
            digests=tuple(digests),
        )

    def _fill(self, archive: ArrayWriter) -> None:
        """Writes the arrays of all worlds, which the engine gives in pieces."""
        for world in self.worlds:
            with suppress(EngineError):  # as above
                self.simulation.engine.save_to(world.index, partial(_begin, archive, world.row), archive.piece)

    def moment(self, step: int, steps: int, seconds: float) -> Moment:
        """The state that a display shows.

        Args:
            step: Steps completed so far [step].
            steps: Total steps of the run [step].
            seconds: Time spent since `first` [s].
        """
        extinct = tuple(map(self._extinct_step, self.samplers))
        window = self.simulation.config.world.rollout_steps
        return Moment(self.first, step, steps, seconds, tuple(self.rows), extinct, window)

    def _extinct_step(self, sampler: PopulationSampler) -> int | None:
        world, species = sampler.world, sampler.species
        if not sampler.columns.several:
            return world.extinct_step
        is_alive = bool((world.view("species")[world.living] == species).any())
        return None if is_alive else self.last_deaths.get((world.row, species))


def _begin(archive: ArrayWriter, world: int, name: str, dtype: str, shape: list[int]) -> None:
    archive.begin(f"{world}/{name}", dtype, shape)
