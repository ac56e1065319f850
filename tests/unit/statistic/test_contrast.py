import numpy as np
import pytest
from scipy import stats

from hedon.statistic.contrast import difference_interval, fisher_mid_p, spread_ratio_interval
from hedon.statistic.interval import distance_interval, share_interval, spread_interval


def rejections(n: int, m: int) -> np.ndarray:
    return np.array([[fisher_mid_p(a, n, b, m) <= 0.05 for b in range(m + 1)] for a in range(n + 1)])


def chance(rejected: np.ndarray, share: float, other: float) -> float:
    n, m = (size - 1 for size in rejected.shape)
    return float(stats.binom.pmf(np.arange(n + 1), n, share) @ rejected @ stats.binom.pmf(np.arange(m + 1), m, other))


def test_mid_p_is_fishers_p_minus_half_the_probability_of_equally_likely_tables() -> None:
    for a, n, b, m in ((3, 10, 9, 10), (0, 5, 5, 5), (5, 5, 5, 10), (7, 12, 2, 6)):
        _, full = stats.fisher_exact([[a, n - a], [b, m - b]])
        chances = stats.hypergeom.pmf(np.arange(n + 1), n + m, a + b, n)
        same = chances[np.isclose(chances, chances[a])].sum()
        assert fisher_mid_p(a, n, b, m) == pytest.approx(full - 0.5 * same)
        assert fisher_mid_p(a, n, b, m) == pytest.approx(fisher_mid_p(b, m, a, n))


@pytest.mark.parametrize(("n", "m"), [(5, 10), (10, 10), (20, 10), (20, 5)])
def test_two_equal_shares_are_called_different_no_more_often_than_promised(n: int, m: int) -> None:
    """Exact, over all tables. At some shares the mid-p test slightly exceeds 5 %: 5.5 % at most for n up to 40."""
    rejected = rejections(n, m)
    size = [chance(rejected, share, share) for share in np.linspace(0.01, 0.99, 50)]
    assert max(size) < 0.055
    assert np.mean(size) > 0.025


def test_the_power_to_differ_from_the_paper() -> None:
    assert chance(rejections(10, 10), 0.2, 0.8) == pytest.approx(0.81, abs=0.01)
    assert chance(rejections(5, 5), 0.2, 0.8) == pytest.approx(0.38, abs=0.01)  # five against five have little power
    assert chance(rejections(20, 5), 0.1, 0.9) > 0.95


@pytest.mark.parametrize("of", [5, 10, 20])
def test_jeffreys_interval_covers_on_average(of: int) -> None:
    bounds = np.array([share_interval(count, of) for count in range(of + 1)])
    shares = np.linspace(0.005, 0.995, 199)
    cover = [
        stats.binom.pmf(np.arange(of + 1), of, share)[(bounds[:, 0] <= share) & (share <= bounds[:, 1])].sum()
        for share in shares
    ]
    assert np.mean(cover) == pytest.approx(0.95, abs=0.01)
    assert min(cover) > 0.86


def test_five_of_five_are_most_and_four_of_five_are_not() -> None:
    assert share_interval(5, 5) == (pytest.approx(stats.beta.ppf(0.025, 5.5, 0.5)), 1.0)
    assert share_interval(5, 5)[0] > 0.6
    assert share_interval(4, 5)[0] < 0.5
    assert share_interval(0, 5)[0] == 0.0
    # A share of one half passes for a majority by chance in 3.1 % of cases with five worlds, in 1.1 % with ten.
    for of, size in ((5, 0.031), (10, 0.011)):
        counts = [k for k in range(of + 1) if share_interval(k, of)[0] > 0.5]
        assert stats.binom.pmf(counts, of, 0.5).sum() == pytest.approx(size, abs=0.001)


@pytest.mark.parametrize("unequal", [1.0, 3.0])
def test_the_intervals_of_comparisons_cover(unequal: float) -> None:
    rng, trials, hits = np.random.default_rng(1), 800, np.zeros(2)
    for _ in range(trials):
        a, b = rng.normal(1.0, unequal, 5), rng.normal(0.0, 1.0, 8)
        value, low, high = difference_interval(a, b)
        assert low < value < high
        hits[0] += low <= 1.0 <= high
        ratio, low, high = spread_ratio_interval(a, b)
        assert low < ratio < high
        hits[1] += low <= unequal <= high
    np.testing.assert_allclose(hits / trials, 0.95, atol=0.02 + 3 * np.sqrt(0.05 * 0.95 / trials))


def test_a_group_that_does_not_vary_has_no_ratio_of_spreads() -> None:
    assert np.isnan(spread_ratio_interval(np.arange(3.0), np.ones(3))).all()


def test_the_intervals_of_a_spread_and_of_a_distance_cover() -> None:
    rng, trials, hits = np.random.default_rng(1), 800, np.zeros(2)
    for _ in range(trials):
        values = rng.normal(0, 2, 6)
        for i, interval in enumerate((spread_interval, distance_interval)):
            value, low, high = interval(values)
            assert low < value < high
            hits[i] += low <= 2 <= high
    np.testing.assert_allclose(hits / trials, 0.95, atol=3 * np.sqrt(0.05 * 0.95 / trials))
