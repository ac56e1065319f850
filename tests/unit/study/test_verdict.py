import dataclasses
import math
import re
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from synthetic_run import write_run

from hedon.analysis.gene.drift import WorldDrift
from hedon.analysis.world.record import WorldRecord, read_worlds
from hedon.config import load_config
from hedon.record.reader import open_run
from hedon.statistic.contrast import fisher_mid_p
from hedon.statistic.interval import distance_interval, spread_interval
from hedon.study.claim import Claim, Comparison, Order, OverWorlds
from hedon.study.estimate import estimate
from hedon.study.item import Condition
from hedon.study.verdict import judge, judge_order, place, verdicts
from hedon_studies.kanagawa_doya_2024.claim import CLAIMS, SAME_FACTOR
from hedon_studies.kanagawa_doya_2024.order import ORDERS

EVERY = (*CLAIMS, *ORDERS)


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("verdict") / "run"
    return read_worlds([open_run(write_run(folder, worlds=12, intervals=5, snapshot=False))])


def claim(figures: list[float], over_worlds: OverWorlds, **region: Any) -> Claim:
    """A claim whose value for the world with seed i + 1 is figures[i]."""
    options: dict[str, Any] = {"steps": 0} | region
    return Claim("a", Condition("baseline"), "text", lambda w: figures[w.seed - 1], over_worlds, "0", **options)


def test_where_an_interval_lies() -> None:
    assert place(1, 2, 0, math.inf) == "holds"
    assert place(-2, -1, 0, math.inf) == "fails"
    assert place(-1, 1, 0, math.inf) == "undecided"
    assert place(0, 1, 0, math.inf) == "undecided"  # it includes the bound
    assert place(2, 3, 0, 1) == "fails"
    assert place(math.nan, math.nan, 0, 1) == "undecided"


def test_rules(worlds: list[WorldRecord]) -> None:
    six = worlds[:6]
    assert judge(claim([1.0, 1.1, 0.9] * 2, "mean", low=0.0), "c", six).verdict == "holds"
    assert judge(claim([1.0, -1.1, 0.9] * 2, "mean", low=0.0), "c", six).verdict == "undecided"
    assert judge(claim([1.0, 1.1, 0.9] * 2, "mean", high=0.5), "c", six).verdict == "fails"
    same = judge(claim([90.0, 100.0, 110.0] * 2, "ratio", low=100 / 1.5, high=150.0), "c", six)
    assert (same.verdict, same.value) == ("holds", pytest.approx(np.exp(np.mean(np.log([90, 100, 110])))))
    assert (same.against_reported, math.isnan(same.p_reported)) == ("the source gives no spread", True)
    two = judge(claim([-1.0, -1.1, -0.9, -1.05, -0.95, -1.01, 5, 5.1, 4.9, 5.05, 4.95, 5.01], "modes"), "c", worlds)
    assert two.verdict == "holds"
    assert two.reason.startswith("6 worlds around -1.00, 6 around 5.00; dip test: p = 0.0")


def test_a_measure_that_fails_leaves_its_claim_undecided(worlds: list[WorldRecord]) -> None:
    def fail(world: WorldRecord) -> float:
        raise ValueError(f"no figure of {world.seed}")

    condition = Condition("baseline")
    single = Claim("a", condition, "text", fail, "mean", "0")
    order = Order("b", condition, condition, "text", fail, "difference", "0")
    known = Claim("c", condition, "text", lambda world: 1.0, "mean", "0", low=0.0)
    found = {row.claim: row for row in verdicts(worlds, [single, order, known])}
    assert {found["a"].verdict, found["b"].verdict} == {"undecided"}
    assert all(re.search(r"its measure failed: ValueError: no figure of 1 \(line \d+", found[n].reason) for n in "ab")
    assert (found["c"].value, found["c"].worlds) == (1.0, 12)


def test_six_of_six_worlds_decide(worlds: list[WorldRecord]) -> None:
    six = judge(claim([1.0] * 6, "share", low=0.5), "c", worlds[:6])
    assert (six.verdict, six.value, six.against_reported) == ("holds", 1.0, "the source gives no count")
    assert six.low == pytest.approx(0.025 ** (1 / 6))
    assert judge(claim([-1.0] * 6, "share", low=0.5), "c", worlds[:6]).verdict == "fails"
    assert judge(claim([1.0] * 5 + [-1.0], "share", low=0.5), "c", worlds[:6]).verdict == "undecided"
    assert judge(claim([1.0] * 5, "share", low=0.5), "c", worlds[:5]).verdict == "undecided"


def test_the_difference_from_the_paper_is_tested_separately(worlds: list[WorldRecord]) -> None:
    figures = [1.0, -1.0, -1.0] * 4
    unlike = judge(claim(figures, "share", low=0.5, reported_count=(5, 5)), "c", worlds)
    assert (unlike.verdict, unlike.against_reported) == ("undecided", "differs")
    assert unlike.p_reported == pytest.approx(fisher_mid_p(4, 12, 5, 5))
    like = judge(claim([1.0] * 12, "share", low=0.5, reported_count=(5, 5)), "c", worlds)
    assert (like.verdict, like.against_reported) == ("holds", "no difference shown")


def test_the_verdict_on_modes_comes_with_its_power(worlds: list[WorldRecord]) -> None:
    many = [dataclasses.replace(worlds[i % 12], seed=i + 1) for i in range(60)]
    for count, power in ((6, "0.2"), (12, "0.36"), (60, "0.98")):
        found = judge(claim(list(np.linspace(-1, 1, 60)), "modes"), "c", many[:count])
        assert found.verdict == "undecided", "finding no second mode is no evidence of a single mode"
        assert f"power {power}" in found.reason


def test_extinct_worlds_do_not_represent_short_ones(worlds: list[WorldRecord]) -> None:
    """14 worlds die out and 26 are alive halfway: the verdict is not "share 1.00 of 14 worlds, holds"."""
    many = [dataclasses.replace(worlds[i % 12], seed=i) for i in range(40)]
    mixed = [dataclasses.replace(w, extinct_step=1024, last_step=1024) for w in many[:14]] + many[14:]
    rule = claim([], "extinction", low=0.55, steps=2 * 5120, reported_count=(9, 10))
    found = judge(rule, "c", mixed)
    assert (found.verdict, found.worlds) == ("undecided", 40)
    assert (found.value, found.high) == (pytest.approx(0.35), 1.0)
    assert "26 of 40 worlds live and end before step 10,240" in found.reason
    assert found.against_reported == "no difference shown"  # as the 26 may still die out
    reached = judge(dataclasses.replace(rule, steps=5120), "c", mixed)
    assert (reached.verdict, reached.value) == ("fails", pytest.approx(0.35))
    assert reached.p_reported == pytest.approx(fisher_mid_p(14, 40, 9, 10))
    assert reached.against_reported == "differs"


def test_the_papers_own_table_of_extinction_decides(worlds: list[WorldRecord]) -> None:
    rules = [rule for rule in CLAIMS if rule.over_worlds == "extinction"]
    assert len(rules) > 3
    for rule in rules:
        gone, of = rule.reported_count or (0, 0)
        assert of == 10
        ten = [dataclasses.replace(w, last_step=rule.steps) for w in worlds[:10]]
        mixed = [dataclasses.replace(w, extinct_step=1024) for w in ten[:gone]] + ten[gone:]
        found = judge(rule, "c", mixed)
        assert (found.verdict, found.against_reported) == ("holds", "no difference shown"), rule.text


def test_too_few_too_short_or_extinct_worlds_decide_nothing(worlds: list[WorldRecord]) -> None:
    sure = [1.0, 1.01, 0.99, 1.0, 1.02, 0.98, 1.0]
    few = judge(claim(sure, "mean", low=0.0), "c", worlds[:2])
    assert (few.verdict, few.reason, few.worlds) == ("undecided", "fewer than 6 worlds", 2)
    short = judge(claim(sure, "mean", low=0.0, steps=10**6), "c", worlds[:6])
    assert (short.verdict, short.reason) == ("undecided", "the worlds reach 5,120 of 1,000,000 steps")
    one_short = [*worlds[:6], worlds[6].until(1024)]
    named = judge(claim(sure, "mean", low=0.0, steps=5120), "c", one_short)
    assert (named.verdict, named.worlds, named.reason) == ("holds", 6, "1 shorter left out")
    extinct = [dataclasses.replace(world, extinct_step=10) for world in worlds[:3]]
    gone = judge(claim(sure, "mean", low=0.0), "c", extinct)
    assert (gone.verdict, gone.worlds) == ("undecided", 0)
    assert "3 extinct left out" in gone.reason


def test_wide_and_hardly_are_judged_against_neutral_genes(worlds: list[WorldRecord]) -> None:
    """The values are scores, of standard deviation 1 for neutral genes, so the units of a gene do not matter."""
    scores = np.random.default_rng(1).normal(size=12)
    wide, hardly = claim(list(2 * scores), "spread", low=1 / 1.5), claim(list(0.3 * scores), "distance", high=1.5)
    assert judge(wide, "c", worlds).verdict == "holds"
    assert judge(claim(list(0.2 * scores), "spread", low=1 / 1.5), "c", worlds).verdict == "fails"
    found = judge(hardly, "c", worlds)
    assert (found.verdict, found.value) == ("holds", pytest.approx(0.3 * math.sqrt(np.mean(scores**2))))
    assert found.reason.startswith("recorded neutral genes: ")  # of the same worlds
    assert judge(claim(list(4 * scores), "distance", high=1.5), "c", worlds).verdict == "fails"


def test_verdicts_on_drifting_weights_are_right(worlds: list[WorldRecord]) -> None:
    """How often each verdict comes up if a weight drifts as far as neutral genes do, three times as far or a third."""
    rng, trials = np.random.default_rng(2), 400
    held, wide, wrong = 0, 0, 0
    for _ in range(trials):
        scores = rng.normal(size=10)
        held += place(*distance_interval(scores / 3)[1:], -math.inf, SAME_FACTOR) == "holds"
        wide += place(*spread_interval(3 * scores)[1:], 1 / SAME_FACTOR, math.inf) == "holds"
        wrong += place(*distance_interval(scores)[1:], -math.inf, SAME_FACTOR) == "fails"
    assert held == wide == trials
    assert wrong / trials < 0.01


def test_recorded_neutral_genes_that_do_not_drift_as_walks_do_decide_nothing(
    worlds: list[WorldRecord], monkeypatch: pytest.MonkeyPatch
) -> None:
    strange = [WorldDrift("neutral_1", 0.0, 0.0, -1, 0, 1, 3.0, 0.01)]
    monkeypatch.setattr("hedon.study.estimate.standard_drift", lambda *_: strange)
    found = judge(claim([0.1] * 12, "distance", high=1.5), "c", worlds)
    assert (found.verdict, found.reason.endswith("which differ from the walks")) == ("undecided", True)


@pytest.mark.parametrize(
    ("shift", "scale", "least"), [(0.0, 1.0, 0.0), (1.0, 1.0, 0.8), (0.0, 0.3, 0.95), (0.0, 3.0, 0.95)]
)
def test_a_random_walk_is_distinguished_from_selection(
    worlds: list[WorldRecord], shift: float, scale: float, least: float
) -> None:
    """Ten worlds: size under drift, and power if scores are shifted by 1, narrowed to 0.3 or widened to 3."""
    rng, trials = np.random.default_rng(3), 300
    rule = claim([0.0] * 12, "walk")
    found = [estimate(rule, shift + scale * rng.normal(size=10), worlds[:10]).verdict for _ in range(trials)]
    share = found.count("holds") / trials
    assert share >= least
    if (shift, scale) == (0.0, 1.0):
        assert share <= 0.05 + 3 * math.sqrt(0.05 * 0.95 / trials)


def test_conditions_are_compared(worlds: list[WorldRecord]) -> None:
    first, second = ([dataclasses.replace(w, condition=name) for w in worlds[:6]] for name in ("one", "two"))
    figures = {"one": [10.0, 11.0, 9.0, 10.5, 9.5, 10.0], "two": [30.0, 33.0, 27.0, 31.0, 29.0, 30.0]}

    def measure(world: WorldRecord) -> float:
        return figures[world.condition][world.seed - 1]

    def rule(comparison: Comparison, **region: Any) -> Order:
        pair = Condition("small", "small"), Condition("large", "large")
        return Order("a", *pair, "text", measure, comparison, "0", **dict[str, Any]({"steps": 0} | region))

    longer = judge_order(rule("ratio", low=2.0), second, first)
    assert (longer.verdict, longer.condition, longer.worlds) == ("holds", "two against one", 12)
    assert longer.value == pytest.approx(3.0, rel=0.01)
    assert judge_order(rule("ratio", low=2.0), first, second).verdict == "fails"
    assert judge_order(rule("difference", high=0.0), first, second).verdict == "holds"
    assert judge_order(rule("spread", high=1.0), first, second).verdict == "undecided"
    assert judge_order(rule("difference", high=0.0), first[:2], second).reason.startswith("fewer than 6 worlds")
    late = dataclasses.replace(rule("difference", high=0.0), steps=10**6)
    assert "one: the worlds reach 5,120 of 1,000,000 steps" in judge_order(late, first, second).reason


def test_only_conditions_of_equal_fidelity_are_compared(worlds: list[WorldRecord]) -> None:
    def of(preset: str, fidelity: str) -> list[WorldRecord]:
        config = load_config(preset, fidelity)
        return [dataclasses.replace(w, config=config, condition=f"{preset} {fidelity}") for w in worlds[:3]]

    every = [*of("baseline", "corrected"), *of("large", "released"), *of("large", "corrected")]
    found = verdicts(every, ORDERS)
    assert [(v.claim, v.condition) for v in found] == [
        ("action weight lower", "large corrected against baseline corrected")
    ]


def test_claims_are_judged_only_under_their_own_settings(worlds: list[WorldRecord]) -> None:
    found = verdicts(worlds, EVERY)
    names = {v.claim for v in found}
    assert {"food weight positive", "two modes of action", "mean lifetime", "extinction"} <= names
    assert "action weight negative" not in names
    assert sum(v.claim == "extinction" for v in found) == 1  # at the baseline's own costs
    assert {v.claim: v.verdict for v in found if v.verdict != "undecided"} == {"lifespan": "holds"}  # only 5 windows
    changed = dataclasses.replace(worlds[0].config.food["normal"], growth_rate=0.3)
    config = dataclasses.replace(worlds[0].config, food={"normal": changed})
    assert verdicts([dataclasses.replace(world, config=config) for world in worlds], EVERY) == []
    config = worlds[0].config.with_("energy.basic_cost", 0.002)
    dying = [dataclasses.replace(world, config=config, extinct_step=5120) for world in worlds]
    extinction = verdicts(dying, EVERY)
    assert [(v.claim, v.reported, v.verdict) for v in extinction] == [("extinction", "90 %", "holds")]


def test_the_lifespan_follows_from_the_hazard() -> None:
    """Gompertz's law alone: exp(−α/β·(exp(β·t) − 1)) = 0.05 at t = ln(1 − β/α·ln 0.05)/β."""
    (rule,) = [c for c in CLAIMS if c.name == "lifespan"]
    hazard = load_config("baseline").species["agent"].hazard
    expected = math.log(1 - hazard.beta_age / hazard.alpha_age * math.log(0.05)) / hazard.beta_age
    world = SimpleNamespace(species_config=load_config("baseline").species["agent"])
    assert rule.measure(world) == pytest.approx(expected, rel=1e-6)  # pyright: ignore[reportArgumentType]
    assert 1.0e6 < expected < 1.1e6


def test_claims_that_the_paper_makes_have_a_rule() -> None:
    of = {
        preset: {c.name for c in CLAIMS if c.condition.preset == preset} for preset in ("large", "poison", "baseline")
    }
    assert "food weight positive" in of["large"]
    assert "food weight above 4" not in of["large"]  # the paper says "consistently positive" there
    assert {"poison weight positive", "poison weight below food"} <= of["poison"]
    assert {"food weight no random walk", "action weight no random walk", "lifespan"} <= of["baseline"]
    assert {(o.name, o.first.preset, o.second.preset) for o in ORDERS} >= {
        ("action weight lower", "large", "baseline"),
        ("longer lifetime", "small", "centered"),
        ("longer lifetime", "centered", "baseline"),
        ("longer lifetime", "centered", "large"),
        ("food weight stable", "small", "baseline"),
        ("action weight stable", "small", "large"),
    }
    assert all(o.low < o.high for o in ORDERS)


def test_the_claims_are_those_of_the_paper() -> None:
    assert len({(c.name, c.condition) for c in CLAIMS}) == len(CLAIMS)
    assert {c.condition.preset for c in CLAIMS} == {
        "baseline",
        "small",
        "large",
        "centered",
        "relocation",
        "poor",
        "poison",
    }
    assert all(c.low < c.high for c in CLAIMS)
