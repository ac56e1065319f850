"""How much agents eat, by two rules of averaging that give different answers.

The paper's rule, as we read it, is a mean over agents of foods per step of life, so a short life counts as much as a
long one. The other is total foods over total steps lived: what a living agent eats per step.
"""

from collections.abc import Sequence

import polars as pl

from hedon.analysis.agent.lifetime import dead_agents
from hedon.analysis.world.species import require_one_species


def food_per_step(agents: pl.DataFrame, food_kinds: Sequence[str], *, last: int | None = None) -> float | None:
    """Mean over dead agents of foods eaten / lifetime [1/step]: the paper's rule.

    Args:
        agents: Table `agents`.
        food_kinds: Kinds (or species that are eaten) to count; poison counts too if it is listed.
        last: Number of agents to average over, those that died last; None for all.

    Returns:
        None if no agent died or no kind is listed, as for a species that eats no food. Lives of 0 steps are excluded.
    """
    if not food_kinds:
        return None
    dead = dead_agents(agents, last=last).filter(pl.col("lifetime") > 0)
    values = dead.select(_eaten(food_kinds) / pl.col("lifetime")).to_series().to_numpy()
    return float(values.mean()) if len(values) else None


def food_per_agent_step(population: pl.DataFrame, food_kinds: Sequence[str]) -> float | None:
    """Total foods eaten / total steps lived by all agents [1/step]; None if no steps were lived or no kind is listed.

    Args:
        population: Table `population` of one species.
        food_kinds: Kinds to count; poison counts too if it is listed.
    """
    require_one_species(population)
    if not food_kinds:
        return None
    steps = population["agent_steps"].sum()
    return population.select(_eaten(food_kinds).sum()).item() / steps if steps else None


def _eaten(food_kinds: Sequence[str]) -> pl.Expr:
    return pl.sum_horizontal(pl.lit(0, pl.Int64), *(pl.col(f"eaten_{k}").cast(pl.Int64) for k in food_kinds))
