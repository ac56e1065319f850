"""The worlds that are needed, where they are, and how far each of them is.

A world is known by the digest of its config and by its seed. Studies and assays find theirs in the folders of runs.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import Config, ConfigError
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.record.error import RecordError
from hedon.record.folder import MANIFEST
from hedon.record.founder import Founders
from hedon.record.manifest import RuleSource
from hedon.record.reader import Run, open_run


@dataclass
class RunRequirement:
    """A setting that worlds are needed of, by one question or several.

    Attributes:
        config: the setting.
        digest: of the config: settings of equal digest share their worlds.
        steps: of each seed [step].
        frames: steps between two records of all positions; 0 where nobody needs them.
        founders: genomes that its worlds begin with; None where they are drawn from the setting's laws.
        rules: texts of the rules that the config is pinned to.
        name: of the folder of a new run; empty for one that tells the setting from all others.
    """

    config: Config
    digest: str
    steps: dict[int, int] = field(default_factory=dict)
    frames: int = 0
    founders: Founders | None = None
    rules: Sequence[RuleSource] = ()
    name: str = ""

    def has_frames(self, run: Run) -> bool:
        """Whether a run recorded the positions that are needed."""
        every = run.manifest.frames
        return self.frames == 0 or (every > 0 and self.frames % every == 0)


def part_of(requirements: Sequence[RunRequirement], part: tuple[int, int]) -> list[RunRequirement]:
    """The share of some worlds that one of several machines makes: every N-th world, from the I-th on.

    Folders of named runs have the part's number in their names, so that machines do not meet in one.
    """
    number, count = part
    if count == 1:
        return list(requirements)
    worlds = [(need, seed) for need in requirements for seed in need.steps][number - 1 :: count]
    shares = [
        replace(
            need,
            steps={seed: need.steps[seed] for of, seed in worlds if of is need},
            name=need.name and f"{need.name}-{number}",
        )
        for need in requirements
    ]
    return [share for share in shares if share.steps]


def setting_name(config: Config) -> str:
    """What a setting is called: its preset and fidelity, and what it changes; no two settings have one name."""
    words = [f"{path} {format_value(new)}" for path, _, new in changed_settings(config)]
    return ", ".join([f"{config.preset} ({config.fidelity})", *words])


def find_runs(folder: Path, wanted: Iterable[RunRequirement]) -> tuple[list[Run], list[str]]:
    """The runs in a folder that hold worlds of the settings that are needed, from their beginning on.

    Returns:
        The runs by name, and what is wrong with folders that hold a run that cannot be read, and may be needed.
    """
    wanted = list(wanted)
    seeds = {need.digest: need.steps.keys() for need in wanted}
    presets = {(need.config.preset, need.config.fidelity) for need in wanted}
    runs, faults = [], []
    for path in sorted(folder.glob(f"*/{MANIFEST}")):
        try:
            run = open_run(path.parent).load()
            manifest = run.manifest
            mine = seeds.get(manifest.config_digest or "", ())
            is_needed = manifest.parent is None and any(seed in mine for seed in manifest.seeds)
            # A config that this version cannot read, as one that lacks a setting, might be one that is needed.
            if is_needed or (manifest.preset, manifest.fidelity) in presets:
                _ = run.config
            if is_needed:
                runs.append(run)
        except (RecordError, ConfigError) as error:
            faults.append(str(error))
    return runs, faults


def read_required(wanted: Iterable[RunRequirement], runs: Iterable[Run]) -> dict[tuple[str, int, str], WorldRecord]:
    """The worlds that are needed, as far as some runs have them and their records reach.

    Returns:
        Per setting's digest, seed and species; a world may be longer than it need be.
    """
    needed, by_name = {need.digest: need for need in wanted}, {run.path.name: run.manifest for run in runs}
    kept: dict[tuple[str, int, str], WorldRecord] = {}
    for world in read_worlds(runs):
        manifest = by_name[world.run]
        need = needed.get(manifest.config_digest or "")
        if need is not None and world.seed in need.steps:
            is_whole = manifest.status in ("finished", "interrupted")
            known = world if is_whole else world.until(world.recorded_step())
            # Equal settings can be written in several ways, so the need names them, not each run.
            name = setting_name(need.config) + (f": {world.species}" if len(need.config.species) > 1 else "")
            kept[need.digest, world.seed, world.species] = replace(known, condition=name)
    return kept


def steps_reached(run: Run) -> dict[int, float]:
    """Steps that a run has of each seed's world [step]; infinite if the world died out."""
    manifest = run.manifest
    if manifest.status in ("finished", "interrupted"):
        done = [
            math.inf if extinct is not None else steps
            for steps, extinct in zip(manifest.steps_done, manifest.extinct_steps, strict=True)
        ]
        return dict(zip(manifest.seeds, done, strict=True))
    # The manifest of a run that is still running, or was killed, does not say how far it came; its records do.
    reach: dict[int, float] = {}
    for world in read_worlds([run]):  # one for each species
        reach[world.seed] = min(reach.get(world.seed, math.inf), world.recorded_step())
    return reach
