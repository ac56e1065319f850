"""Study: does it matter that agents act by weights of 16 bits?"""

from collections.abc import Iterator

import polars as pl

from hedon.analysis.condition_figure import NamedFigure
from hedon.analysis.figure_course import draw_courses
from hedon.analysis.item.census import present, sentences
from hedon.analysis.item.item import Arm, Item, Material, Scale
from hedon.analysis.item.study import change, missing_note, read_change, world_rows
from hedon.analysis.population import history
from hedon.analysis.response import RESPONSES
from hedon.analysis.topic.result import ResultTable, table

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


def make_acting(material: Material) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    missing = missing_note(material, ARMS, SCALE)
    worlds = present(ARMS, material)
    rows = world_rows(material, ARMS, RESPONSES)
    if worlds:
        tables = {
            label: pl.concat(w.population.with_columns(world=pl.lit(i, pl.Int32)) for i, w in enumerate(found))
            for label, found in worlds.items()
        }
        courses = {label: history(population, ("normal",), points=50) for label, population in tables.items()}
        question = "Do worlds fare alike, whichever weights their agents act by?"
        yield NamedFigure("acting_courses", question, draw_courses(courses, _PANELS))
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
