"""Records of worlds that a program drives: a folder as `hedon run` writes it, for everything that reads runs."""

import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.dump import dump_toml
from hedon.error import ArgumentError, EngineError
from hedon.experiment.argument import MAX_STEPS, different, folder, integer, seed_list
from hedon.experiment.plan import free_folder, require_measures
from hedon.experiment.recorder import Recorder, Start
from hedon.experiment.sample import snapshot
from hedon.experiment.session import WorldEnd, end_of, first_manifest, last_manifest
from hedon.experiment.simulation import Simulation
from hedon.experiment.world import World
from hedon.record.folder import require_no_run
from hedon.record.lock import FolderLock
from hedon.record.snapshot import save_snapshot
from hedon.record.writer import Writer


@dataclass(frozen=True, slots=True)
class Drive:
    """Description of the recorded worlds for the manifest.

    Attributes:
        config: Settings of the worlds.
        seeds: Seeds of the worlds.
        steps: Maximum steps of each world, since the driver's number of steps is unknown.
        frames: Steps between two frames; 0 for none.
    """

    config: Config
    seeds: tuple[int, ...]
    steps: int
    frames: int


class Records:
    """Records all worlds of a simulation that a program advances and restarts.

    Worlds that start together form one run. The first run uses the given folder; each later one adds a number to its
    name. A run is written from its first step on, and ends when all its worlds have restarted.

    Args:
        simulation: Worlds at step 0, with a config that is pinned to its rules.
        out: Folder for the first run; it must not hold a run yet.
        frames: Steps between two frames; 0 for none.

    Raises:
        ArgumentError: The config names founders or networks, which only a run can start with, or another value is
            wrong.
        ConfigError: A measure that the config adds cannot be computed.
        RecordError: The folder already holds a run, is in use, or cannot be written.
    """

    def __init__(self, simulation: Simulation, out: Path | str, frames: int) -> None:
        config = simulation.config
        if config.world.founders or config.world.networks:
            raise ArgumentError("record: the config names founders or networks, which driven worlds do not begin with")
        different(seed_list(simulation.seeds))
        require_measures(config)
        self.folder = folder("record", out)
        self._frames = integer("frames", frames, 0, MAX_STEPS)
        self._simulation, self._closed = simulation, False
        self._runs = [RunRecord(simulation, simulation.worlds, self.folder, self._frames)]

    def require_open(self) -> None:
        """Refuses a step after the records are closed.

        Raises:
            ArgumentError: The records are closed.
        """
        if self._closed:
            raise ArgumentError(f"step: the records in {self.folder} are closed: go on with a clone, which has none")

    def advance(self) -> None:
        """Advances the worlds by one step, and writes the records that are due.

        Raises:
            EngineError: A world reports an error; its state is in the folder `fault`.
            RecordError: A folder cannot be written.
        """
        self.begin()
        start = time.perf_counter()
        try:
            self._simulation.engine.run(1)
        except EngineError as error:
            self.fail(str(error))
            raise
        except KeyboardInterrupt:  # raised after the step is done
            self.note(time.perf_counter() - start)
            raise
        self.note(time.perf_counter() - start)

    def fail(self, fault: str) -> None:
        """Ends the records after an error in a world."""
        for run in self._runs:
            run.fail(fault)
        self._closed = True

    def begin(self) -> None:
        """Creates the folders of worlds that are about to take their first step."""
        for run in self._runs:
            run.begin()

    def note(self, seconds: float) -> None:
        """Writes the records due after a step that took `seconds` [s]."""
        for run in self._runs:
            run.note(seconds)

    def end(self, worlds: NDArray[np.bool_], seeds: Sequence[int]) -> None:
        """Ends the records of worlds that are about to restart with these seeds.

        Raises:
            ArgumentError: A seed is too large for a run, or appears twice. Nothing is changed.
        """
        different(seed_list(seeds))
        for run in self._runs:
            run.leave([world for world in run.worlds if worlds[world.index]])
        self._runs = [run for run in self._runs if run.worlds]

    def begin_again(self, worlds: NDArray[np.bool_]) -> None:
        """Prepares the records of worlds that have restarted."""
        waiting = {world.index for run in self._runs for world in run.worlds}  # worlds without a step so far
        restarted = [world for world in self._simulation.worlds if worlds[world.index] and world.index not in waiting]
        if restarted:
            self._runs.append(RunRecord(self._simulation, restarted, free_folder(self.folder), self._frames))

    def close(self) -> None:
        """Writes everything that is pending; a second call has no effect.

        Raises:
            RecordError: A file could not be written.
        """
        for run in self._runs:
            run.close()
        self._closed = True


class RunRecord:
    """Writes the run folder of worlds that start together.

    Args:
        simulation: The simulation that has the worlds.
        worlds: Worlds of the run, at step 0.
        out: Folder of the run.
        frames: Steps between two frames; 0 for none.

    Raises:
        RecordError: The folder already holds a run, is in use, or cannot be written.
    """

    def __init__(self, simulation: Simulation, worlds: Sequence[World], out: Path, frames: int) -> None:
        self.worlds, self.folder = list(worlds), out
        self._simulation, self._frames = simulation, frames
        self._window = simulation.config.world.rollout_steps
        self._ends: dict[int, WorldEnd] = {}
        for row, world in enumerate(self.worlds):
            world._row = row
        self._recorder: Recorder | None = None
        self._step, self._next, self._seconds = 0, 1, 0.0
        with ExitStack() as stack:
            stack.enter_context(FolderLock(out))
            require_no_run(out)
            self._held = stack.pop_all()

    def begin(self) -> None:
        """Writes the start of the run, before the first step of its worlds."""
        if self._recorder is not None or not self.worlds:
            return
        simulation, worlds = self._simulation, list(self.worlds)
        drive = Drive(simulation.config, tuple(world.seed for world in worlds), MAX_STEPS, self._frames)
        self._manifest = first_manifest(drive, simulation, worlds=worlds)
        writer = Writer(self.folder, dump_toml(simulation.config), self._manifest)
        self._writer = self._held.enter_context(writer)
        self._recorder = Recorder(simulation, writer, self._frames, Start(), worlds=worlds)
        self._recorder.checkpoint(0, 0.0)

    def note(self, seconds: float) -> None:
        """Writes the records due after a step."""
        recorder = self._recorder
        if recorder is None:
            return
        self._step += 1
        self._seconds += seconds
        is_interval = self._step % self._window == 0
        is_frame = bool(self._frames) and self._step % self._frames == 0
        if not (is_interval or is_frame or self._step >= self._next):
            return
        self._writer.require_folder()
        # The engine keeps deaths until they are read: check again before they can fill an eighth of its space.
        fill = 8 * max(world.waiting_deaths for world in self.worlds)
        recorder.deaths()
        self._next = self._step + max(1, int(min(self._window, 1 / fill if fill else self._window)))
        if is_interval:
            recorder.interval()
        if is_frame:
            recorder.frame()
        if recorder.checkpoint_due and not self._ends:  # a checkpoint needs all worlds of a run
            recorder.checkpoint(self._step, self._seconds)

    def leave(self, worlds: Sequence[World]) -> None:
        """Ends the records of some worlds, and the run with the last of them; does nothing before the first step."""
        if self._recorder is None or not worlds:
            return
        if len(worlds) == len(self.worlds):
            self.close()
        else:
            for world in worlds:
                self._forget(world)
                self._recorder.leave(world)
        self.worlds = [world for world in self.worlds if world not in worlds]

    def fail(self, fault: str) -> None:
        """Ends the run after an error in a world."""
        if self._recorder is not None:
            self._manifest = replace(self._manifest, fault=fault)
            self._recorder.fault(self._seconds)
            self.close("failed")

    def close(self, status: str = "finished") -> None:
        """Writes everything that is pending, and the end of the manifest; a second call has no effect.

        Raises:
            RecordError: A file could not be written.
        """
        recorder = self._recorder
        with self._held:
            if recorder is None or self._manifest.ended is not None:
                return
            if status != "failed":
                recorder.deaths()
                if not self._ends:
                    recorder.checkpoint(self._step, self._seconds)
                recorder.interval()
            recorder.living()
            picture = snapshot(recorder.worlds[0])
            for world in recorder.worlds:
                self._forget(world, failed=status == "failed")
            manifest = replace(self._manifest, steps_asked=max(self._step, 1))
            ends = [self._ends[row] for row in sorted(self._ends)]
            self._manifest = last_manifest(manifest, ends, status, self._seconds, self._writer)
        save_snapshot(self.folder, picture)

    def _forget(self, world: World, *, failed: bool = False) -> None:
        self._ends[world.row] = end_of(world, failed=failed)
