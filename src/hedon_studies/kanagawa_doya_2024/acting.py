"""Study: does it matter that agents act with 16-bit weights?

We fixed what would matter before the two conditions were compared: a difference of a tenth in lifetime or rate of food,
of ten agents alive, or of 1 in a weight, which is a twentieth of its range. If an interval is within these bounds, the
16-bit weights do not matter; if it extends beyond, the question is open.
"""

from collections.abc import Iterator

import hedon.figure
from hedon.analysis import ResultTable, history, make_table
from hedon.figure import NamedFigure
from hedon.measure import RESPONSES
from hedon.study import (
    Condition,
    Item,
    ItemInputs,
    Scale,
    change,
    missing_note,
    present,
    read_change,
    sentences,
    stack,
    steps_reached,
    world_indices,
    world_rows,
)

FULL, HALF = "float32", "bfloat16"
CONDITIONS = tuple(
    Condition(weights, overrides=(f'learning.acting_weights="{weights}"',), fidelity="corrected")
    for weights in (FULL, HALF)
)
SCALE = Scale(tuple(range(1, 11)), 512_000)
_PANELS = {
    "alive": "agents alive",
    "eaten_normal": "foods per 1000 steps lived",
    "deaths": "deaths per 1000 steps",
}

_DRAWN = (
    "Thin lines are worlds, the thick line is the mean over the worlds of a condition, and the band is its 95 % "
    "interval, from five worlds on. Where the bands overlap throughout, nothing is seen of the weights' precision."
)


def make_acting(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    missing = missing_note(inputs, CONDITIONS, SCALE)
    worlds = present(CONDITIONS, inputs)
    rows = world_rows(inputs, CONDITIONS, RESPONSES)
    if worlds:
        indices, end = world_indices(worlds.values()), max(steps_reached(group) for group in worlds.values())
        courses = {
            label: history(stack(group, "population", indices), ("normal",), points=50, end=end)
            for label, group in worlds.items()
        }
        question = "Do worlds fare alike, whichever weights their agents act by?"
        yield NamedFigure("acting_courses", question, hedon.figure.draw_courses(courses, _PANELS), _DRAWN)
    yield make_table(
        "acting",
        "Acting by weights of 32 and of 16 bits",
        [row for measure in RESPONSES for row in change(rows, measure, FULL, HALF)],
        sentences(read_change(FULL, HALF), missing),
    )
    yield make_table("acting_worlds", "The worlds of the study of acting", rows, missing, shown=False)


ACTING = Item(
    "acting",
    "Acting by weights of 16 bits",
    "Agents act by weights that are rounded to 16 bits, for speed. Do they live, eat and breed as those that act "
    "by weights of 32 bits?",
    make_acting,
    CONDITIONS,
    SCALE,
)
