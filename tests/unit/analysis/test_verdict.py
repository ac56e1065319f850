import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.claim import CLAIMS, Claim, OverWorlds
from hedon.analysis.verdict import judge, place, share_interval, spread_interval, verdicts
from hedon.analysis.world import WorldRecord, read_worlds
from hedon.record.reader import open_run


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("verdict") / "run"
    return read_worlds([open_run(write_run(folder, worlds=12, intervals=5, snapshot=False))])


def claim(figures: list[float], over_worlds: OverWorlds, **region: float) -> Claim:
    """A claim whose figure of the world with seed i + 1 is figures[i]."""
    options: dict[str, Any] = {"steps": 0} | region
    return Claim("a", "baseline", "text", lambda w: figures[w.seed - 1], over_worlds, "0", **options)


def test_where_an_interval_lies() -> None:
    assert place(1, 2, 0, math.inf) == "holds"
    assert place(-2, -1, 0, math.inf) == "fails"
    assert place(-1, 1, 0, math.inf) == "undecided"
    assert place(0, 1, 0, math.inf) == "undecided"  # it includes the border
    assert place(2, 3, 0, 1) == "fails"
    assert place(math.nan, math.nan, 0, 1) == "undecided"


def test_rules(worlds: list[WorldRecord]) -> None:
    three = worlds[:3]
    assert judge(claim([1.0, 1.1, 0.9], "mean", low=0.0), "c", three).verdict == "holds"
    assert judge(claim([1.0, -1.1, 0.9], "mean", low=0.0), "c", three).verdict == "undecided"
    assert judge(claim([1.0, 1.1, 0.9], "mean", high=0.5), "c", three).verdict == "fails"
    same = judge(claim([90.0, 100.0, 110.0], "ratio", low=100 / 1.5, high=150.0), "c", three)
    assert (same.verdict, same.value) == ("holds", pytest.approx(np.exp(np.mean(np.log([90, 100, 110])))))
    wide = judge(claim([-3.0, 0.0, 3.0, -4.0, 4.0, 3.5, -3.5, 1, 2, -2], "spread", low=1.0), "c", worlds[:10])
    assert (wide.verdict, wide.value) == (
        "holds",
        pytest.approx(np.std([-3, 0, 3, -4, 4, 3.5, -3.5, 1, 2, -2], ddof=1)),
    )
    most = judge(claim([1.0] * 12, "share", low=0.5), "c", worlds)
    assert (most.verdict, most.value, most.low) == ("holds", 1.0, pytest.approx(0.025 ** (1 / 12)))
    assert judge(claim([1.0] * 4, "share", low=0.5), "c", worlds[:4]).verdict == "undecided"
    two = judge(claim([-1.0, -1.1, -0.9, -1.05, -0.95, -1.01, 5, 5.1, 4.9, 5.05, 4.95, 5.01], "modes"), "c", worlds)
    assert (two.verdict, two.reason) == ("holds", "6 worlds around -1.00, 6 around 5.00")


def test_too_few_too_short_or_extinct_worlds_decide_nothing(worlds: list[WorldRecord]) -> None:
    sure = [1.0, 1.01, 0.99]
    few = judge(claim(sure, "mean", low=0.0), "c", worlds[:2])
    assert (few.verdict, few.reason, few.worlds) == ("undecided", "fewer than 3 worlds", 2)
    short = judge(claim(sure, "mean", low=0.0, steps=10**6), "c", worlds[:3])
    assert (short.verdict, short.reason) == ("undecided", "the worlds reach 5,120 of 1,000,000 steps")
    extinct = [dataclasses.replace(world, extinct_step=10) for world in worlds[:3]]
    gone = judge(claim(sure, "mean", low=0.0), "c", extinct)
    assert (gone.verdict, gone.worlds) == ("undecided", 0)
    assert "3 extinct left out" in gone.reason
    counted = dataclasses.replace(claim(sure, "mean", low=0.0, steps=10**6), survivors=False)
    assert judge(counted, "c", extinct).verdict == "holds"


def test_claims_are_asked_of_their_own_settings_only(worlds: list[WorldRecord]) -> None:
    found = verdicts(worlds)
    names = {v.claim for v in found}
    assert {"food weight positive", "two modes of action", "mean lifetime", "extinction"} <= names
    assert "action weight negative" not in names
    assert sum(v.claim == "extinction" for v in found) == 1  # at the baseline's own costs
    assert all(v.verdict == "undecided" for v in found)  # worlds of 5 windows
    changed = dataclasses.replace(worlds[0].config.food["normal"], growth_rate=0.3)
    config = dataclasses.replace(worlds[0].config, food={"normal": changed})
    assert verdicts([dataclasses.replace(world, config=config) for world in worlds]) == []
    costly = dataclasses.replace(worlds[0].config.energy, basic_cost=0.002)
    config = dataclasses.replace(worlds[0].config, energy=costly)
    dying = [dataclasses.replace(world, config=config, extinct_step=5120) for world in worlds]
    extinction = verdicts(dying)
    assert [(v.claim, v.paper, v.verdict) for v in extinction] == [("extinction", "90 %", "holds")]


def test_the_claims_are_those_of_the_paper() -> None:
    assert len({(c.name, c.preset, c.costs) for c in CLAIMS}) == len(CLAIMS)
    assert {c.preset for c in CLAIMS} == {"baseline", "small", "large", "centered", "relocation", "poor", "poison"}
    assert all(c.low < c.high for c in CLAIMS)


def test_the_interval_of_a_share_covers_at_least_as_often_as_promised() -> None:
    for n, p in ((5, 0.5), (10, 0.9), (20, 0.1)):
        covered = sum(
            stats.binom.pmf(k, n, p) for k in range(n + 1) if share_interval(k, n)[0] <= p <= share_interval(k, n)[1]
        )
        assert covered >= 0.95
    assert share_interval(0, 10) == (0.0, pytest.approx(1 - 0.025**0.1))
    assert share_interval(10, 10) == (pytest.approx(0.025**0.1), 1.0)


def test_the_interval_of_a_spread_covers() -> None:
    rng = np.random.default_rng(1)
    hits = 0
    for _ in range(400):
        sd, low, high = spread_interval(rng.normal(0, 2, 6))
        assert low < sd < high
        hits += low <= 2 <= high
    assert 0.92 <= hits / 400 <= 0.98
