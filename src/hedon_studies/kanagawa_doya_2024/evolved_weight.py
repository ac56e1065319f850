"""The paper's figures of evolved rewards: the weights of the agents born last in each world."""

from collections.abc import Iterator, Sequence
from functools import partial

import hedon.figure
from hedon.analysis import LAST_AGENTS, drift_genes, last_agents
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, describe, missing, present, sentences, stack, world_indices
from hedon_studies.kanagawa_doya_2024.condition import BASELINE, PAPER_SCALE, PLACES, POISON, POOR, SIZES

_READ = (
    f"A point is one of the {LAST_AGENTS} agents of a world that were born last; outlined, how their weights would be "
    "distributed by drift alone. Worlds that died out are shown; the paper replaced them."
)


def draw_last(
    name: str, question: str, conditions: Sequence[Condition], panels: Sequence[tuple[str, str]], inputs: ItemInputs
) -> Iterator[NamedFigure]:
    """Draws the weights of the agents born last in the worlds of some conditions, side by side.

    Args:
        name: Name of the figure.
        question: The question that it answers.
        conditions: The conditions.
        panels: Genome columns along the axes of each panel; food against action if empty.
        inputs: Data with the worlds.
    """
    panels = panels or hedon.figure.against_action(("w_normal",))
    worlds = present(conditions, inputs)
    caption = sentences(_READ, missing(conditions, inputs))
    if not worlds:
        yield NamedFigure(name, question, hedon.figure.draw_message("no worlds yet"), caption)
        return
    indices = world_indices(worlds.values())
    groups = [
        hedon.figure.WeightGroup(
            last_agents(stack(group, "agents", indices)),
            panels,
            label,
            "\n".join(describe(group)),
            drift_genes(group, [last_agents(world.agents) for world in group]),
        )
        for label, group in worlds.items()
    ]
    yield NamedFigure(name, question, hedon.figure.draw_weight_groups(groups), caption)


def _item(
    name: str,
    title: str,
    paper: str,
    question: str,
    *conditions: Condition,
    panels: Sequence[tuple[str, str]] = (),
) -> Item:
    return Item(name, title, paper, partial(draw_last, name, question, conditions, panels), conditions, PAPER_SCALE)


WEIGHTS: tuple[Item, ...] = (
    _item(
        "weights-baseline",
        "Weights that evolve in the baseline",
        "Food becomes rewarding, mostly with a weight above 4. The weight of action ends in one of two ways: largely "
        "positive, or slightly negative.",
        "Which rewards evolve in the baseline?",
        BASELINE,
    ),
    _item(
        "weights-sizes",
        "Weights that evolve in arenas of three sizes",
        "In the baseline and the large arena food becomes rewarding and the weight of action has two modes; in the "
        "small arena hardly any weight leaves its start.",
        "Does the size of the arena change which rewards evolve?",
        *SIZES,
    ),
    _item(
        "weights-places",
        "Weights that evolve with three distributions of food",
        "Where food lies around the center, hardly any weight leaves its start; where its place moves on, the weight "
        "of food is positive and that of action mostly negative.",
        "Does the place of food change which rewards evolve?",
        *PLACES,
    ),
    _item(
        "weights-poor",
        "Weights that evolve with poor food",
        "The weight of normal food is positive; that of food with a fifth of its energy varies widely between runs.",
        "Does food that gives little become rewarding?",
        POOR,
        panels=[("w_normal", "w_poor")],
    ),
    _item(
        "weights-poison",
        "Weights that evolve with poison",
        "The weight of normal food is positive; that of food that costs energy varies widely between runs.",
        "Does food that harms become aversive?",
        POISON,
        panels=[("w_normal", "w_poison")],
    ),
)
