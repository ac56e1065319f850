"""From run folders to what items are made from: the worlds that were asked for, as far as they are there."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from hedon.analysis.item.item import Item, Material
from hedon.analysis.item.request import Need, Request, needs
from hedon.analysis.world import WorldRecord, read_worlds
from hedon.config import digest
from hedon.record.error import RecordError
from hedon.record.folder import MANIFEST
from hedon.record.reader import Run, open_run
from hedon.record.snapshot import Snapshot, load_snapshot


@dataclass(frozen=True)
class Gathered:
    """All that the items of a request are made from.

    Attributes:
        request: what was asked.
        runs: that hold some of the worlds.
        worlds: per setting's digest and seed, as far as their records reach.
        faults: folders that could not be read, and why.
    """

    request: Request
    runs: tuple[Run, ...]
    worlds: dict[tuple[str, int], WorldRecord]
    faults: tuple[str, ...]

    def material(self, item: Item) -> Material:
        """What one item is made from."""
        scale, fidelity = self.request.scale(item), self.request.fidelity
        digests = {arm.label: digest(arm.config(fidelity)) for arm in item.arms}
        worlds = {
            label: [self.worlds[key, seed].until(scale.steps) for seed in scale.seeds if (key, seed) in self.worlds]
            for label, key in digests.items()
        }
        snapshots: dict[str, Snapshot] = {}
        if item.pictures:
            found = {label: self._snapshot(key) for label, key in digests.items()}
            snapshots = {label: snapshot for label, snapshot in found.items() if snapshot is not None}
        return Material(fidelity, {label: group for label, group in worlds.items() if group}, snapshots)

    def demanded(self) -> list[WorldRecord]:
        """Every world once, as long as the most demanding item asks for."""
        return [
            self.worlds[need.digest, seed].until(steps)
            for need in needs(self.request)
            for seed, steps in need.steps.items()
            if (need.digest, seed) in self.worlds
        ]

    def _snapshot(self, key: str) -> Snapshot | None:
        for run in self.runs:
            if run.manifest.config_digest == key and (snapshot := load_snapshot(run.path)) is not None:
                return snapshot
        return None


def find_runs(folder: Path, wanted: Iterable[Need]) -> tuple[list[Run], list[str]]:
    """The runs in a folder that hold worlds of the settings that are needed, from their beginning on.

    Returns:
        The runs by name, and what is wrong with folders that hold a run that cannot be read.
    """
    seeds = {need.digest: need.steps.keys() for need in wanted}
    runs, faults = [], []
    for path in sorted(folder.glob(f"*/{MANIFEST}")):
        try:
            run = open_run(path.parent)
        except RecordError as error:
            faults.append(str(error))
            continue
        mine = seeds.get(run.manifest.config_digest or "", ())
        if run.manifest.parent is None and any(seed in mine for seed in run.manifest.seeds):
            runs.append(run)
    return runs, faults


def gather(request: Request, folder: Path) -> Gathered:
    """Reads what there is of the worlds that a request needs.

    Raises:
        RecordError, ConfigError: a run cannot be read.
    """
    wanted = needs(request)
    runs, faults = find_runs(folder, wanted)
    seeds: dict[str, Sequence[int]] = {need.digest: list(need.steps) for need in wanted}
    worlds = {(digest(world.config), world.seed): world for world in read_worlds(runs)}
    kept = {key: world for key, world in worlds.items() if key[1] in seeds.get(key[0], ())}
    used = {world.run for world in kept.values()}
    return Gathered(request, tuple(run for run in runs if run.path.name in used), kept, tuple(faults))
