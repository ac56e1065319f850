"""Matches the worlds of two conditions within each seed and each combination of all other factors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.text import count

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
        left_out: Number of worlds of both conditions that are not compared, for lack of a value or a counterpart.
    """

    values: Floats
    others: Floats
    paired: bool
    left_out: int


@dataclass(frozen=True)
class ContrastDesign:
    """How all measures of two conditions are compared.

    Attributes:
        paired: Whether in pairs of equal seeds; otherwise as independent samples.
        sentence: This, and the reason.
    """

    paired: bool
    sentence: str


def choose_design(
    first: pl.DataFrame, second: pl.DataFrame, names: Sequence[str], factors: Sequence[str] = (), *, paired: bool = True
) -> ContrastDesign:
    """Chooses pairs if at least half of the smaller condition's worlds have a counterpart, whatever their values.

    Args:
        first: Worlds of the first condition.
        second: Worlds of the second condition.
        names: Names of the two conditions.
        factors: Columns of all other factors.
        paired: Whether the user allows pairs.
    """
    if not paired:
        return ContrastDesign(False, "Compared as independent samples, as requested.")
    apart = "compared as independent samples, which needs more worlds."
    one, other = (_units(table, factors) for table in (first, second))
    if not set(one["seed"]) & set(other["seed"]):
        return ContrastDesign(False, f"No seed in common: {apart}")
    pairs = one.join(other, on=one.columns)
    least, name = min((one.height, names[0]), (other.height, names[1]), key=lambda each: each[0])
    if not pairs.height or pairs.height < (1.0 - MOST_UNPAIRED) * least:
        shared = f"Only {pairs.height} of the {least} worlds" if pairs.height else "None of the worlds"
        has = "have" if pairs.height > 1 else "has"
        settings = " and settings" if factors else ""
        return ContrastDesign(False, f"{shared} of {name} {has} a counterpart of the same seed{settings}: {apart}")
    left_out = one.height + other.height - 2 * pairs.height
    sentence = f"Compared in pairs of equal seeds: {count(pairs['seed'].n_unique(), 'pair')}"
    if left_out:
        sentence += f"; {count(left_out, 'world')} without a counterpart {'is' if left_out == 1 else 'are'} left out"
    return ContrastDesign(True, f"{sentence}.")


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
        paired: Whether to compare pairs; see `choose_design`.
    """
    one, other = (known_values(table, name, factors) for table in (first, second))
    worlds = sum(_units(table, factors).height for table in (first, second))
    if paired:
        pairs = one.join(other, on=["seed", *factors], suffix="_other")
        seeds = pairs.group_by("seed").agg(pl.col("value", "value_other").mean()).sort("seed")
        left_out = worlds - 2 * pairs.height
        return Matched(seeds["value"].to_numpy(), seeds["value_other"].to_numpy(), True, left_out)
    if not factors:
        left_out = worlds - one.height - other.height
        return Matched(one.sort("seed")["value"].to_numpy(), other.sort("seed")["value"].to_numpy(), False, left_out)
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
    left_out = worlds - sum(each.height for each in kept)
    return Matched(by_seed[0]["value"].to_numpy(), by_seed[1]["value"].to_numpy(), False, left_out)


def _units(table: pl.DataFrame, factors: Sequence[str]) -> pl.DataFrame:
    """Every seed with each of its combinations of factors, once."""
    return table.select("seed", *factors).unique()


def known_values(table: pl.DataFrame, name: str, factors: Sequence[str]) -> pl.DataFrame:
    """The known value of each seed and combination of factors; replicates of a seed with equal factors are averaged.

    Returns:
        Columns "seed", those of the factors, and "value".
    """
    rows = table.select("seed", *factors, value=pl.col(name).cast(pl.Float64)).fill_nan(None).drop_nulls("value")
    # The order of the table is kept, so that sums over worlds are reproducible.
    return rows.group_by("seed", *factors, maintain_order=True).agg(pl.col("value").mean())
