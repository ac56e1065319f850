"""Where does energy come from, and where does it go?"""

from dataclasses import dataclass

import polars as pl

from hedon.analysis.world.species import require_one_species


@dataclass(frozen=True)
class Budget:
    """Flows of energy in some intervals of one species of a world, per 1000 steps lived by an agent.

    Attributes:
        eaten: taken up with food; poison counts negative.
        basic, action: charged for living and for action.
        forgiven: charged but not paid, because energy cannot fall below 0.
        capped: eaten but destroyed at the capacity for energy.
        lost: held by those who died.
        shared: given by parents to children; it stays within the world.
        forgiven_share: of what was charged, the share that could not be paid: how hungry the world is.
        hunted: gained by eating agents; None in worlds where nobody does.
        damage: charged for touching obstacles; None in worlds without any.
    """

    eaten: float
    basic: float
    action: float
    forgiven: float
    capped: float
    lost: float
    shared: float
    forgiven_share: float
    hunted: float | None = None
    damage: float | None = None


_FLOWS = ("eaten", "basic", "action", "forgiven", "capped", "lost", "shared", "hunted", "damage")


def energy_budget(population: pl.DataFrame) -> Budget | None:
    """The budget over the given intervals; None where nobody lived or nothing was charged.

    Args:
        population: rows of the table `population` of one species of one world.

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
    return Budget(
        **{name: 1000.0 * value / lived for name, value in sums.items()}, forgiven_share=sums["forgiven"] / charged
    )
