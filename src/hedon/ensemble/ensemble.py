"""An ensemble: the worlds that are needed, and the runs in a folder that contain them.

A world is identified by the digest of its config and by its seed. Studies and assays use this to find their worlds.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import ConfigError
from hedon.ensemble.demand import Demand, setting_name, worlds_of
from hedon.record.error import RecordError
from hedon.record.folder import MANIFEST
from hedon.record.reader import Run, open_run

ENDED = ("finished", "interrupted")
"""The states in which the manifest records how far the run got."""


@dataclass(frozen=True, eq=False)
class Ensemble:
    """Worlds of one or more conditions, as far as a folder contains them.

    Attributes:
        demands: The worlds that are needed, one demand per condition.
        folder: Folder of the existing runs, in which missing runs are created.
        runs: Runs that contain some of the worlds from their start, by name.
        faults: Problems of folders with an unreadable run that may be needed.
    """

    demands: Sequence[Demand]
    folder: Path
    runs: Sequence[Run] = ()
    faults: tuple[str, ...] = ()

    @property
    def size(self) -> int:
        """The number of worlds needed."""
        return worlds_of(self.demands)

    @cached_property
    def damaged(self) -> dict[str, list[Path]]:
        """The damaged parts of each run, by its name."""
        return {run.path.name: run.damaged_parts() for run in self.runs}

    @cached_property
    def worlds(self) -> dict[tuple[str, int, str], WorldRecord]:
        """The needed worlds by the digest of their config, seed and species, as far as their records reach.

        A world may be longer than needed. If two are equally long, the one from an undamaged run is kept.
        """
        by_digest = {demand.digest: demand for demand in self.demands}
        manifests = {run.path.name: run.manifest for run in self.runs}
        records: dict[tuple[str, int, str], WorldRecord] = {}
        for world in read_worlds(sorted(self.runs, key=lambda run: bool(self.damaged[run.path.name]))):
            manifest = manifests[world.run]
            demand = by_digest.get(manifest.config_digest or "")
            if demand is not None and world.seed in demand.steps:
                reached = world if manifest.status in ENDED else world.until(world.recorded_step())
                # Equal settings can be written in several ways, so their name comes from the demand, not from each run.
                species = f": {world.species}" if len(demand.config.species) > 1 else ""
                records[demand.digest, world.seed, world.species] = replace(
                    reached, condition=setting_name(demand.config) + species
                )
        return records

    def runs_of(self, worlds: Iterable[WorldRecord]) -> tuple[Run, ...]:
        """The runs that contain these worlds."""
        names = {world.run for world in worlds}
        return tuple(run for run in self.runs if run.path.name in names)


def find_ensemble(demands: Sequence[Demand], folder: Path) -> Ensemble:
    """Finds the runs in a folder that contain worlds of the demands.

    A run that cannot be read is listed as a fault if it may contain such a world.
    """
    presets = {(demand.config.preset, demand.config.fidelity) for demand in demands}
    runs, faults = [], []
    for path in sorted(folder.glob(f"*/{MANIFEST}")):
        try:
            run = open_run(path.parent).load()
            manifest = run.manifest
            matching = [demand for demand in demands if demand.holds(manifest)]
            is_wanted = any(seed in demand.steps for demand in matching for seed in manifest.seeds)
            # A config that this version cannot read, such as one that lacks a setting, may belong to a needed world.
            if is_wanted or (manifest.preset, manifest.fidelity) in presets:
                _ = run.config
            if is_wanted:
                runs.append(run)
        except (RecordError, ConfigError) as error:
            faults.append(str(error))
    return Ensemble(demands, folder, runs, tuple(faults))


def steps_reached(run: Run) -> dict[int, float]:
    """How far a run got with the world of each seed [step]; infinite if the world died out."""
    manifest = run.manifest
    if manifest.status in ENDED:
        steps_done = [
            math.inf if extinct is not None else steps
            for steps, extinct in zip(manifest.steps_done, manifest.extinct_steps, strict=True)
        ]
        return dict(zip(manifest.seeds, steps_done, strict=True))
    # If a run is in progress or was killed, only its records show how far it got.
    reached_steps: dict[int, float] = {}
    for world in read_worlds([run]):  # one record per species
        reached_steps[world.seed] = min(reached_steps.get(world.seed, math.inf), world.recorded_step())
    return reached_steps
