"""How long do agents live?

Only the dead have a lifetime. Those who still live when a run ends tend to be the long-lived, so a mean over the dead
is too small where lives are not short against the run: look at the number alive, or estimate survival instead.
"""

import numpy as np
import polars as pl
from numpy.typing import NDArray


def dead_agents(agents: pl.DataFrame, *, last: int | None = None, born_in_run: bool = False) -> pl.DataFrame:
    """The agents with a whole life in the record, by death_step, with the column `lifetime` [step].

    Args:
        agents: table `agents`.
        last: at most this many of them, those who died last.
        born_in_run: without the founders, whose energy and genome come from the config.
    """
    dead = agents.filter(pl.col("death_step").is_not_null())
    if born_in_run:
        dead = dead.filter(pl.col("parent_id").is_not_null())
    dead = dead.with_columns(lifetime=pl.col("death_step") - pl.col("birth_step"))
    dead = dead.sort("death_step", "world", "agent_id")
    return dead if last is None else dead.tail(last)


def mean_lifetime(agents: pl.DataFrame, *, last: int | None = None, born_in_run: bool = False) -> float | None:
    """Mean lifetime of the dead [step], unweighted over agents, as we read the paper's; None where nobody died.

    Args:
        agents: table `agents`.
        last: only over those who died last.
        born_in_run: without the founders.
    """
    values = dead_agents(agents, last=last, born_in_run=born_in_run)["lifetime"].to_numpy()
    return float(values.mean()) if len(values) else None


def durations(agents: pl.DataFrame, last_step: int) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """How long each agent is known to have lived, and whether it died.

    Args:
        agents: table `agents` of one world.
        last_step: up to which the records reach [step].

    Returns:
        Lifetimes or ages so far [step] and whether the agent died, each (n,).
    """
    died = agents["death_step"].is_not_null().to_numpy()
    end = agents["death_step"].fill_null(last_step).to_numpy()
    return (end - agents["birth_step"].to_numpy()).astype(np.float64), died
