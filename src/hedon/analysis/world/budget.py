"""Where does energy come from, and where does it go?"""

import polars as pl

from hedon.analysis.world.species import require_one_species

_FLOWS = ("eaten", "basic", "action", "forgiven", "capped", "lost", "shared", "hunted", "damage")


def energy_budget(population: pl.DataFrame) -> dict[str, float] | None:
    """The budget over the given intervals, per 1000 steps lived by an agent.

    Returns:
        eaten, taken up with food, where poison counts negative; basic and action, charged for living and for action;
        forgiven, charged but not paid, because energy cannot fall below 0; capped, eaten but destroyed at the capacity
        for energy; lost, held by those who died; shared, given by parents to children, which stays within the world;
        hunted, gained by eating agents, where some do; damage, charged for touching obstacles, where there are any;
        forgiven_share, of what was charged, the share that could not be paid: how hungry the world is. None where
        nobody lived or nothing was charged.

    Raises:
        ArgumentError: the rows are of several species.
    """
    require_one_species(population)
    lived = int(population["agent_steps"].sum())
    there = [name for name in _FLOWS if f"energy_{name}" in population.columns]
    sums = {name: float(population[f"energy_{name}"].sum()) for name in there}
    charged = sums["basic"] + sums["action"] + sums.get("damage", 0.0)
    if not lived or not charged:
        return None
    flows = {name: 1000.0 * value / lived for name, value in sums.items()}
    return flows | {"forgiven_share": sums["forgiven"] / charged}
