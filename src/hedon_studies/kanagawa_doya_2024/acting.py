"""Study: does it matter that agents act by weights of 16 bits?

What would matter, as it was fixed before both arms were compared: a lifetime or a rate of food that differs by a tenth,
ten agents alive, or a weight that differs by 1, a twentieth of the range. An interval that lies within these bounds
says that it does not matter; one that reaches beyond leaves it open.
"""

from collections.abc import Iterator

from hedon.analysis.response import RESPONSES
from hedon.analysis.table import ResultTable, table
from hedon.analysis.world.population import history
from hedon.figure.course import draw_courses
from hedon.figure.named import NamedFigure
from hedon.study.census import present, sentences, stack, steps_reached, world_indices
from hedon.study.change import change, missing_note, read_change, world_rows
from hedon.study.item import Arm, Item, Material, Scale

FULL, HALF = "float32", "bfloat16"
ARMS = tuple(
    Arm(weights, overrides=(f'learning.acting_weights="{weights}"',), fidelity="corrected") for weights in (FULL, HALF)
)
SCALE = Scale(tuple(range(1, 11)), 512_000)
_PANELS = {
    "alive": "agents alive",
    "eaten_normal": "foods per 1000 steps lived",
    "deaths": "deaths per 1000 steps",
}

_DRAWN = (
    "Thin lines are worlds, the thick line is the mean over the worlds of an arm, and the band is its 95 % interval, "
    "from three worlds on. Where the bands overlap throughout, nothing is seen of the weights' precision."
)


def make_acting(material: Material) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    missing = missing_note(material, ARMS, SCALE)
    worlds = present(ARMS, material)
    rows = world_rows(material, ARMS, RESPONSES)
    if worlds:
        indices, end = world_indices(worlds.values()), max(steps_reached(found) for found in worlds.values())
        courses = {
            label: history(stack(found, "population", indices), ("normal",), points=50, end=end)
            for label, found in worlds.items()
        }
        question = "Do worlds fare alike, whichever weights their agents act by?"
        yield NamedFigure("acting_courses", question, draw_courses(courses, _PANELS), _DRAWN)
    yield table(
        "acting",
        "Acting by weights of 32 and of 16 bits",
        [row for response in RESPONSES for row in change(rows, response, FULL, HALF)],
        sentences(read_change(FULL, HALF), missing),
    )
    yield table("acting_worlds", "The worlds of the study of acting", rows, missing, shown=False)


ACTING: tuple[Item, ...] = (
    Item(
        "acting",
        "Acting by weights of 16 bits",
        "study",
        "Agents act by weights that are rounded to 16 bits, for speed. Do they live, eat and breed as those that act "
        "by weights of 32 bits?",
        make_acting,
        ARMS,
        SCALE,
    ),
)
