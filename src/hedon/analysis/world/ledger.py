"""Energy ledgers: checks that every unit of energy is accounted for.

Each species of a world has its own ledger, which balances by itself: energy gained by eating agents, of another species
or its own, enters as `hunted`, and energy lost to agents that eat it is part of `lost`.
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
"""All flows of energy into or out of a species, with their signs, named as in the columns `energy_…` of the table
`population`. The columns `hunted` and `damage` exist only if agents eat agents, and if there are obstacles."""


def world_ledger(population: pl.DataFrame, agents: pl.DataFrame) -> dict[str, float | None]:
    """Ledger of one species of one world.

    held at the end = held before + eaten + hunted + forgiven − basic − action − damage − capped − lost, in each
    interval.

    Returns:
        Sums over the run [energy]: initial, held by the founders at birth, None if their rows are missing, as in a
        branch; each flow that the world has, by the name of its column without `energy_`; shared, given by parents to
        children, which stays within the species; final, held by the agents alive at the end; residual, the largest
        difference over the intervals between the energy held and the energy that the flows imply: only rounding if the
        ledger balances, and None if there is nothing to compare.
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
    """Imbalance of one species' ledger in each interval, (rows,) [energy]; see `world_ledger`.

    Returns:
        NaN for the first interval if the energy held before it is unknown.

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(population)
    initial = None if agents is None else _initial(population, agents)
    total = population["energy_total"].to_numpy()
    flow = sum(_SIGNS[name.removeprefix("energy_")] * population[name].to_numpy() for name in flow_names(population))
    previous_total = np.concatenate([[np.nan if initial is None else initial], total[:-1]])[: len(total)]
    return np.abs(total - previous_total - flow)


def flow_names(population: pl.DataFrame) -> list[str]:
    """Columns of a table `population` with flows of energy into or out of a species."""
    return [f"energy_{name}" for name in _SIGNS if f"energy_{name}" in population.columns]


def _initial(population: pl.DataFrame, agents: pl.DataFrame) -> float | None:
    """Energy of the founders at birth, 0 if no agent ever lived; None if their rows are missing."""
    founders = agents.filter(pl.col("parent_id").is_null())
    is_from_start = population.height == 0 or population["step"][0] == population["steps"][0]
    never_lived = population.height > 0 and not population["agent_steps"].sum()
    is_known = is_from_start and (founders.height > 0 or never_lived)
    return float(founders["birth_energy"].cast(pl.Float64).sum()) if is_known else None
