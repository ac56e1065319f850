"""Birth cohorts and the genomes in them."""

from collections.abc import Sequence

import numpy as np
import polars as pl

COMPLETE = 0.99
"""Share of a cohort that must have died for its lives to count as fully known. The last to die have the most children:
a cohort cut off at 0.95 has a tenth less of the opportunity for selection."""
QUANTILES = {"q05": 0.05, "q25": 0.25, "median": 0.5, "q75": 0.75, "q95": 0.95}


def with_cohorts(agents: pl.DataFrame, last_step: int, windows: int) -> pl.DataFrame:
    """Adds the column `window`, which divides the run into windows of equal length by step of birth.

    Args:
        agents: Table `agents` of one world.
        last_step: End of the records [step].
        windows: Number of windows.
    """
    width = max(last_step / windows, 1.0)
    index = (pl.col("birth_step") / width).floor().clip(0, windows - 1).cast(pl.Int32)
    return agents.with_columns(window=index)


def window_bounds(last_step: int, windows: int) -> np.ndarray:
    """Bounds of windows of equal length.

    Args:
        last_step: End of the last window [step]; raised to `windows` if it is smaller.
        windows: Number of windows.

    Returns:
        Bounds from 0 on [step], rounded, (windows + 1,) int64.
    """
    return np.linspace(0.0, max(last_step, windows), windows + 1).round().astype(np.int64)


def complete_share(cohort: pl.DataFrame) -> float:
    """Share of a cohort that has died, so that its lives and children are known in full; 1 for an empty cohort."""
    return 1.0 - cohort["death_step"].null_count() / cohort.height if cohort.height else 1.0


def genome_distribution(agents: pl.DataFrame, names: Sequence[str]) -> pl.DataFrame:
    """Distribution of each weight in each birth cohort.

    Returns:
        By window and weight: agents, mean, sd (null for a single agent), q05, q25, median, q75, q95.
    """
    unpivoted = agents.select("window", *names).unpivot(index="window", variable_name="weight")
    value = pl.col("value").cast(pl.Float64)
    spread = {"agents": pl.len(), "mean": value.mean(), "sd": value.std()}
    spread |= {name: value.quantile(q, "linear") for name, q in QUANTILES.items()}
    order = pl.Enum(list(names))
    return unpivoted.group_by("window", pl.col("weight").cast(order)).agg(**spread).sort("window", "weight")
