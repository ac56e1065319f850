"""Does `released` behave like the sequel's program? Compares its first windows with a run of that program.

The program (public repository, branch of the submission, 20 January 2026) was run with one seed of each world.
"""

from collections.abc import Iterator, Sequence

import polars as pl

from hedon.analysis import ResultTable, WorldRecord, make_table
from hedon.study import Condition, Item, ItemInputs, Scale, missing, present, sentences

WINDOW = 1024
"""Steps of a window."""
PREY = Condition("prey", "predator", fidelity="released", species="prey")
PREDATORS = Condition("predators", "predator", fidelity="released", species="predator")
PITFALL = Condition("pitfall", "pitfall", fidelity="released")

PREDATOR_RUN = {
    1: (304, 10, 163, 19, 292, 48.7),
    2: (450, 12, 177, 28, 320, 31.2),
    3: (450, 13, 24, 23, 410, 30.2),
    4: (450, 15, 18, 18, 420, 30.0),
    6: (450, 17, 16, 14, 430, 29.5),
}
"""By window: prey alive, predators alive, prey born, prey eaten, food present at the end, mean energy of prey."""
PITFALL_RUN = {
    1: (254, 164, 70, 495, 45.2),
    2: (336, 152, 70, 238, 29.0),
    4: (415, 84, 56, 144, 19.4),
    6: (425, 43, 51, 108, 16.6),
    8: (410, 30, 36, 79, 15.7),
    10: (379, 21, 43, 75, 15.4),
}
"""By window: alive, born, died, agent-steps in contact with a triangle, mean energy."""
PITFALL_COLUMNS = ("alive", "births", "deaths", "obstacles_touched", "energy_mean")
PREY_COLUMNS = ("births", "deaths_eaten", "food_normal", "energy_mean")
_READ = (
    "program: one seed of the sequel's program. low, high: least and largest of the worlds here. Numbers alive, foods "
    "and energy are those at a window's end; the others are counted in the window."
)


def window(world: WorldRecord, number: int) -> dict[str, float]:
    """The record of one window of a world.

    Args:
        world: The world.
        number: Number of the window.

    Returns:
        The row of that window by column; empty if the record does not reach it.
    """
    rows = world.population.filter(pl.col("step") == number * WINDOW)
    return rows.row(0, named=True) if len(rows) else {}


def _make(inputs: ItemInputs) -> Iterator[ResultTable]:
    worlds = present((PREY, PREDATORS, PITFALL), inputs)
    prey, predators = worlds.get(PREY.label, ()), worlds.get(PREDATORS.label, ())
    predator_quantities: list[tuple[str, Sequence[WorldRecord], str]] = [
        ("prey alive", prey, "alive"),
        ("predators alive", predators, "alive"),
        *((column, prey, column) for column in PREY_COLUMNS),
    ]
    pitfall_quantities = [(column, worlds.get(PITFALL.label, ()), column) for column in PITFALL_COLUMNS]
    note = sentences(_READ, missing((PREY, PREDATORS, PITFALL), inputs))
    for name, run, quantities in (
        ("predator", PREDATOR_RUN, predator_quantities),
        ("pitfall", PITFALL_RUN, pitfall_quantities),
    ):
        rows = [
            {"window": number, "quantity": quantity, "program": value, **_range(group, number, column)}
            for number, values in run.items()
            for (quantity, group, column), value in zip(quantities, values, strict=True)
        ]
        yield make_table(f"sequel_program_{name}", f"First windows of {name}, beside that program", rows, note)


def _range(worlds: Sequence[WorldRecord], number: int, column: str) -> dict[str, float | int | None]:
    values = [row[column] for world in worlds if (row := window(world, number))]
    return {"low": min(values, default=None), "high": max(values, default=None), "worlds": len(values)}


PROGRAM = Item(
    "sequel-program",
    "The first windows, beside the sequel's program",
    "What its program does in its first ten windows.",
    _make,
    (PREY, PREDATORS, PITFALL),
    Scale((1, 2, 3), 10 * WINDOW),
)
