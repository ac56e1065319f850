"""Items that show the body, and the arenas with the agents that live there."""

from collections.abc import Iterator

import hedon.figure
from hedon.figure import NamedFigure
from hedon.record import Snapshot
from hedon.study import Item, ItemInputs, Scale
from hedon_studies.kanagawa_doya_2024 import figure
from hedon_studies.kanagawa_doya_2024.condition import BASELINE, PLACES, POISON, POOR, SIZES

_FOODS = (*PLACES[1:], POOR, POISON)
_ONE_WORLD = Scale((1,), 10_240)
_BODY = (
    "Left, the body with its heading upward: the arc of the mouth, the sectors in which it feels touch, and the forces "
    "of its two motors; beside it a food of the same scale. Right, its rays at full length, which end where they no "
    "longer see."
)


def _body(inputs: ItemInputs) -> Iterator[NamedFigure]:
    question = "What does an agent sense, and how does it move and eat?"
    yield NamedFigure("body", question, hedon.figure.draw_body(BASELINE.config(inputs.fidelity)), _BODY)


def _arena(inputs: ItemInputs) -> Iterator[NamedFigure]:
    snapshot = inputs.snapshots.get(BASELINE.label)
    if snapshot is None:
        return
    colors = hedon.figure.meal_colors(BASELINE.config(inputs.fidelity))
    agent = hedon.figure.telling_agent(snapshot)
    rays_of = () if agent is None else (agent,)
    arena_figure = hedon.figure.draw_world(snapshot, colors, rays_of)
    yield NamedFigure("arena", "What does a world look like?", arena_figure, f"World of {_when(snapshot)}.")


def _arenas(inputs: ItemInputs) -> Iterator[NamedFigure]:
    rows = [
        [
            figure.ArenaPanel(condition.label, condition.config(inputs.fidelity), inputs.snapshots.get(condition.label))
            for condition in conditions
        ]
        for conditions in (SIZES, _FOODS)
    ]
    caption = "Above each, of every kind of food, its energy and how much there can be."
    shown_panels = [
        f"{panel.label} {_when(panel.snapshot)}" for row in rows for panel in row if panel.snapshot is not None
    ]
    if shown_panels:
        caption += f" Shown: {'; '.join(shown_panels)}."
    missing = [panel.label for row in rows for panel in row if panel.snapshot is None]
    if missing:
        caption += f" Drawn from the settings alone, since there was no run: {', '.join(missing)}."
    question = "What arenas are there, and where does food grow in each?"
    yield NamedFigure("arenas", question, figure.draw_arenas(rows), caption)


def _when(snapshot: Snapshot) -> str:
    return f"seed {snapshot.seed} at step {snapshot.step:,}"


PICTURES: tuple[Item, ...] = (
    Item("body", "The body", "An agent's mouth, touch sensors, motors and rays.", _body),
    Item(
        "arena",
        "The arena",
        "Agents and foods in the arena, and what one agent sees.",
        _arena,
        (BASELINE,),
        _ONE_WORLD,
        pictures=True,
    ),
    Item(
        "arenas",
        "All arenas",
        "Arenas of three sizes, food in one place or in four by turns, and food of a second kind.",
        _arenas,
        (*SIZES, *_FOODS),
        _ONE_WORLD,
        pictures=True,
    ),
)
