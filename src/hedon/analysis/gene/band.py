"""Drift bands: the range of each gene under drift, drawn in gray behind its course.

Each gene has its own control: neutral genes with its founders and mutations, walked down the pedigrees of the same
worlds. The recorded neutral genes are no control for a gene with other founders or mutations, since they start
elsewhere or stray more or less. If no gene can walk down a pedigree (`walked_pedigree`), the recorded genes serve as
controls for genes with the same law, if there are enough of them; other genes then have no control.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.descent.walk import MutationLaw, mutation_law, neutral_genes
from hedon.analysis.gene.course import standard_courses, standard_interval
from hedon.analysis.gene.pedigree import like_neutral, walked_pedigree
from hedon.analysis.world.population import history
from hedon.analysis.world.record import WorldRecord, generator

ENOUGH_GENES = 8
"""Minimum number of recorded neutral genes, over all worlds, that can serve as a control."""
_RANGE = (0.025, 0.975)
_WALKS = 100  # neutral genes per world for distributions over agents

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DriftBand:
    """Range of 95 % of neutral genes with one law, as means over the living agents of a world.

    Attributes:
        step: Times from the first on, (times,) [step].
        low, high: Bounds at these times, (times,).
    """

    step: Floats
    low: Floats
    high: Floats


def drift_bands(worlds: Sequence[WorldRecord]) -> dict[str, DriftBand]:
    """Drift band of each gene in one condition, over all its worlds.

    Args:
        worlds: Worlds of the condition, at least one.

    Returns:
        By genome column; genes without a control are missing.
    """
    if any(walked_pedigree(world) is None for world in worlds):
        return _recorded_bands(worlds)
    courses = [course for course in standard_courses(worlds) if course is not None]
    if not courses:
        return {}
    step = standard_interval(worlds) * np.arange(1 + max(course.intervals for course in courses))
    laws, bands = _laws(worlds[0]), {}
    for name, law in laws.items():
        if law not in bands:
            walks = [course.neutral[name] for course in courses]
            samples = (np.concatenate([walk[:, i] for walk in walks if walk.shape[1] > i]) for i in range(len(step)))
            low, high = np.array([np.quantile(values, _RANGE) for values in samples], np.float64).T
            bands[law] = DriftBand(step.astype(np.float64), low, high)
    return {name: bands[law] for name, law in laws.items()}


def drift_genes(worlds: Sequence[WorldRecord], agents: Sequence[pl.DataFrame]) -> dict[str, Floats]:
    """Values of each gene that some agents would have after drift: many draws per agent.

    Args:
        worlds: Worlds of one condition.
        agents: For each world, rows of its table `agents`.

    Returns:
        By genome column, values of all agents together, (draws,), each agent with equal weight; genes without a control
        are missing.
    """
    trees = [walked_pedigree(world) for world in worlds]
    draws: dict[MutationLaw, list[Floats]] = {}
    for world, tree, rows in zip(worlds, trees, agents, strict=True):
        if tree is None:
            return _recorded_genes(worlds, agents)
        sample = np.flatnonzero(world.agents["agent_id"].is_in(rows["agent_id"].implode()).to_numpy())
        rng = generator(world)
        for law in dict.fromkeys(_laws(world).values()):
            values = neutral_genes(tree, sample, law, rng, _WALKS) if len(sample) else np.empty((0, 0))
            draws.setdefault(law, []).append(values.ravel().astype(np.float64))
    pooled = {law: np.concatenate(values) for law, values in draws.items()}
    return {name: pooled[law] for name, law in _laws(worlds[0]).items() if len(pooled[law])}


def _laws(world: WorldRecord) -> dict[str, MutationLaw]:
    return {name: mutation_law(world.config, world.gene(name)) for name in world.weight_names}


def _controls(world: WorldRecord) -> dict[str, list[str]]:
    """For each gene, the recorded neutral genes with its law; a neutral gene includes itself."""
    controls = like_neutral(world)
    return {name: [*names, *([name] if name in world.neutral_names else [])] for name, names in controls.items()}


def _recorded_bands(worlds: Sequence[WorldRecord]) -> dict[str, DriftBand]:
    stacked = pl.concat([world.population.with_columns(world=pl.lit(i, pl.Int32)) for i, world in enumerate(worlds)])
    rows = history(stacked, (), worlds[0].neutral_names)
    bands = {}
    for name, controls in _controls(worlds[0]).items():
        courses = rows.unpivot([f"{control}_mean" for control in controls], index=["bin", "step"]).drop_nulls("value")
        low, high = (pl.col("value").quantile(bound, "linear") for bound in _RANGE)
        quantiles = courses.group_by("bin").agg(pl.col("step").max(), pl.len(), low=low, high=high).sort("step")
        quantiles = quantiles.filter(pl.col("len") >= ENOUGH_GENES)
        if quantiles.height:
            bounds = (quantiles[column].cast(pl.Float64).to_numpy() for column in ("step", "low", "high"))
            bands[name] = DriftBand(*bounds)
    return bands


def _recorded_genes(worlds: Sequence[WorldRecord], agents: Sequence[pl.DataFrame]) -> dict[str, Floats]:
    pooled = {}
    for name, controls in _controls(worlds[0]).items():
        if len(controls) * len(worlds) >= ENOUGH_GENES:
            values = [rows.select(controls).to_numpy().ravel().astype(np.float64) for rows in agents]
            pooled[name] = np.concatenate(values)
    return {name: values for name, values in pooled.items() if len(values)}
