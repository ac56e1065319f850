"""Is every unit of energy accounted for?

Each species of a world has a ledger of its own, which closes by itself: what it gains by eating agents, of another
species or its own, enters as `hunted`, and what it loses to those that eat it is part of `lost`.
"""

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.world.species import require_one_species

_SIGNS = {
    "eaten": 1.0,
    "hunted": 1.0,
    "forgiven": 1.0,
    "basic": -1.0,
    "action": -1.0,
    "damage": -1.0,
    "capped": -1.0,
    "lost": -1.0,
}
"""Every flow of energy into or out of a species, as in the columns `energy_…` of the table `population`. A world has
the columns `hunted` and `damage` only where agents eat agents, and where there are obstacles."""


def world_ledger(population: pl.DataFrame, agents: pl.DataFrame) -> dict[str, float | None]:
    """The ledger of one species of one world.

    held at the end = held before + eaten + hunted + forgiven − basic − action − damage − capped − lost, in each
    interval.

    Returns:
        Sums over the run [energy]: initial, held by the founders at birth, None where their rows are missing, as in a
        branch; each flow that the world has, by the name of its column without `energy_`; shared, given by parents to
        children, which stays within it; final, held by the living at the end; residual, the largest difference over the
        intervals between the energy held and what the flows say it must be: only rounding where the ledger closes, and
        None where there is nothing to compare.
    """
    total = population["energy_total"].to_numpy()
    residuals = interval_residuals(population, agents)
    residuals = residuals[np.isfinite(residuals)]
    names = (*flow_names(population), "energy_shared")
    return {
        "initial": _initial(population, agents),
        **{name.removeprefix("energy_"): float(population[name].sum()) for name in names},
        "final": float(total[-1]) if len(total) else None,
        "residual": float(residuals.max()) if len(residuals) else None,
    }


def interval_residuals(population: pl.DataFrame, agents: pl.DataFrame | None) -> NDArray[np.float64]:
    """By how much each interval of one species leaves its ledger open, (rows,) [energy]; see `world_ledger`.

    Returns:
        NaN for the first interval where the energy held before it is not known.

    Raises:
        ArgumentError: the rows are of several species.
    """
    require_one_species(population)
    initial = None if agents is None else _initial(population, agents)
    total = population["energy_total"].to_numpy()
    flow = sum(_SIGNS[name.removeprefix("energy_")] * population[name].to_numpy() for name in flow_names(population))
    before = np.concatenate([[np.nan if initial is None else initial], total[:-1]])[: len(total)]
    return np.abs(total - before - flow)


def flow_names(population: pl.DataFrame) -> list[str]:
    """The columns of all flows of energy into or out of a species that a table `population` has."""
    return [f"energy_{name}" for name in _SIGNS if f"energy_{name}" in population.columns]


def _initial(population: pl.DataFrame, agents: pl.DataFrame) -> float | None:
    """What the founders held at birth, 0 where nobody ever lived; None where their rows are missing."""
    founders = agents.filter(pl.col("parent_id").is_null())
    begins = population.height == 0 or population["step"][0] == population["steps"][0]
    nobody = population.height > 0 and not population["agent_steps"].sum()
    known = begins and (founders.height > 0 or nobody)
    return float(founders["birth_energy"].cast(pl.Float64).sum()) if known else None
