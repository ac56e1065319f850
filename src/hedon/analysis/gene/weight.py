"""Evolved rewards: mean weights of the agents alive at the end, and of the 5000 agents born last, as in the paper."""

from collections.abc import Sequence

import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.analysis.world.species import require_one_species

LAST_AGENTS = 5000
"""Agents per world whose weights the paper shows: those born last, dead or alive."""

Spread = dict[str, float | None]
"""Mean and standard deviation of a weight among some agents."""


def last_lived_step(population: pl.DataFrame) -> int:
    """Last recorded step of one world at which an agent was alive, by the rows of its population [step].

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(population)
    return int(population.filter(pl.col("alive") > 0)["step"].to_numpy().max(initial=0))


def last_living(agents: pl.DataFrame, population: pl.DataFrame) -> pl.DataFrame:
    """The agents of one world whose weights show what evolved: those alive at the end of its records.

    In an extinct world, these are the agents of the last row of its population with any alive, where a curve of the
    living ends.

    Args:
        agents: Rows of the table `agents` of one world and species.
        population: Rows of its table `population`.

    Returns:
        The rows of these agents, in the order of `agents`.

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(agents)
    end = last_lived_step(population)
    is_living = pl.col("death_step").is_null() | (pl.col("death_step") > end)
    return agents.filter((pl.col("birth_step") <= end) & is_living)


def weight_spreads(agents: pl.DataFrame, names: Sequence[str]) -> dict[str, Spread]:
    """Mean and spread of weights among some agents.

    Returns:
        By name: mean, None without agents, and sd, None with fewer than two.
    """
    return {name: _spread(agents[name]) for name in names}


def end_mean(weight: str, world: WorldRecord) -> float | None:
    """Mean of a weight over `last_living`; None without agents.

    Args:
        weight: Genome column.
        world: A world with its agents.
    """
    return _spread(last_living(world.agents, world.population)[weight])["mean"]


def last_agents(agents: pl.DataFrame, count: int = LAST_AGENTS) -> pl.DataFrame:
    """Agents of each world that were born last, dead or alive, by world and birth: the paper's measure.

    In a short world these are all agents that ever lived, including its founders; see `last_living`.

    Args:
        agents: Table `agents`.
        count: Number of agents per world; all if there are fewer.

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(agents)
    return agents.sort("world", "birth_step", "agent_id").group_by("world", maintain_order=True).tail(count)


def last_mean(weight: str, world: WorldRecord) -> float | None:
    """Mean of a weight over the 5000 agents of a world that were born last; None without agents.

    Args:
        weight: Genome column.
        world: A world with its agents.
    """
    return _spread(last_agents(world.agents)[weight])["mean"]


def _spread(values: pl.Series) -> Spread:
    recorded = values.drop_nulls().cast(pl.Float64).to_numpy()
    sd = float(recorded.std(ddof=1)) if len(recorded) > 1 else None
    return {"mean": float(recorded.mean()) if len(recorded) else None, "sd": sd}
