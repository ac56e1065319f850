"""The sequel to the paper, on predators, prey and pitfalls: its figures, and our own questions about the same worlds.

Kanagawa & Doya, "Evolution of Fear and Social Rewards in Prey-Predator Relationship", arXiv 2507.09992, version 2. Its
claims and their rules are in `hedon_studies.fear.claim`.
"""

from collections.abc import Iterator
from functools import partial

import polars as pl

import hedon.figure
from hedon.analysis import REACH, ResultTable, company, death_rates, history, make_table, species_loss
from hedon.config import hunters
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, Scale, missing, present, sentences, stack, world_indices
from hedon_studies.kanagawa_doya_2024.drift import make_drift
from hedon_studies.kanagawa_doya_2024.evolved_weight import draw_last
from hedon_studies.kanagawa_doya_2024.weight_history import draw_courses

SCALE = Scale((1, 2, 3, 4, 5), 2_048_000)
"""Our scale; the sequel has five runs of 10,240,000 steps for each condition."""
FRAMES = 1024
"""Steps between two records of all positions."""
LATE = 51_200
"""Number of steps at the end of a world over which its numbers are averaged."""
PREY, PREDATOR = "prey", "predator"

MAIN = Condition("prey", "predator")
HUNTERS = Condition("predators", "predator", species=PREDATOR)
SQUARE = Condition("prey, square arena", "predator-square")
MOUTHS = (
    Condition("mouths of 40°", "predator-small-mouth"),
    Condition("mouths of 60°", "predator"),
    Condition("mouths of 80°", "predator-large-mouth"),
)
FOOD = (
    Condition("as usual", "predator"),
    Condition("less food", "predator-less-food"),
    Condition("no predators", "prey-alone"),
)
FROZEN = (Condition("predators evolve", "predator"), Condition("predators do not mutate", "predator-frozen"))
_READS = ("reward.pay.see_obstacle.channel=see_normal_max",)
PITFALLS = (
    Condition("damage 10", "pitfall"),
    Condition("damage 1", "pitfall-weak"),
    Condition("damage 10, food's rays", "pitfall", _READS),
    Condition("damage 1, food's rays", "pitfall-weak", _READS),
)
DRIFTING = (MAIN, SQUARE, *MOUTHS[::2], FOOD[1], FROZEN[1])
EVERY = (*FOOD, SQUARE, *MOUTHS[::2], FROZEN[1], *PITFALLS[:2])
_LAST = (
    "last: share of worlds with all species alive at by_step (Kaplan and Meier; a world that ends earlier is censored "
    "there), with the mid-p interval of the beta product. The sequel left out runs in which a species died out, and "
    "kept 5 of 6, 5 of 13, 5 of 6 and 5 of 7."
)
_SOCIAL = (("w_see_predator", "w_see_prey"),)
_REWARDS = {
    "w_normal": "weight of food",
    "w_see_prey": "weight of seeing prey",
    "w_see_predator": "weight of seeing predators",
}


def _courses(inputs: ItemInputs) -> Iterator[NamedFigure]:
    conditions = {PREY: (MAIN, SQUARE), PREDATOR: (HUNTERS,)}
    for name, group in conditions.items():
        yield from draw_courses(f"sequel-history-{name}", f"How do the rewards of {name} evolve?", group, inputs)


def _numbers(inputs: ItemInputs) -> Iterator[NamedFigure]:
    name, question = "sequel-numbers", "How many prey and predators live together?"
    worlds = present((MAIN, HUNTERS), inputs)
    if len(worlds) < 2:
        yield NamedFigure(name, question, hedon.figure.draw_message("no worlds yet"), missing((MAIN, HUNTERS), inputs))
        return
    indices = world_indices(worlds.values())
    histories = {label: history(stack(group, "population", indices), ()) for label, group in worlds.items()}
    caption = (
        "Left, thin: one world; thick: the mean over worlds. Right: a line per world, by the color of its seed, to its "
        "end at the dot."
    )
    yield NamedFigure(name, question, hedon.figure.draw_numbers(histories), caption)


def _deaths(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    name, question = "sequel-deaths", "What do prey and predators die of?"
    worlds = present((MAIN, HUNTERS), inputs)
    if not worlds:
        yield NamedFigure(name, question, hedon.figure.draw_message("no worlds yet"), missing((MAIN, HUNTERS), inputs))
        return
    indices = world_indices(worlds.values())
    rates = {label: death_rates(stack(group, "population", indices)) for label, group in worlds.items()}
    caption = "Deaths per 10,000 steps lived, by cause: the mean over worlds, with its 95 % interval from five on."
    yield NamedFigure(name, question, hedon.figure.draw_causes(rates), caption)
    rows = [
        {"species": label, "seed": world.seed, "deaths": world.agents["death_step"].count()}
        | {cause: (world.agents["cause"] == cause).sum() for cause in ("age_energy", "starved", "eaten")}
        for label, group in worlds.items()
        for world in group
    ]
    yield make_table("sequel_deaths", "Deaths by cause", rows)


def _survival(inputs: ItemInputs) -> Iterator[ResultTable]:
    worlds = present(EVERY, inputs)
    rows = []
    for label, group in worlds.items():
        until = max((world.last_step for world in group), default=SCALE.steps)
        loss = species_loss(group, until)
        extinct_count = sum(world.extinct_step is not None for world in group)
        apart_count = sum(world.extinct_step is None and world.apart_step is not None for world in group)
        rows.append(
            {
                "condition": label,
                "worlds": loss.worlds,
                "it_died_out": extinct_count,
                "another_died_out": apart_count,
                "last": 1 - loss.share,
                "low": 1 - loss.high,
                "high": 1 - loss.low,
                "by_step": int(loss.known_until),
            }
        )
    yield make_table(
        "sequel_survival", "Worlds that keep all their species", rows, sentences(_LAST, missing(EVERY, inputs))
    )
    alive = [
        {
            "species": world.species,
            "seed": world.seed,
            "last_step": world.last_step,
            "died_out": world.extinct_step,
            "alive": world.population.filter(pl.col("step") > world.last_step - LATE)["alive"].mean(),
        }
        for group in present((FOOD[0], HUNTERS), inputs).values()
        for world in group
    ]
    note = f"alive: mean over the last {LATE:,} steps of the record. died_out: the step, if it did."
    yield make_table("sequel_alive", "Numbers of prey and predators, by world", alive, note)


def _company(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    name, question = "sequel-groups", "Do prey keep together, and away from predators?"
    frames, worlds = inputs.frames.get(MAIN.label, ()), inputs.worlds.get(MAIN.label, ())
    if not frames or len(frames) != len(worlds):
        figure = hedon.figure.draw_message("no positions were recorded")
        yield NamedFigure(name, question, figure, missing((MAIN,), inputs))
        return
    company_by_seed = {
        world.seed: company(world, rows, hunters(world.config, world.species))
        for world, rows in zip(worlds, frames, strict=True)
    }
    caption = (
        f"A group is what hangs together by distances of centers of at most {REACH:g} u; the size is that of the group "
        "of a prey, itself included. Gray: as many prey placed evenly by chance. Means over "
        f"{hedon.figure.SMOOTH} frames."
    )
    yield NamedFigure(name, question, hedon.figure.draw_company(company_by_seed, PREY, PREDATOR), caption)
    means = [
        {"seed": seed, **rows.select(pl.exclude("step").mean()).row(0, named=True)}
        for seed, rows in company_by_seed.items()
    ]
    yield make_table("sequel_groups", "Groups of prey, and distances to predators", means, "Means over frames.")


def _last(
    name: str,
    title: str,
    says: str,
    question: str,
    conditions: tuple[Condition, ...],
    panels: tuple[tuple[str, str], ...] = _SOCIAL,
) -> Item:
    """The item of the weights of the agents born last in some conditions."""
    return Item(name, title, says, partial(draw_last, name, question, conditions, panels), conditions, SCALE)


SEQUEL: tuple[Item, ...] = (
    Item(
        "sequel-history",
        "How the rewards of prey and predators evolve",
        "Mean weights of all rewards over time, of both species.",
        _courses,
        (MAIN, HUNTERS, SQUARE),
        SCALE,
    ),
    _last(
        "sequel-fear",
        "Fear and social reward",
        "The weight for seeing predators often ends negative (fear); in other worlds those for seeing prey or "
        "predators end positive.",
        "Which rewards for seeing others evolve in prey?",
        (MAIN, SQUARE),
    ),
    Item(
        "sequel-drift",
        "Rewards of prey against drift",
        "None of its claims: we ask which weights go further than neutral genes of the same pedigree.",
        partial(make_drift, DRIFTING, _REWARDS, SCALE, "sequel-drift"),
        DRIFTING,
        SCALE,
    ),
    Item(
        "sequel-numbers",
        "Numbers of prey and predators",
        "None of its claims: we ask whether both last, and whether they go round in cycles.",
        _numbers,
        (MAIN, HUNTERS),
        SCALE,
    ),
    Item(
        "sequel-survival",
        "Worlds that keep all their species",
        "Runs in which a species died out are left out of its figures; we count them.",
        _survival,
        (*EVERY, HUNTERS),
        SCALE,
    ),
    Item(
        "sequel-deaths",
        "Causes of death",
        "None of its claims: we ask how strong selection by predators can be.",
        _deaths,
        (MAIN, HUNTERS),
        SCALE,
    ),
    Item(
        "sequel-groups",
        "Groups of prey, and the nearest predator",
        "None of its claims: we ask whether rewards for seeing others show in where prey are.",
        _company,
        (MAIN,),
        SCALE,
        frames=FRAMES,
    ),
    _last(
        "sequel-mouths",
        "Mouths of predators",
        "Predators that hunt better, by larger mouths, make fear stronger.",
        "Do larger mouths of predators make fear stronger?",
        MOUTHS,
    ),
    _last(
        "sequel-food",
        "Less food, and no predators",
        "With less food the weight for seeing prey is more negative.",
        "Does scarce food make prey dislike one another?",
        FOOD,
    ),
    _last(
        "sequel-frozen",
        "Predators that do not mutate",
        "A condition of its own, in which predators stay as they are.",
        "Do prey evolve otherwise where predators do not?",
        FROZEN,
    ),
    _last(
        "sequel-pitfall",
        "Pitfalls",
        "No fear evolves of pitfalls that cost energy but do not kill. Its program weighs food's rays there.",
        "Do agents come to fear what costs energy, and what if the weight reads food's rays?",
        PITFALLS,
        (("w_see_obstacle", "w_see_agent"),),
    ),
)
