"""Reads from run folders the data of which items are made: the needed worlds, as far as they exist."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.config import digest
from hedon.config.layout import choose_species
from hedon.ensemble.ensemble import Ensemble, find_ensemble
from hedon.record.error import RecordError
from hedon.record.reader import Run
from hedon.record.snapshot import Snapshot, load_snapshot
from hedon.study.item import Item, ItemInputs
from hedon.study.request import Request, needs


@dataclass(frozen=True)
class Gathered:
    """The data for all items of a request.

    Attributes:
        request: The request.
        runs: Runs that contain some of the worlds.
        worlds: Worlds by digest of the config, seed and species, as far as their records reach.
        frames: Recorded positions by digest of the config and seed.
        snapshots: Last state of one world by digest of the config, if available.
        faults: Files that could not be read, with the reason.
    """

    request: Request
    runs: tuple[Run, ...]
    worlds: dict[tuple[str, int, str], WorldRecord]
    frames: dict[tuple[str, int], pl.LazyFrame]
    snapshots: dict[str, Snapshot]
    faults: tuple[str, ...]

    def inputs(self, item: Item) -> ItemInputs:
        """The data for one item."""
        scale, fidelity = self.request.scale(item), self.request.fidelity
        configs = {condition.label: condition.config(fidelity) for condition in item.conditions}
        digests = {label: digest(config) for label, config in configs.items()}
        shown_species = {
            condition.label: condition.species or next(iter(configs[condition.label].species))
            for condition in item.conditions
        }
        worlds = {
            label: [
                self.worlds[key, seed, shown_species[label]].until(scale.steps)
                for seed in scale.seeds
                if (key, seed, shown_species[label]) in self.worlds
            ]
            for label, key in digests.items()
        }
        snapshots = {label: self.snapshots[key] for label, key in digests.items() if key in self.snapshots}
        is_within = pl.col("step") <= scale.steps
        frames = {
            label: [self.frames[key, seed].filter(is_within) for seed in scale.seeds if (key, seed) in self.frames]
            for label, key in digests.items()
            if item.frames
        }
        return ItemInputs(fidelity, {label: group for label, group in worlds.items() if group}, snapshots, frames)

    def demanded(self) -> list[WorldRecord]:
        """Every world once, cut at the steps of the most demanding item, with the label of its condition."""
        labels = self._labels()
        return [
            replace(self.worlds[demand.digest, seed, species].until(steps), condition=labels[demand.digest, species])
            for demand in needs(self.request)
            for seed, steps in demand.steps.items()
            for species in demand.config.species
            if (demand.digest, seed, species) in self.worlds
        ]

    def _labels(self) -> dict[tuple[str, str], str]:
        """A unique label for each condition and species, from the first item that shows it."""
        labels: dict[tuple[str, str], str] = {}
        pairs = [(item, condition) for item in self.request.items for condition in item.conditions]
        for is_shown in (True, False):
            for item, condition in pairs:
                config = condition.config(self.request.fidelity)
                shown_species = choose_species(condition.species or None, config)
                for species in [shown_species] if is_shown else config.species:
                    label = condition.label if species == shown_species else f"{condition.label}: {species}"
                    label = f"{item.name}: {label}" if label in labels.values() else label
                    labels.setdefault((digest(config), species), label)
        return labels


def gather(request: Request, folder: Path) -> Gathered:
    """Reads the available worlds that a request needs; damaged data are left out and listed as faults.

    Args:
        request: The items with their scale.
        folder: Folder of the runs.
    """
    ensemble = find_ensemble(needs(request), folder)
    faults = list(ensemble.faults)
    faults += [f"{part} is damaged: its rows are missing" for parts in ensemble.damaged.values() for part in parts]
    snapshots = _snapshots(request, ensemble.runs, faults)
    runs = ensemble.runs_of(ensemble.worlds.values())
    return Gathered(request, runs, ensemble.worlds, _frames(ensemble, runs), snapshots, tuple(faults))


def _frames(ensemble: Ensemble, runs: Iterable[Run]) -> dict[tuple[str, int], pl.LazyFrame]:
    """The positions that an item needs of each world, from the longest run."""
    demands = {demand.digest: demand for demand in ensemble.demands}
    frames: dict[tuple[str, int], pl.LazyFrame] = {}
    for run in sorted(runs, key=lambda run: max([*run.manifest.steps_done, 0])):
        demand = demands[run.manifest.config_digest or ""]
        if demand.frames and demand.has_frames(run):
            for index, seed in enumerate(run.manifest.seeds):
                frames[demand.digest, seed] = run.frames().filter(pl.col("world") == index)
    return frames


def _snapshots(request: Request, runs: Iterable[Run], faults: list[str]) -> dict[str, Snapshot]:
    """For each condition with a picture, the first state with living agents, otherwise any state."""
    wanted_digests = {
        digest(condition.config(request.fidelity))
        for item in request.items
        if item.pictures
        for condition in item.conditions
    }
    snapshots: dict[str, Snapshot] = {}
    for run in runs:
        key = run.manifest.config_digest or ""
        if key not in wanted_digests or (key in snapshots and len(snapshots[key].x)):
            continue
        try:
            snapshot = load_snapshot(run.path)
        except RecordError as error:
            faults.append(str(error))
            continue
        if snapshot is not None:
            snapshots[key] = snapshot
    return snapshots
