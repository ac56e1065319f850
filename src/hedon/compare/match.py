"""Matches the worlds of two conditions within each seed and each combination of all other factors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_UNPAIRED = 0.5
"""Largest share of the smaller condition's worlds without a counterpart for which pairs are compared."""


@dataclass(frozen=True, eq=False)
class Matched:
    """The values of one measure in two conditions, one per seed.

    Attributes:
        values: Values of the first condition, by seed, shape (worlds,).
        others: Values of the second condition, shape (worlds,); if paired, for the same seeds.
        paired: Whether the values are pairs.
        left_out: Number of worlds with a value but without a counterpart in the other condition.
    """

    values: Floats
    others: Floats
    paired: bool
    left_out: int


def match(first: pl.DataFrame, second: pl.DataFrame, name: str, factors: Sequence[str], *, paired: bool) -> Matched:
    """Matches two conditions, so that the compared values differ only in the condition.

    In pairs, a world is compared with the world of the same seed and the same other factors; a seed with several such
    combinations counts once, with the mean of its pairs. Otherwise the mean of each combination, with equal weight for
    both conditions, is subtracted first, so that unequal numbers of worlds do not look like a difference.

    Args:
        first: Worlds of the first condition.
        second: Worlds of the second condition.
        name: Column of the measure.
        factors: Columns of all other factors.
        paired: Whether to compare pairs.
    """
    one, other = (known_values(table, name, factors) for table in (first, second))
    pairs = one.join(other, on=["seed", *factors], suffix="_other")
    if paired and pairs.height and pairs.height >= (1.0 - MOST_UNPAIRED) * min(one.height, other.height):
        seeds = pairs.group_by("seed").agg(pl.col("value", "value_other").mean()).sort("seed")
        left_out = one.height + other.height - 2 * pairs.height
        return Matched(seeds["value"].to_numpy(), seeds["value_other"].to_numpy(), True, left_out)
    if not factors:
        return Matched(one.sort("seed")["value"].to_numpy(), other.sort("seed")["value"].to_numpy(), False, 0)
    means = [each.group_by(factors).agg(pl.col("value").mean()) for each in (one, other)]
    settings = (
        means[0]
        .join(means[1], on=factors, suffix="_other")
        .select(*factors, middle=(pl.col("value") + pl.col("value_other")) / 2)
    )
    kept = [each.join(settings, on=factors) for each in (one, other)]
    overall = settings["middle"].mean()
    by_seed = [
        each.group_by("seed").agg((pl.col("value") - pl.col("middle")).mean() + overall).sort("seed") for each in kept
    ]
    left_out = one.height + other.height - sum(each.height for each in kept)
    return Matched(by_seed[0]["value"].to_numpy(), by_seed[1]["value"].to_numpy(), False, left_out)


def known_values(table: pl.DataFrame, name: str, factors: Sequence[str]) -> pl.DataFrame:
    """The known value of each seed and combination of factors; replicates of a seed with equal factors are averaged.

    Args:
        table: Worlds.
        name: Column of the measure.
        factors: Columns of the factors.

    Returns:
        Columns "seed", those of the factors, and "value".
    """
    rows = table.select("seed", *factors, value=pl.col(name).cast(pl.Float64)).fill_nan(None).drop_nulls("value")
    # The order of the table is kept, so that sums over worlds are reproducible.
    return rows.group_by("seed", *factors, maintain_order=True).agg(pl.col("value").mean())
