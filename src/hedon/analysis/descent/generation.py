"""Two measures of the generation time."""

from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import genealogy


def generation_time(agents: pl.DataFrame, last_step: int) -> dict[str, Any]:
    """Computes both measures of the generation time.

    Args:
        agents: Table `agents` of one world, by agent_id.
        last_step: End of the records [step].

    Returns:
        births, with a recorded parent; parent_age, the mean age of parents at the birth of a child [step], both parents
        if there are two: the generation time of demography, with its standard deviation parent_age_sd; reached, the
        mean generation of the agents alive at the end, or of those born last if none is; line_time, steps of the run
        per generation reached [step]: the generation time along surviving lines, shorter than parent_age if these are
        the lines that breed early. None for undefined values.
    """
    ages = _parent_ages(agents)
    living = agents.filter(pl.col("death_step").is_null())
    newest = living if living.height else agents.filter(pl.col("birth_step") == pl.col("birth_step").max())
    mean_generation = float(newest["generation"].to_numpy().mean()) if newest.height else None
    return {
        "births": int((genealogy(agents).parent >= 0).sum()),
        "parent_age": float(ages.mean()) if len(ages) else None,
        "parent_age_sd": float(ages.std(ddof=1)) if len(ages) > 1 else None,
        "reached": mean_generation,
        "line_time": last_step / mean_generation if mean_generation else None,
    }


def _parent_ages(agents: pl.DataFrame) -> NDArray[np.float64]:
    """Ages of the recorded parents at each birth, first parents before second ones [step]."""
    trees = [genealogy(agents)]
    if "mate_id" in agents.columns:
        trees.append(genealogy(agents.with_columns(parent_id="mate_id")))
    ages = [(tree.birth - tree.birth[tree.parent])[tree.parent >= 0] for tree in trees]
    return np.concatenate(ages).astype(np.float64)
