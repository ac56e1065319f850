"""The paper's figures of how rewards evolve: mean weights over time in each world, compared with neutral genes."""

from collections.abc import Iterator, Sequence
from functools import partial

import hedon.figure
from hedon.analysis import drift_bands
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, describe, missing, present, sentences, stack, world_indices
from hedon_studies.kanagawa_doya_2024.condition import BASELINE, PAPER_SCALE, POISON, POOR, SIZES

_READ = (
    "Thin: one world; thick: the mean over the worlds that live, with its 95 % interval from five worlds on; a cross "
    "ends the line of a world that died out. Gray: where drift alone would have the weight in 95 % of worlds: neutral "
    "genes with its own founders and mutations, walked down the same pedigrees."
)


def draw_courses(
    name: str, question: str, conditions: Sequence[Condition], inputs: ItemInputs
) -> Iterator[NamedFigure]:
    """Draws the mean weights of worlds over time, with a row per condition.

    Args:
        name: Name of the figure.
        question: The question that it answers.
        conditions: The conditions, which must have the same genes.
        inputs: Data with the worlds.
    """
    worlds = present(conditions, inputs)
    caption = sentences(_READ, missing(conditions, inputs))
    if not worlds:
        yield NamedFigure(name, question, hedon.figure.draw_message("no worlds yet"), caption)
        return
    indices = world_indices(worlds.values())
    rows = [
        hedon.figure.HistoryRow(
            stack(group, "population", indices),
            label,
            ", ".join(describe(group)),
            {indices[world.seed] for world in group if world.extinct_step is not None},
            drift_bands(group),
        )
        for label, group in worlds.items()
    ]
    first_world = next(iter(worlds.values()))[0]
    colors = hedon.figure.meal_colors(first_world.config, first_world.prey)
    figure = hedon.figure.draw_histories(rows, first_world.reward_names, first_world.neutral_names, colors)
    yield NamedFigure(name, question, figure, caption)


def _item(name: str, title: str, paper: str, question: str, *conditions: Condition) -> Item:
    return Item(name, title, paper, partial(draw_courses, name, question, conditions), conditions, PAPER_SCALE)


HISTORIES: tuple[Item, ...] = (
    _item(
        "history-baseline",
        "How weights evolve in the baseline",
        "Mean weights of each seed and over seeds. By its text the weight of food ends positive, that of action "
        "largely positive or slightly negative.",
        "When do rewards evolve in the baseline?",
        BASELINE,
    ),
    _item(
        "history-sizes",
        "How weights evolve in arenas of three sizes",
        "The same for three sizes. By its text the weight of food ends positive in the baseline and the large arena, "
        "and hardly any weight evolves in the small one.",
        "Does the size of the arena change how rewards evolve?",
        *SIZES,
    ),
    _item(
        "history-poor",
        "How weights evolve with poor food",
        "The same with poor food. By its text the weight of normal food stays positive, that of poor food varies "
        "widely.",
        "When does food that gives little become rewarding?",
        POOR,
    ),
    _item(
        "history-poison",
        "How weights evolve with poison",
        "The same with poison. By its text the weight of normal food stays positive, that of poison varies widely.",
        "When does food that harms become aversive?",
        POISON,
    ),
)
