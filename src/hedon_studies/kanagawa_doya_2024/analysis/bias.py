"""Does a gene drift where the mean of a world's mutations pushes it?

Each generation of a line adds one mutation. In a line without selection, the mutation is a random one of all births, so
the weight moves in each generation by their mean mutation, the *bias*. Frozen noise uses the same table in all windows,
so its bias persists and drives the weight. With independent noise the births also have a mean mutation, but it averages
mutations that happened only once. It shrinks as births accumulate, since the limit of weights bounds each of them, and
it does not predict later mutations.

There are three comparisons of a prediction with an observation, with one pair per world and gene: the bias and the
drift per generation; the weight of lines without selection after as many generations, including the limit, and the
weight of the agents born last; the bias of the first half of a run and of its second half.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis import WorldRecord, last_agents
from hedon.statistic import LEVEL
from hedon_studies.kanagawa_doya_2024.analysis.noise import Mutations, NoiseTable, mutations, noise_table
from hedon_studies.kanagawa_doya_2024.analysis.prediction import prediction

NAN = math.nan
_LINES = 4000

Floats = NDArray[np.float64]

COMPARISONS = {
    "drift per generation": ("bias", "slope"),
    "weight at the end": ("line_mean", "end"),
    "bias, first half and second": ("bias_first", "bias_second"),
}
"""Columns of a `Drift` to compare, the predicted one first."""


Drift = dict[str, Any]
"""Predicted and observed drift of one gene in one world, from `gene_drift`."""


def gene_drift(world: WorldRecord, weight: str, rng: np.random.Generator) -> Drift | None:
    """Predicts where mutation without selection drives a gene, and compares it with the records.

    Args:
        world: The world.
        weight: Genome column of the gene.
        rng: Source of random numbers.

    Returns:
        weight, the genome column; births, the number with a known mutation; numbers, the count of birth numbers within
        a window and thus of table entries; bounds, the count of entries of which only a lower bound is known, since all
        their children were clipped; disagreement, the largest difference between births of equal number that were not
        clipped; is_table, whether they agree, so that there is a table; bias, the mean mutation per birth; bias_first
        and bias_second, the same over the births of either half of the record; line_mean, the mean weight of lines
        without selection after `generations`; line_low and line_high, the bounds of 95 % of them; slope, of the mean
        weight of the living against their mean generation, over the run; displacement, (mean weight of the living at
        the end − mean of the founders' distribution) / generations; end, the mean weight of the 5000 agents born last;
        generations, their mean. Missing values are NaN; the result is None if no birth is recorded.
    """
    recorded = mutations(world, weight)
    if not len(recorded.change):
        return None
    table = noise_table(recorded)
    newest = last_agents(world.agents)
    generations = float(newest["generation"].to_numpy().mean())
    gene = world.gene(weight)
    start, limit = gene.law.initial_mean, gene.mutation.limit
    lines = rng.normal(start, gene.law.initial_sd, _LINES)
    pool = _pool(recorded, table)
    for _ in range(round(generations)):
        lines = np.clip(lines + rng.choice(pool, _LINES), -limit, limit)
    low, high = np.quantile(lines, (0.5 - LEVEL / 2, 0.5 + LEVEL / 2))
    first, second = _half_biases(world, recorded, table)
    slope, displacement = _observed(world.population, weight, start)
    return {
        "weight": weight,
        "births": len(recorded.change),
        "numbers": int(np.count_nonzero(table.births)),
        "bounds": int(table.bound.sum()),
        "disagreement": table.disagreement,
        "is_table": table.is_one,
        "bias": float(pool.mean()),
        "bias_first": first,
        "bias_second": second,
        "line_mean": float(lines.mean()),
        "line_low": float(low),
        "line_high": float(high),
        "slope": slope,
        "displacement": displacement,
        "end": float(newest[weight].to_numpy().mean(dtype=np.float64)),
        "generations": generations,
    }


def compare(drifts: Sequence[Drift], comparison: str) -> dict[str, Any]:
    """Correlates predicted and observed values over worlds and genes.

    Args:
        drifts: Predicted and observed drift of genes.
        comparison: Key of `COMPARISONS`.

    Returns:
        The result of `prediction`.
    """
    predicted, observed = COMPARISONS[comparison]
    return prediction((d[predicted] for d in drifts), (d[observed] for d in drifts))


def _pool(recorded: Mutations, table: NoiseTable) -> Floats:
    """The mutations of all births, taken from the table if there is one, since clipping does not shorten those."""
    return table.value[recorded.number] if table.is_one else recorded.change


def _half_biases(world: WorldRecord, recorded: Mutations, table: NoiseTable) -> tuple[float, float]:
    """Mean mutation over the births of the first and of the second half of the record."""
    pool, is_late = _pool(recorded, table), recorded.birth_step > 0.5 * world.last_step
    first, second = (float(pool[half].mean()) if half.any() else NAN for half in (~is_late, is_late))
    return first, second


def _observed(population: pl.DataFrame, weight: str, start: float) -> tuple[float, float]:
    """The slope of the mean weight against the mean generation, and the displacement per generation."""
    recorded = population.drop_nulls(["generation_mean", f"{weight}_mean"])
    generation, mean = (recorded[name].to_numpy().astype(np.float64) for name in ("generation_mean", f"{weight}_mean"))
    if len(generation) < 2 or np.ptp(generation) == 0:
        return NAN, NAN
    slope = float(np.polyfit(generation, mean, 1)[0])
    return slope, float((mean[-1] - start) / generation[-1]) if generation[-1] > 0 else NAN
