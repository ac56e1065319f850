"""Which rewards evolved? The neutral markers tell how much of it is drift."""

from collections.abc import Sequence

import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.analysis.world.species import require_one_species

LAST_AGENTS = 5000  # whose weights the paper shows

Spread = dict[str, float | None]
"""Mean and standard deviation of a weight among some agents."""


def last_agents(agents: pl.DataFrame, count: int = LAST_AGENTS) -> pl.DataFrame:
    """The agents of each world that were born last, dead or alive, by world and birth.

    Args:
        agents: table `agents`.
        count: per world; all where there are fewer.

    Raises:
        ArgumentError: the rows are of several species.
    """
    require_one_species(agents)
    return agents.sort("world", "birth_step", "agent_id").group_by("world", maintain_order=True).tail(count)


def last_mean(weight: str, world: WorldRecord) -> float | None:
    """Mean of a weight over the 5000 agents of a world that were born last; None without agents.

    Args:
        weight: a genome column.
        world: a world with its agents.
    """
    values = last_agents(world.agents)[weight].to_numpy()
    return float(values.mean(dtype=float)) if len(values) else None


def world_weights(agents: pl.DataFrame, names: Sequence[str], count: int = LAST_AGENTS) -> dict[int, dict[str, Spread]]:
    """Weights of the agents born last, per world.

    Args:
        agents: table `agents`.
        names: genome columns.
        count: agents per world.

    Returns:
        By world and name: mean, None where there are no agents, and sd, None where there are fewer than two. A world
        without agents is missing.
    """
    groups = last_agents(agents, count).partition_by("world", as_dict=True)
    return {int(world): {name: _spread(group[name]) for name in names} for (world,), group in groups.items()}


def _spread(values: pl.Series) -> Spread:
    known = values.drop_nulls().cast(pl.Float64).to_numpy()
    sd = float(known.std(ddof=1)) if len(known) > 1 else None
    return {"mean": float(known.mean()) if len(known) else None, "sd": sd}
