"""Matches the worlds of two conditions: within a seed, and within a setting of all other factors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_UNPAIRED = 0.5
"""Share of the smaller condition's worlds that may lack a counterpart for pairs to be compared."""


@dataclass(frozen=True, eq=False)
class Matched:
    """The values of one measure in two conditions, one per seed.

    Attributes:
        values: Of the first condition, by seed, shape (worlds,).
        others: Of the second, shape (worlds,); in pairs, of the same seeds.
        paired: Whether the values are pairs.
        left_out: Worlds with a value that have no counterpart in the other condition.
    """

    values: Floats
    others: Floats
    paired: bool
    left_out: int


def match(first: pl.DataFrame, second: pl.DataFrame, name: str, factors: Sequence[str], *, paired: bool) -> Matched:
    """Matches two conditions, so that nothing but the condition differs between what is compared.

    In pairs, a world is compared with the world of the same seed and setting; a seed with several settings counts once,
    by the mean of its pairs. Otherwise the mean of each setting, both conditions weighted alike, is taken out first:
    else a setting with more worlds in one condition than in the other would look like a difference.
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
    """The value of each seed and setting that has one; replicates of a seed in one setting count once, by their mean.

    Returns:
        Columns "seed", those of the factors, and "value".
    """
    rows = table.select("seed", *factors, value=pl.col(name).cast(pl.Float64)).fill_nan(None).drop_nulls("value")
    # In the order of the table, so that sums over worlds are the same each time.
    return rows.group_by("seed", *factors, maintain_order=True).agg(pl.col("value").mean())
