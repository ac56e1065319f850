import math

import numpy as np
import pytest
from scipy import stats

from hedon.statistic.extinction import extinct_share, log_rank


def test_a_world_that_ends_early_is_censored() -> None:
    """By hand: one of four dies, one is censored, then one of two dies: 1 − 3/4 · 1/2."""
    found = extinct_share(np.array([1.0, 2.0, 3.0, 9.0]), np.array([True, False, True, False]), 8.0)
    assert found.share == pytest.approx(1 - 0.75 * 0.5)
    assert (found.worlds, found.extinct, found.followed, found.known_until) == (4, 2, 1, 8.0)
    later = extinct_share(np.array([1.0, 2.0, 30.0, 9.0]), np.array([True, False, True, False]), 8.0)
    assert (later.share, later.extinct, later.followed) == (0.25, 1, 2)  # it was alive at the step and died out later


def test_if_no_world_was_followed_nothing_limits_the_share_from_above() -> None:
    """14 worlds die out early and 26 are alive halfway: the share is at least about 35 %, and may be 100 %."""
    found = extinct_share(np.repeat([100.0, 500.0], [14, 26]), np.repeat([True, False], [14, 26]), 1000.0)
    assert (found.share, found.high, found.known_until) == (pytest.approx(0.35), 1.0, 500.0)
    assert 0.2 < found.low < 0.25
    assert extinct_share(np.array([]), np.array([], bool), 1.0).worlds == 0


@pytest.mark.parametrize("extinct", [0, 3, 10])
def test_without_censoring_it_is_the_mid_p_interval_of_a_share(extinct: int) -> None:
    died = np.arange(10) < extinct
    found = extinct_share(np.where(died, np.arange(1.0, 11.0), 100.0), died, 100.0)
    assert found.share == pytest.approx(extinct / 10)

    def above(share: float) -> float:  # probability of as many or more, ties counted half
        return float(stats.binom.sf(extinct, 10, share) + 0.5 * stats.binom.pmf(extinct, 10, share))

    if extinct:
        assert above(found.low) == pytest.approx(0.025, abs=1e-6)
    if extinct < 10:
        assert above(found.high) == pytest.approx(0.975, abs=1e-6)
    assert (found.low == 0, found.high == 1) == (extinct == 0, extinct == 10)


@pytest.mark.parametrize(("share", "cut"), [(0.1, 0.5), (0.5, 0.0), (0.5, 0.5), (0.9, 0.5)])
def test_the_interval_covers_with_few_worlds_and_many_censored(share: float, cut: float) -> None:
    """Ten worlds with exponential times to extinction, some of them cut at a random time before the step."""
    rng, trials = np.random.default_rng(1), 200
    hits = 0
    for _ in range(trials):
        gone = rng.exponential(-1.0 / np.log(1.0 - share), 10)
        end = np.where(rng.random(10) < cut, rng.random(10), 2.0)
        found = extinct_share(np.minimum(gone, end), gone <= end, 1.0)
        hits += found.low <= share <= found.high
    assert hits / trials > 0.95 - 3 * np.sqrt(0.05 * 0.95 / trials)


def test_the_log_rank_test_agrees_with_that_of_scipy_for_many_worlds() -> None:
    rng = np.random.default_rng(4)
    for rate in (1.0, 1.5):
        lived = [rng.exponential(1.0, 150), rng.exponential(rate, 150)]
        seen, ended = [np.minimum(each, 1.2) for each in lived], [each < 1.2 for each in lived]
        known = [stats.CensoredData(uncensored=s[e], right=s[~e]) for s, e in zip(seen, ended, strict=True)]
        first = np.repeat([True, False], 150)
        p = log_rank(np.concatenate(seen), np.concatenate(ended), first, np.zeros(300, np.int64), 4000)
        assert p == pytest.approx(stats.logrank(known[0], known[1]).pvalue, abs=0.02)


def test_the_log_rank_test_compares_within_settings() -> None:
    """Only the setting differs, and it is not spread evenly over the groups."""
    lived, first = np.repeat([10.0, 90.0], 12), np.array([True] * 10 + [False] * 2 + [True] * 2 + [False] * 10)
    ended, setting = np.ones(24, np.bool_), np.repeat([0, 1], 12)
    assert log_rank(lived, ended, first, np.zeros(24, np.int64)) < 0.01
    assert log_rank(lived, ended, first, setting) == 1.0


def test_without_deaths_or_a_second_group_there_is_no_log_rank_test() -> None:
    lived, none = np.arange(1.0, 7.0), np.zeros(6, np.int64)
    assert math.isnan(log_rank(lived, np.zeros(6, np.bool_), lived > 3, none))
    assert math.isnan(log_rank(lived, np.ones(6, np.bool_), lived > 0, none))
