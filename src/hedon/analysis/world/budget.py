"""Energy budgets: where energy comes from and where it goes."""

import polars as pl

from hedon.analysis.world.species import require_one_species

_FLOWS = ("eaten", "basic", "action", "forgiven", "capped", "lost", "shared", "hunted", "damage")


def energy_budget(population: pl.DataFrame) -> dict[str, float] | None:
    """Energy budget over the given intervals, per 1000 agent steps.

    Returns:
        eaten, gained from food, with poison as negative; basic and action, charged for living and for action; forgiven,
        charged but not paid, because energy cannot fall below 0; capped, eaten but lost at the capacity for energy;
        lost, held by agents that died; shared, given by parents to children, which stays within the world; hunted,
        gained by eating agents, if any do; damage, charged for touching obstacles, if there are any; forgiven_share,
        the share of the charges that could not be paid: how hungry the world is. None if no steps were lived or nothing
        was charged.

    Raises:
        ArgumentError: The rows are of several species.
    """
    require_one_species(population)
    agent_steps = int(population["agent_steps"].sum())
    recorded_flows = [name for name in _FLOWS if f"energy_{name}" in population.columns]
    sums = {name: float(population[f"energy_{name}"].sum()) for name in recorded_flows}
    charges = sums["basic"] + sums["action"] + sums.get("damage", 0.0)
    if not agent_steps or not charges:
        return None
    flows = {name: 1000.0 * value / agent_steps for name, value in sums.items()}
    return flows | {"forgiven_share": sums["forgiven"] / charges}
