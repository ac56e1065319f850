import numpy as np
import pytest
from scipy import stats

from hedon.statistic.survival import exposure_mean, restricted_mean, survival_curve

# Remission times of the 6-MP group of Freireich et al. (1963), a textbook example.
DIED = [6, 6, 6, 7, 10, 13, 16, 22, 23]
CENSORED = [6, 9, 10, 11, 17, 19, 20, 25, 32, 32, 34, 35]
DURATION = np.array(DIED + CENSORED, np.float64)
EVENT = np.array([True] * len(DIED) + [False] * len(CENSORED))


def test_the_textbook_example() -> None:
    curve = survival_curve(DURATION, EVENT)
    assert curve.age.tolist() == [6, 7, 10, 13, 16, 22, 23]
    assert curve.at_risk.tolist() == [21, 17, 15, 12, 11, 7, 6]
    assert curve.deaths.tolist() == [3, 1, 1, 1, 1, 1, 1]
    np.testing.assert_allclose(curve.share, [0.857, 0.807, 0.753, 0.690, 0.628, 0.538, 0.448], atol=1e-3)
    assert curve.quantile()[0] == 23


def test_greenwood_on_the_log_log_scale() -> None:
    curve = survival_curve(DURATION, EVENT)
    d, n = curve.deaths[:3], curve.at_risk[:3]
    share = np.prod(1 - d / n)
    error = np.sqrt(np.sum(d / (n * (n - d)))) / abs(np.log(share))
    for bound, sign in ((curve.low, 1), (curve.high, -1)):
        assert bound[2] == pytest.approx(share ** np.exp(sign * 1.959964 * error), rel=1e-6)


@pytest.mark.filterwarnings("ignore:The confidence interval is undefined")  # where no agent is left
@pytest.mark.parametrize("shown", [1.0, 0.6, 0.1])
def test_curve_and_interval_match_scipy(shown: float) -> None:
    rng = np.random.default_rng(3)
    duration, died = rng.integers(1, 60, 300).astype(np.float64), rng.uniform(size=300) < shown
    curve = survival_curve(duration, died, 0.9)
    fitted = stats.ecdf(stats.CensoredData(uncensored=duration[died], right=duration[~died])).sf
    whole = curve.at_risk > curve.deaths
    bounds = fitted.confidence_interval(0.9, method="log-log")
    at = np.searchsorted(fitted.quantiles, curve.age)
    assert np.isnan(curve.low[~whole]).all()
    assert np.isnan(curve.high[~whole]).all()
    for ours, theirs in ((curve.share, fitted), (curve.low, bounds.low), (curve.high, bounds.high)):
        np.testing.assert_allclose(ours[whole], theirs.probabilities[at][whole], rtol=1e-12)


def test_without_censoring_it_is_the_empirical_distribution() -> None:
    lives = np.array([1.0, 2.0, 2.0, 5.0])
    curve = survival_curve(lives, np.ones(4, bool))
    assert curve.share.tolist() == pytest.approx([0.75, 0.25, 0.0])
    assert restricted_mean(curve, 5.0).mean == pytest.approx(lives.mean())
    # Greenwood's variance of the area is then the plain one: Σ(x − x̄)²/n².
    assert restricted_mean(curve, 5.0).error == pytest.approx(lives.std() / 2)
    assert restricted_mean(curve, 2.0).mean == pytest.approx(np.minimum(lives, 2).mean())


def test_the_mean_of_the_dead_is_too_small_where_the_restricted_mean_is_right() -> None:
    """Exponential lifetimes with mean 1 that start at different times and are cut at the end of the record."""
    rng = np.random.default_rng(1)
    until, hits, dead = 1.5, 0, []
    truth = 1 - np.exp(-until)
    for _ in range(300):
        life, room = rng.exponential(1.0, 400), rng.uniform(0, 3.0, 400)
        died = life <= room
        duration = np.minimum(life, room)
        area = restricted_mean(survival_curve(duration, died), until)
        hits += abs(area.mean - truth) < 1.96 * area.error
        dead.append(np.minimum(life[died], until).mean())
        assert exposure_mean(duration, died) == pytest.approx(1.0, abs=0.35)
    assert np.mean(dead) < truth - 0.1
    assert 0.92 <= hits / 300 <= 0.98  # 95 %, ± 2.4 standard errors of the count


def test_the_intervals_of_the_curve_cover() -> None:
    rng = np.random.default_rng(2)
    hits = 0
    for _ in range(300):
        life, room = rng.exponential(1.0, 200), rng.uniform(0.2, 3.0, 200)
        curve = survival_curve(np.minimum(life, room), life <= room)
        at = np.searchsorted(curve.age, 1.0) - 1
        hits += curve.low[at] <= np.exp(-1.0) <= curve.high[at]
    assert 0.92 <= hits / 300 <= 0.98


def test_no_deaths() -> None:
    curve = survival_curve(np.array([3.0, 4.0]), np.zeros(2, bool))
    assert len(curve.age) == 0
    assert curve.trusted_age() == 0
    assert curve.quantile() == (None, None, None)
    assert exposure_mean(np.array([3.0]), np.zeros(1, bool)) is None
