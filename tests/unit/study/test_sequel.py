"""The rules for the sequel's claims, on synthetic worlds with a known answer: planted, absent, or drift alone."""

from dataclasses import replace
from functools import cache

import numpy as np
import polars as pl
import pytest

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord
from hedon.config import load_config
from hedon.config.layout import layouts
from hedon.config.type import hunted, hunters
from hedon.study.catalogue import choose
from hedon.study.item import ItemInputs
from hedon.study.verdict import Verdict, judge, verdicts
from hedon_studies.fear.claim import BY_CHANCE, FAMILY, OFTEN, SEQUEL_CLAIMS, SEQUEL_ORDERS, fear
from hedon_studies.fear.program import PITFALL_RUN, PREDATOR_RUN, WINDOW
from hedon_studies.kanagawa_doya_2024.paper import STEPS

_PUSH = 1.5  # per generation, planted; about four times the scale of mutations
_GENERATIONS, _WIDTH = 20, 20


@cache
def made(preset: str, seed: int, pushed: str = "", push: float = 0.0) -> WorldRecord:
    """A world of a few families whose weights mutate under the preset's law; one weight is pushed each generation."""
    config = load_config(preset)
    own = hunted(config) if len(config.species) > 1 else next(iter(config.species))
    genome = config.species[own].genome
    genes = layouts(config)[own].gene_names
    rng = np.random.default_rng([len(preset), seed])
    size = _WIDTH * _GENERATIONS
    parents = np.full(size, -1, np.int64)
    weights = np.zeros((size, len(genes)))
    weights[:_WIDTH] = rng.normal(0, 0.1, (_WIDTH, len(genes)))
    drift = np.array([push if gene == pushed else 0.0 for gene in genes])
    for start in range(_WIDTH, size, _WIDTH):
        chosen = start - _WIDTH + rng.integers(0, _WIDTH, _WIDTH)
        parents[start : start + _WIDTH] = chosen
        noise = genome.mutation_scale * rng.standard_t(genome.mutation_df, (_WIDTH, len(genes)))
        weights[start : start + _WIDTH] = np.clip(weights[chosen] + noise + drift, -10, 10)
    agents = pl.DataFrame(
        {
            "world": pl.Series(np.zeros(size, np.int32)),
            "seed": pl.Series(np.full(size, seed)),
            "agent_id": pl.Series(np.arange(size)),
            "parent_id": pl.Series(parents),
            "generation": pl.Series((np.arange(size) // _WIDTH).astype(np.int32)),
            "birth_step": pl.Series(np.arange(size) // _WIDTH * 1000),
            "death_step": pl.Series(np.arange(size) // _WIDTH * 1000 + 1000),
        }
    ).with_columns(pl.Series(gene, weights[:, i].astype(np.float32)) for i, gene in enumerate(genes))
    neutral = tuple(gene for gene in genes if gene.startswith("neutral"))
    rewards = tuple(gene for gene in genes if gene not in neutral)
    names = (tuple(config.food), rewards, neutral)
    name = f"{preset}: {own}"
    return WorldRecord(name, "run", seed, config, *names, agents, pl.DataFrame(), STEPS, None, species=own)


def group(preset: str, count: int, pushed: str = "", push: float = 0.0) -> list[WorldRecord]:
    return [made(preset, seed, pushed, push) for seed in range(1, count + 1)]


def asked(worlds: list[WorldRecord]) -> dict[str, Verdict]:
    return {found.claim: found for found in verdicts(worlds, (*SEQUEL_CLAIMS, *SEQUEL_ORDERS))}


def seen(role: str) -> str:
    """The gene for seeing one's own species, or the species that eats it."""
    config = load_config("predator")
    own = hunted(config)
    return f"w_see_{own if role == 'own' else hunters(config, own)[0]}"


def test_planted_fear_is_found() -> None:
    found = asked(group("predator", 6, seen("hunter"), -_PUSH))
    fearful = found["fear often evolves"]
    assert (fearful.verdict, fearful.value, fearful.worlds) == ("holds", 1.0, 6)
    assert found["liking predators in some worlds"].verdict == "undecided"
    assert found["liking one's own kind in some worlds"].verdict == "undecided"


@pytest.mark.parametrize(("role", "claim"), [("own", "one's own kind"), ("hunter", "predators")])
def test_planted_liking_is_found(role: str, claim: str) -> None:
    liked = group("predator", 3, seen(role), _PUSH) + group("predator", 6)[3:]
    assert asked(liked)[f"liking {claim} in some worlds"].verdict == "holds"


def test_drift_alone_is_neither_fear_nor_liking() -> None:
    worlds = group("predator", 8)
    found = asked(worlds)
    assert (found["fear often evolves"].verdict, found["fear often evolves"].value) == ("undecided", 0.0)
    assert found["liking predators in some worlds"].verdict == "undecided"
    assert found["liking one's own kind in some worlds"].verdict == "undecided"
    scores = np.array([fear(world) for world in worlds], float)
    assert abs(scores.mean()) < 3 / np.sqrt(len(scores))  # like neutral genes, with sd 1
    (rule,) = [claim for claim in SEQUEL_CLAIMS if claim.name == "fear often evolves"]
    none = judge(replace(rule, measure=lambda _: -1.0), "c", worlds * 3)
    assert (none.verdict, none.worlds) == ("fails", 24)


def test_order_follows_what_is_planted() -> None:
    calm, scared = group("predator-small-mouth", 6), group("predator-large-mouth", 6, seen("hunter"), -_PUSH)
    name = "larger mouths, stronger fear"
    assert asked([*calm, *scared])[name].verdict == "holds"
    assert asked([*calm, *group("predator-large-mouth", 6)])[name].verdict == "undecided"
    scared, calm = group("predator-small-mouth", 6, seen("hunter"), -_PUSH), group("predator-large-mouth", 6)
    assert asked([*calm, *scared])[name].verdict == "fails"
    hungry = group("predator-less-food", 6, seen("own"), -_PUSH)
    assert asked([*hungry, *group("predator", 6)])["less food, less liking of one's own kind"].verdict == "holds"


def test_weak_pitfalls() -> None:
    name = "no fear of weak pitfalls"
    worlds = group("pitfall-weak", 5)
    assert asked(worlds)[name].verdict == "undecided"  # too few to show that there is none
    (rule,) = [claim for claim in SEQUEL_CLAIMS if claim.name == name]
    none = judge(replace(rule, measure=lambda _: -1.0), "c", worlds * 5)
    assert (none.verdict, none.worlds) == ("holds", 25)
    assert asked(group("pitfall-weak", 6, "w_see_obstacle", -_PUSH))[name].verdict == "fails"


def test_few_short_or_lone_worlds_decide_nothing() -> None:
    worlds = group("predator", 6, seen("hunter"), -_PUSH)
    name = "fear often evolves"
    assert asked(worlds[:2])[name].reason.startswith("fewer than 6 worlds")
    short = asked([replace(world, last_step=1024) for world in worlds])[name]
    assert short.verdict == "undecided"
    assert short.reason.startswith(f"the worlds reach 1,024 of {STEPS:,} steps")
    lone = asked([replace(world, apart_step=5000) for world in worlds])[name]
    assert (lone.verdict, lone.worlds) == ("undecided", 0)
    assert "6 left out where another species died out" in lone.reason
    dead = asked([replace(world, extinct_step=5000) for world in worlds])[name]
    assert (dead.verdict, "6 extinct left out" in dead.reason) == ("undecided", True)


def test_worlds_that_lost_a_species_are_reported_with_every_claim() -> None:
    """Kaplan-Meier: of five worlds, one loses its prey, one its predators, and one is followed only halfway."""
    worlds = group("predator", 5, seen("hunter"), -_PUSH)
    ends = [{"extinct_step": 1000}, {"last_step": STEPS // 2}, {"apart_step": STEPS - 1}, {}, {}]
    mixed = [replace(world, **end) for world, end in zip(worlds, ends, strict=True)]
    for found in asked([*mixed, *group("predator-less-food", 5)]).values():
        assert f"every species lasts to step {STEPS:,} in " in found.reason
    reason = asked(mixed)["fear often evolves"].reason
    # 4/5 survive step 1000; of the three at risk at the second-to-last step, one is lost.
    assert f"in {100 * 4 / 5 * 2 / 3:.0f} % (" in reason
    assert "of 5 worlds (Kaplan and Meier)" in reason
    pitfalls = asked([replace(world, extinct_step=9) for world in group("pitfall-weak", 4)])["no fear of weak pitfalls"]
    assert "every species lasts to step 10,240,000 in 0 % (0 … " in pitfalls.reason
    assert asked(worlds)["fear often evolves"].source == "Kanagawa & Doya, arXiv 2507.09992v2, claim (a)"


def test_the_claims_are_one_family() -> None:
    assert len(SEQUEL_CLAIMS) + len(SEQUEL_ORDERS) == FAMILY
    assert {each.level for each in (*SEQUEL_CLAIMS, *SEQUEL_ORDERS)} == {1 - 0.05 / FAMILY}
    assert (BY_CHANCE, OFTEN) == (0.025, 0.25)


def tables(name: str, worlds: dict) -> dict[str, list[dict]]:
    (item,) = choose([name])[0].items
    made = item.make(ItemInputs("corrected", worlds))
    return {table.name: table.rows.to_dicts() for table in made if isinstance(table, ResultTable)}


def test_worlds_of_each_condition_are_counted_by_what_died_out() -> None:
    ends = [{"extinct_step": 1000}, {"apart_step": 2000}, {}, {}]
    numbers = pl.DataFrame({"step": [WINDOW], "alive": [300]})
    worlds = [replace(world, population=numbers, **end) for world, end in zip(group("predator", 4), ends, strict=True)]
    (row,) = tables("sequel-survival", {"as usual": worlds})["sequel_survival"]
    assert (row["worlds"], row["it_died_out"], row["another_died_out"], row["last"]) == (4, 1, 1, 0.5)
    assert 0 < row["low"] < 0.5 < row["high"] < 1


def test_the_numbers_of_each_species_are_given_with_the_step_of_its_extinction() -> None:
    """Means over the last 51,200 steps: only the last 50 windows of 1,024 steps count."""
    steps = [number * WINDOW for number in range(1, 61)]
    numbers = pl.DataFrame({"step": steps, "alive": [1000] * 10 + [20, 40] * 25})
    first, second = (replace(world, population=numbers, last_step=steps[-1]) for world in group("predator", 2))
    lost = replace(second, extinct_step=7, last_step=7, population=numbers.clear())
    first_row, second_row = tables("sequel-survival", {"predators": [first, lost]})["sequel_alive"]
    assert first_row == {"species": first.species, "seed": 1, "last_step": 61440, "died_out": None, "alive": 30.0}
    assert (second_row["died_out"], second_row["alive"]) == (7, None)


def test_windows_are_shown_next_to_those_of_the_program() -> None:
    numbers = pl.DataFrame(
        {"step": [WINDOW, 2 * WINDOW], "alive": [300, 450], "births": [160, 170], "deaths_eaten": [10, 20]}
        | {"food_normal": [290, 310], "energy_mean": [48.0, 32.0], "deaths": [9, 8], "obstacles_touched": [5, 4]}
    )
    first, second = group("predator", 2)
    worlds = [replace(first, population=numbers), replace(second, population=numbers.with_columns(pl.col("alive") + 3))]
    found = tables("sequel-program", {"prey": worlds, "pitfall": worlds[:1]})
    rows = {(row["window"], row["quantity"]): row for row in found["sequel_program_predator"]}
    assert len(rows) == 6 * len(PREDATOR_RUN)
    assert rows[2, "prey alive"] | {"window": 2, "quantity": ""} == {
        **{"window": 2, "quantity": "", "program": 450, "low": 450, "high": 453, "worlds": 2}
    }
    assert rows[1, "energy_mean"]["program"] == PREDATOR_RUN[1][-1]
    assert (rows[3, "births"]["low"], rows[3, "births"]["worlds"]) == (None, 0)
    assert rows[1, "predators alive"]["worlds"] == 0
    fallen = {(row["window"], row["quantity"]): row for row in found["sequel_program_pitfall"]}
    assert fallen[1, "obstacles_touched"]["program"] == PITFALL_RUN[1][3]
    assert fallen[1, "obstacles_touched"]["low"] == 5
