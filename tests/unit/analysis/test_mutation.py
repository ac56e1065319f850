"""Mutation as a treatment: a known effect is found whatever the parents do, and none if there is none."""

from pathlib import Path

import numpy as np
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.gene.mutation import CLIP, Births, births_of, mutation_effects, pool
from hedon.analysis.world.record import read_worlds
from hedon.record.reader import open_run
from hedon.report.analysis import analyze

NAMES = ("w_normal", "neutral_1")


def births(rng: np.random.Generator, effect: float = 0.0, parents: int = 150) -> Births:
    """Children whose outcomes depend on their parent, and on their own clipped mutation of the first gene."""
    parent = np.repeat(np.arange(parents), rng.poisson(2.5, parents) + 1)
    change = 0.02 * rng.standard_cauchy((len(parent), 2))
    luck = rng.lognormal(0, 0.7, parents)[parent]
    cause = np.clip(1 + effect * np.clip(change[:, 0], -CLIP, CLIP), 0, None)
    outcome = np.stack([luck * cause * rng.exponential(1, len(parent)) for _ in range(3)], axis=1)
    return Births(change, outcome, parent)


def test_a_known_effect_is_found_with_an_interval_that_covers() -> None:
    found = mutation_effects(births(np.random.default_rng(4), 0.8, 20_000), NAMES, np.random.default_rng(1), 300)
    clipped = {(each["outcome"], each["weight"]): each for each in found if each["scale"] == "clipped"}
    for outcome in ("food", "lifespan", "children"):
        each = clipped[outcome, "w_normal"]
        assert each["low"] <= 0.8 <= each["high"]
        assert each["p"] < 1e-3
        assert clipped[outcome, "neutral_1"]["p"] > 0.001
    assert len(found) == 2 * 2 * 3


def test_differences_between_parents_are_no_effect() -> None:
    # The children of some parents fare far better, whatever their mutations.
    rng = np.random.default_rng(2)
    data = births(rng, 0.0, 5000)
    data.outcome[:] *= np.exp(rng.normal(0, 2, 5000))[data.parent][:, None]
    found = mutation_effects(data, NAMES, np.random.default_rng(1), 300)
    assert len(found) == 2 * 2 * 3
    for each in found:
        assert each["p"] > 0.001


def test_mutations_without_effect_are_found_once_in_twenty() -> None:
    trials, found = 200, {"clipped": 0, "rank": 0}
    for trial in range(trials):
        rng = np.random.default_rng([9, trial])
        for each in mutation_effects(births(rng, parents=800), NAMES[:1] * 2, rng, 200):
            if each["outcome"] == "food" and each["weight"] == "w_normal":
                found[each["scale"]] += each["p"] < 0.05
    print(f"size: {found} of {2 * trials}")
    low, high = stats.binom.interval(0.99, 2 * trials, 0.05)
    assert low <= found["rank"] <= high
    assert low <= found["clipped"] <= high


def test_births_are_children_with_siblings_of_recorded_parents(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=30, worlds=2))
    worlds = read_worlds([run])
    data = births_of(worlds[0])
    agents = worlds[0].agents
    genome = {row["agent_id"]: row["w_normal"] for row in agents.to_dicts()}
    known = [row for row in agents.to_dicts() if row["parent_id"] is not None]
    known = [row for row in known if row["birth_step"] <= 0.9 * worlds[0].last_step]
    expected = [row["w_normal"] - genome[row["parent_id"]] for row in known]
    np.testing.assert_allclose(data.change[:, 0], expected, atol=1e-6)
    both = pool([data, births_of(worlds[1])])
    assert len(np.unique(both.parent)) == len(np.unique(data.parent)) + len(np.unique(births_of(worlds[1]).parent))
    tables = analyze([run], ["mutation"]).tables
    assert tables["mutation_gene"].rows.height == 3 * 2 * 3
    assert tables["mutation"].shown


def test_too_few_families_give_no_answer() -> None:
    few = births(np.random.default_rng(1), parents=20)
    assert mutation_effects(few, NAMES, np.random.default_rng(1)) == []
    alone = Births(few.change, few.outcome, np.arange(len(few.parent)))
    assert mutation_effects(alone, NAMES, np.random.default_rng(1)) == []
    still = Births(np.zeros_like(few.change), few.outcome, few.parent)
    big = pool([still, still])
    assert all(np.isnan(each["effect"]) for each in mutation_effects(big, NAMES, np.random.default_rng(1), 50))
