"""Which worlds is an item made from? What a reader must know of them, and how worlds of several arms are joined."""

from collections.abc import Iterable, Mapping, Sequence

import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.study.item import Arm, Material

_NAMED = 3  # at most this many seeds that died out are named


def present(arms: Iterable[Arm], material: Material) -> dict[str, Sequence[WorldRecord]]:
    """The worlds of each arm that has any, by label and in the order of the arms."""
    found = {arm.label: material.worlds.get(arm.label, ()) for arm in arms}
    return {label: worlds for label, worlds in found.items() if worlds}


def missing(arms: Iterable[Arm], material: Material) -> str:
    """A sentence that names the arms without worlds; empty where there is none."""
    absent = [arm.label for arm in arms if not material.worlds.get(arm.label)]
    return f"Not run yet: {'; '.join(absent)}." if absent else ""


def sentences(*parts: str) -> str:
    """Puts sentences together, without those that are empty."""
    return " ".join(filter(None, parts))


def count_extinct(worlds: Iterable[WorldRecord]) -> int:
    """How many of the worlds died out."""
    return sum(world.extinct_step is not None for world in worlds)


def steps_reached(worlds: Iterable[WorldRecord]) -> int:
    """How far the longest of the records reaches [step]."""
    return max((world.last_step for world in worlds), default=0)


def describe(worlds: Sequence[WorldRecord]) -> tuple[str, str]:
    """What a title says of one arm's worlds: how many and how long, and which of them died out."""
    living = [world.last_step for world in worlds if world.extinct_step is None]
    count = f"{len(worlds)} world{'s' if len(worlds) > 1 else ''}"
    if not living:
        step = _steps(steps_reached(worlds))
        return count, f"died out at step {step}" if len(worlds) == 1 else f"all died out by step {step}"
    reach = _steps(max(living)) if min(living) == max(living) else f"{_steps(min(living))} to {_steps(max(living))}"
    return f"{count}, {reach} steps", _died_out([world.seed for world in worlds if world.extinct_step is not None])


def world_indices(groups: Iterable[Sequence[WorldRecord]]) -> dict[int, int]:
    """An index per seed, from 0 on: the same seed has the same color in each arm."""
    seeds = sorted({world.seed for worlds in groups for world in worlds})
    return {seed: index for index, seed in enumerate(seeds)}


def stack(worlds: Iterable[WorldRecord], table: str, indices: Mapping[int, int]) -> pl.DataFrame:
    """The rows of one table ("agents" or "population") of all worlds, with `world` as its seed's index."""
    return pl.concat(
        getattr(world, table).with_columns(world=pl.lit(indices[world.seed], pl.Int32)) for world in worlds
    )


def _died_out(seeds: Sequence[int]) -> str:
    if not seeds:
        return "none died out"
    if len(seeds) > _NAMED:
        return f"{len(seeds)} died out"
    return f"seed{'s' if len(seeds) > 1 else ''} {', '.join(map(str, sorted(seeds)))} died out"


def _steps(count: int) -> str:
    return f"{count / 1e6:.4g} million" if count >= 10**6 else f"{count:,}"
