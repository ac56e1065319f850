"""How long agents live.

Only dead agents have a lifetime. Agents still alive at the end of a run tend to be long-lived, so a mean over the dead
is too small unless lives are short compared with the run: use the number alive, or estimate survival instead.
"""

import numpy as np
import polars as pl
from numpy.typing import NDArray


def dead_agents(agents: pl.DataFrame, *, last: int | None = None, born_in_run: bool = False) -> pl.DataFrame:
    """Agents with a complete life in the records, by death_step, with the column `lifetime` [step].

    Args:
        agents: Table `agents`.
        last: Maximum number of agents, those that died last; None for all.
        born_in_run: Exclude the founders, whose energy and genome come from the config.
    """
    dead = agents.filter(pl.col("death_step").is_not_null())
    if born_in_run:
        dead = dead.filter(pl.col("parent_id").is_not_null())
    dead = dead.with_columns(lifetime=pl.col("death_step") - pl.col("birth_step"))
    dead = dead.sort("death_step", "world", "agent_id")
    return dead if last is None else dead.tail(last)


def mean_lifetime(agents: pl.DataFrame, *, last: int | None = None, born_in_run: bool = False) -> float | None:
    """Mean lifetime of dead agents [step], unweighted over agents, as we read the paper's; None if no agent died.

    Args:
        agents: Table `agents`.
        last: Number of agents to average over, those that died last; None for all.
        born_in_run: Exclude the founders.
    """
    values = dead_agents(agents, last=last, born_in_run=born_in_run)["lifetime"].to_numpy()
    return float(values.mean()) if len(values) else None


def durations(agents: pl.DataFrame, last_step: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Known duration of each agent's life, and whether the agent died.

    Args:
        agents: Table `agents` of one world.
        last_step: End of the records [step].

    Returns:
        Lifetimes or ages so far [step] and whether the agent died, each (n,).
    """
    died = agents["death_step"].is_not_null().to_numpy()
    end = agents["death_step"].fill_null(last_step).to_numpy()
    return (end - agents["birth_step"].to_numpy()).astype(np.float64), died
