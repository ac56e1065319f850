"""From run folders to what items are made from: the worlds that were asked for, as far as they are there."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import ConfigError, digest, load_config
from hedon.record.error import RecordError
from hedon.record.folder import CONFIG, MANIFEST
from hedon.record.reader import Run, open_run
from hedon.record.snapshot import Snapshot, load_snapshot
from hedon.replication.item.item import Item, Material
from hedon.replication.request import Need, Request, needs, setting_name


@dataclass(frozen=True)
class Gathered:
    """All that the items of a request are made from.

    Attributes:
        request: what was asked.
        runs: that hold some of the worlds.
        worlds: per setting's digest and seed, as far as their records reach.
        snapshots: per setting's digest the last state of one world, where there is one.
        faults: what could not be read, and why.
    """

    request: Request
    runs: tuple[Run, ...]
    worlds: dict[tuple[str, int], WorldRecord]
    snapshots: dict[str, Snapshot]
    faults: tuple[str, ...]

    def material(self, item: Item) -> Material:
        """What one item is made from."""
        scale, fidelity = self.request.scale(item), self.request.fidelity
        digests = {arm.label: digest(arm.config(fidelity)) for arm in item.arms}
        worlds = {
            label: [self.worlds[key, seed].until(scale.steps) for seed in scale.seeds if (key, seed) in self.worlds]
            for label, key in digests.items()
        }
        snapshots = {label: self.snapshots[key] for label, key in digests.items() if key in self.snapshots}
        return Material(fidelity, {label: group for label, group in worlds.items() if group}, snapshots)

    def demanded(self) -> list[WorldRecord]:
        """Every world once, as long as the most demanding item asks for."""
        return [
            self.worlds[need.digest, seed].until(steps)
            for need in needs(self.request)
            for seed, steps in need.steps.items()
            if (need.digest, seed) in self.worlds
        ]


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
            mine = seeds.get(run.manifest.config_digest or "", ())
            if run.manifest.parent is None and any(seed in mine for seed in run.manifest.seeds):
                load_config(run.path / CONFIG)
                runs.append(run)
        except (RecordError, ConfigError) as error:
            faults.append(str(error))
    return runs, faults


def gather(request: Request, folder: Path) -> Gathered:
    """Reads what there is of the worlds that a request needs; what is damaged is left out and named."""
    wanted = needs(request)
    runs, faults = find_runs(folder, wanted)
    damaged = {run.path.name: run.damaged_parts() for run in runs}
    faults += [f"{part} is damaged: its rows are missing" for parts in damaged.values() for part in parts]
    status = {run.path.name: run.manifest.status for run in runs}
    needed = {need.digest: need for need in wanted}
    kept: dict[tuple[str, int], WorldRecord] = {}
    # Whole runs first, since of two worlds that are equally long the first is kept.
    for world in read_worlds(sorted(runs, key=lambda run: bool(damaged[run.path.name]))):
        need = needed.get(digest(world.config))
        if need is not None and world.seed in need.steps:
            known = world if status[world.run] in ("finished", "interrupted") else world.until(world.recorded_step())
            # Equal settings can be written in several ways, so the need names them, not each run.
            kept[need.digest, world.seed] = replace(known, condition=setting_name(need.config))
    used = {world.run for world in kept.values()}
    snapshots = _snapshots(request, runs, faults)
    return Gathered(request, tuple(run for run in runs if run.path.name in used), kept, snapshots, tuple(faults))


def _snapshots(request: Request, runs: Iterable[Run], faults: list[str]) -> dict[str, Snapshot]:
    """Per setting that is to be pictured the first state found in which somebody lives, or else any."""
    wanted = {digest(arm.config(request.fidelity)) for item in request.items if item.pictures for arm in item.arms}
    found: dict[str, Snapshot] = {}
    for run in runs:
        key = run.manifest.config_digest or ""
        if key not in wanted or (key in found and len(found[key].x)):
            continue
        try:
            snapshot = load_snapshot(run.path)
        except RecordError as error:
            faults.append(str(error))
            continue
        if snapshot is not None:
            found[key] = snapshot
    return found
