"""Items that need only settings: the laws of death, birth and mutation."""

from collections.abc import Iterator

import numpy as np

import hedon.figure
from hedon.analysis import SEED, mutation_law
from hedon.config import ONLY, Config, gene_of
from hedon.demography import birth_rate, expected_lifetime, reproduction_number
from hedon.figure import NamedFigure
from hedon.study import Item, ItemInputs, sentences
from hedon_studies.kanagawa_doya_2024.condition import BASELINE

_ENDS = (
    "A point is a line of descent: two of its weights after 100 and after 1,000 mutations without selection. Weights "
    "cannot pass their limit, and mutations have heavy tails, so lines gather along the edges, and in the four "
    "corners, where both weights are within a tenth of it; the numbers are the shares of lines there."
)
_LINES = (
    "A row per number of mutations: examples of lines, with the bands that hold half and 95 % of all lines, and at the "
    "right where all lines end."
)


def window_births(config: Config) -> int:
    """The births attempted in a window of learning by an arena full of agents without energy."""
    species = config.species[ONLY]
    chance = float(birth_rate(species.birth, 0.0))
    return max(round(species.population.capacity * chance * config.world.rollout_steps), 1)


def _hazard(inputs: ItemInputs) -> Iterator[NamedFigure]:
    species = BASELINE.config(inputs.fidelity).species[ONLY]
    poor, rich = (float(expected_lifetime(species.hazard, energy)) for energy in (0.0, species.energy.capacity))
    caption = (
        f"At constant energy a life lasts {poor:,.0f} steps on average without any, and {rich:,.0f} with as much as an "
        "agent can hold."
    )
    yield NamedFigure(
        "hazard", "How do energy and age decide who dies?", hedon.figure.draw_hazard(species.hazard), caption
    )


def _birth(inputs: ItemInputs) -> Iterator[NamedFigure]:
    species = BASELINE.config(inputs.fidelity).species[ONLY]
    children = float(reproduction_number(species.hazard, species.birth, 0.0))
    caption = (
        f"Even an agent that stays at zero energy tries {children:.2f} children in its life; a lineage keeps its size "
        "at 1, if all of them find a place."
    )
    yield NamedFigure("birth", "How does energy decide who has children?", hedon.figure.draw_birth(species), caption)


def _walk(inputs: ItemInputs) -> Iterator[NamedFigure]:
    config = BASELINE.config(inputs.fidelity)
    law, births = mutation_law(config, gene_of(config, "neutral_1")), window_births(config)
    noise = ""
    if law.tabulated:
        noise = (
            "The noise is tabulated: a world has one table of noise, an entry per birth of a window, and each "
            f"mutation of a line is any of its entries. The tables here have {births} entries, the births that a full "
            "arena without energy tries in a window."
        )
    for name, question, draw, caption in (
        ("walk", "Where do mutations alone carry weights that nothing selects?", hedon.figure.draw_walk_ends, _ENDS),
        ("walk_lines", "How does a weight get there?", hedon.figure.draw_walks, _LINES),
    ):
        figure = draw(law, births, np.random.default_rng(SEED))
        yield NamedFigure(name, question, figure, sentences(caption, noise))


LAWS: tuple[Item, ...] = (
    Item(
        "hazard",
        "The chance of death",
        "The hazard by energy and by age, and survival at constant energy. "
        "The formula is that of the released code: as printed, it gives a mean life of 209 steps at an energy of 20.",
        _hazard,
    ),
    Item(
        "birth",
        "The chance of a birth",
        "The chance of a birth by energy. The sign of its exponent is that of the released code: "
        "as printed, the chance would fall with energy.",
        _birth,
    ),
    Item(
        "walk",
        "The random walk of mutations",
        "Weights that mutate 100 and 1000 times without selection.",
        _walk,
    ),
)
