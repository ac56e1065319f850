"""Where does energy come from, and where does it go?"""

from dataclasses import dataclass

import polars as pl


@dataclass(frozen=True)
class Budget:
    """Flows of energy in some intervals of one world, per 1000 steps lived by an agent.

    Attributes:
        eaten: taken up with food; poison counts negative.
        basic, action: charged for living and for action.
        forgiven: charged but not paid, because energy cannot fall below 0.
        capped: eaten but destroyed at the capacity for energy.
        lost: held by those who died.
        shared: given by parents to children; it stays within the world.
        forgiven_share: of what was charged, the share that could not be paid: how hungry the world is.
    """

    eaten: float
    basic: float
    action: float
    forgiven: float
    capped: float
    lost: float
    shared: float
    forgiven_share: float


_FLOWS = ("eaten", "basic", "action", "forgiven", "capped", "lost", "shared")


def energy_budget(population: pl.DataFrame) -> Budget | None:
    """The budget over the given intervals; None where nobody lived or nothing was charged.

    Args:
        population: rows of the table `population` of one world.
    """
    lived = int(population["agent_steps"].sum())
    sums = {name: float(population[f"energy_{name}"].sum()) for name in _FLOWS}
    charged = sums["basic"] + sums["action"]
    if not lived or not charged:
        return None
    return Budget(
        **{name: 1000.0 * value / lived for name, value in sums.items()}, forgiven_share=sums["forgiven"] / charged
    )
