"""Records of worlds that a program drives: the folder that `hedon run` writes, for all that reads runs."""

import time
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from hedon.config.config import Config
from hedon.config.dump import dump_toml
from hedon.error import ArgumentError, EngineError
from hedon.experiment.argument import MAX_STEPS, different, folder, integer, seed_list
from hedon.experiment.recorder import Recorder, Start
from hedon.experiment.sample import snapshot
from hedon.experiment.session import first_manifest, last_manifest
from hedon.experiment.simulation import Simulation
from hedon.record.lock import FolderLock
from hedon.record.manifest import Manifest
from hedon.record.snapshot import save_snapshot
from hedon.record.writer import Writer


@dataclass(frozen=True, slots=True)
class Drive:
    """What is recorded, for the manifest.

    Attributes:
        config: Of the worlds.
        seeds: Of the worlds.
        steps: The most that each may do: nobody knows how many its driver will ask for.
        frames: Steps between two frames; 0 for none.
    """

    config: Config
    seeds: tuple[int, ...]
    steps: int
    frames: int


class Record:
    """Writes the run folder of worlds at their beginning, while somebody else advances them.

    Args:
        simulation: The worlds, at step 0, with a config that is pinned to its rules.
        out: The folder; it must not hold a run already.
        frames: Steps between two frames; 0 for none.

    Raises:
        ArgumentError: The config names founders or networks, which only a run begins with, or another value is wrong.
        RecordError: The folder holds a run already, is in use, or cannot be written.
    """

    def __init__(self, simulation: Simulation, out: Path | str, frames: int) -> None:
        config = simulation.config
        if config.world.founders or config.world.networks:
            raise ArgumentError("record: the config names founders or networks, which driven worlds do not begin with")
        seeds = different(seed_list(simulation.seeds))
        self.folder = folder("record", out)
        drive = Drive(config, seeds, MAX_STEPS, integer("frames", frames, 0, MAX_STEPS))
        for world in simulation.worlds:
            world._recorded = True
        self._simulation, self._frames, self._window = simulation, drive.frames, config.world.rollout_steps
        self._manifest = first_manifest(drive, simulation)
        self._held = ExitStack()
        with self._held as held:
            held.enter_context(FolderLock(self.folder))
            self._writer = held.enter_context(Writer(self.folder, dump_toml(config), self._manifest))
            self._recorder = Recorder(simulation, self._writer, drive.frames, Start())
            self._recorder.checkpoint(0, 0.0)
            self._held = held.pop_all()
        self._step, self._next, self._seconds = 0, 1, 0.0

    def require_open(self) -> None:
        """Refuses a step after the end of the records.

        Raises:
            ArgumentError: They are closed.
        """
        if self._manifest.ended is not None:
            raise ArgumentError(f"step: the records in {self.folder} are closed: go on with a clone, which has none")

    def advance(self) -> None:
        """Advances the worlds by one step, and writes what is to be written then.

        Raises:
            EngineError: A world reports an error; its state is in the folder `fault`.
            RecordError: The folder cannot be written.
        """
        begun = time.perf_counter()
        try:
            self._simulation.engine.run(1)
        except EngineError as error:
            self._manifest = replace(self._manifest, fault=str(error))
            self._recorder.fault(self._seconds)
            self.close("failed")
            raise
        except KeyboardInterrupt:  # raised when the step was done
            self._note(begun)
            raise
        self._note(begun)

    def _note(self, begun: float) -> None:
        self._step += 1
        self._seconds += time.perf_counter() - begun
        ends = self._step % self._window == 0
        shown = bool(self._frames) and self._step % self._frames == 0
        if not (ends or shown or self._step >= self._next):
            return
        self._writer.require_folder()
        # The engine keeps deaths until they are read: look again before they can fill an eighth of its room.
        full = 8 * max(world.waiting_deaths for world in self._simulation.worlds)
        self._recorder.deaths()
        self._next = self._step + max(1, int(min(self._window, 1 / full if full else self._window)))
        if ends:
            self._recorder.interval()
        if shown:
            self._recorder.frame()
        if self._recorder.checkpoint_due:
            self._recorder.checkpoint(self._step, self._seconds)

    def close(self, status: str = "finished") -> Manifest:
        """Writes all that is left and the end of the manifest; a second call changes nothing.

        Returns:
            The manifest as it was saved.

        Raises:
            RecordError: Something could not be written.
        """
        if self._manifest.ended is not None:
            return self._manifest
        with self._held:
            if status != "failed":
                self._recorder.deaths()
                self._recorder.checkpoint(self._step, self._seconds)
                self._recorder.interval()
            self._recorder.living()
            whole = replace(self._manifest, steps_asked=max(self._step, 1))
            self._manifest = last_manifest(whole, self._simulation, status, self._seconds, self._writer)
        save_snapshot(self.folder, snapshot(self._simulation.worlds[0]))
        return self._manifest
