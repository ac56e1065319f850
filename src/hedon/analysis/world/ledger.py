"""Is every unit of energy accounted for?"""

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

_INFLOW = ("energy_eaten", "energy_forgiven")
_OUTFLOW = ("energy_basic", "energy_action", "energy_capped", "energy_lost")


@dataclass(frozen=True)
class Ledger:
    """Sums over a run of one world [energy]; energy that parents share with children stays within the world.

    Attributes:
        initial: held by the founders at birth; None where their rows are missing, as in a branch.
        eaten, forgiven, basic, action, capped, lost, shared: as the columns of the table `population`.
        final: held by the living at the end.
        residual: largest difference over the intervals between the energy held and what the flows say it
            must be; only rounding where the ledger closes. None where there is nothing to compare.
    """

    initial: float | None
    eaten: float
    forgiven: float
    basic: float
    action: float
    capped: float
    lost: float
    shared: float
    final: float | None
    residual: float | None


def world_ledger(population: pl.DataFrame, agents: pl.DataFrame) -> Ledger:
    """The ledger of one world.

    held at the end = held before + eaten + forgiven − basic − action − capped − lost, in each interval.

    Args:
        population: rows of one world, by step.
        agents: rows of the same world.
    """
    initial = _initial(population, agents)
    sums = {name: float(population[f"energy_{name}"].sum()) for name in _names()}
    total = population["energy_total"].to_numpy()
    residuals = interval_residuals(population, agents)
    residuals = residuals[np.isfinite(residuals)]
    return Ledger(
        initial=initial,
        final=float(total[-1]) if len(total) else None,
        residual=float(residuals.max()) if len(residuals) else None,
        **sums,
    )


def interval_residuals(population: pl.DataFrame, agents: pl.DataFrame | None) -> NDArray[np.float64]:
    """By how much each interval of one world leaves its ledger open, (rows,) [energy]; see `world_ledger`.

    Args:
        population: rows of one world, by step.
        agents: rows of the same world; None where they are not known.

    Returns:
        NaN for the first interval where the energy held before it is not known.
    """
    initial = None if agents is None else _initial(population, agents)
    total = population["energy_total"].to_numpy()
    flow = sum(population[name].to_numpy() for name in _INFLOW) - sum(population[name].to_numpy() for name in _OUTFLOW)
    if "energy_hunted" in population.columns:
        flow = flow + population["energy_hunted"].to_numpy()
    if "energy_damage" in population.columns:
        flow = flow - population["energy_damage"].to_numpy()
    before = np.concatenate([[np.nan if initial is None else initial], total[:-1]])[: len(total)]
    return np.abs(total - before - flow)


def _initial(population: pl.DataFrame, agents: pl.DataFrame) -> float | None:
    """What the founders held at birth; None where their rows are missing."""
    founders = agents.filter(pl.col("parent_id").is_null())
    from_founders = founders.height and (population.height == 0 or population["step"][0] == population["steps"][0])
    return float(founders["birth_energy"].cast(pl.Float64).sum()) if from_founders else None


def _names() -> list[str]:
    return [name.removeprefix("energy_") for name in (*_INFLOW, *_OUTFLOW, "energy_shared")]
