"""How long is a generation?"""

from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import genealogy


@dataclass(frozen=True)
class GenerationTime:
    """Generations of one world.

    Attributes:
        births: with a recorded parent.
        parent_age: mean age of the parents at the birth of a child [step]: the generation time as demography
            has it; None without births, as the next.
        parent_age_sd: standard deviation of the same [step].
        reached: mean generation of the living at the end, or of those born last where nobody lives.
        line_time: steps of the run per generation reached [step]: the generation time along the lines that
            last. Shorter than `parent_age` where they are those that breed early; None where none is reached.
    """

    births: int
    parent_age: float | None
    parent_age_sd: float | None
    reached: float | None
    line_time: float | None


def generation_time(agents: pl.DataFrame, last_step: int) -> GenerationTime:
    """Both measures of a generation.

    Args:
        agents: table `agents` of one world, by agent_id.
        last_step: up to which the records reach [step].
    """
    tree = genealogy(agents)
    children = np.flatnonzero(tree.parent >= 0)
    ages = (tree.birth[children] - tree.birth[tree.parent[children]]).astype(np.float64)
    living = agents.filter(pl.col("death_step").is_null())
    newest = living if living.height else agents.filter(pl.col("birth_step") == pl.col("birth_step").max())
    reached = float(newest["generation"].to_numpy().mean()) if newest.height else None
    return GenerationTime(
        births=len(ages),
        parent_age=float(ages.mean()) if len(ages) else None,
        parent_age_sd=float(ages.std(ddof=1)) if len(ages) > 1 else None,
        reached=reached,
        line_time=last_step / reached if reached else None,
    )
