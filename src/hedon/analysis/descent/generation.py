"""How long is a generation?"""

from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import genealogy


def generation_time(agents: pl.DataFrame, last_step: int) -> dict[str, Any]:
    """Both measures of a generation.

    Args:
        agents: table `agents` of one world, by agent_id.
        last_step: up to which the records reach [step].

    Returns:
        births, with a recorded parent; parent_age, the mean age of parents at the birth of a child [step]: the
        generation time as demography has it, with its standard deviation parent_age_sd; reached, the mean generation of
        the living at the end, or of those born last where nobody lives; line_time, steps of the run per generation
        reached [step]: the generation time along the lines that last, shorter than parent_age where they are those that
        breed early. None for what has no value.
    """
    tree = genealogy(agents)
    children = np.flatnonzero(tree.parent >= 0)
    ages = (tree.birth[children] - tree.birth[tree.parent[children]]).astype(np.float64)
    living = agents.filter(pl.col("death_step").is_null())
    newest = living if living.height else agents.filter(pl.col("birth_step") == pl.col("birth_step").max())
    reached = float(newest["generation"].to_numpy().mean()) if newest.height else None
    return {
        "births": len(ages),
        "parent_age": float(ages.mean()) if len(ages) else None,
        "parent_age_sd": float(ages.std(ddof=1)) if len(ages) > 1 else None,
        "reached": reached,
        "line_time": last_step / reached if reached else None,
    }
