import numpy as np
import pytest

from hedon.statistic.reversion import reversion

TIMES = 61


def pulled(rng: np.random.Generator, count: int, rate: float, optimum: float = 0.0) -> np.ndarray:
    """Courses from 0 with heavy-tailed steps (Student's t, three degrees of freedom), shape (count, TIMES)."""
    courses = np.zeros((count, TIMES))
    for i, shock in enumerate(rng.standard_t(3, (TIMES - 1, count))):
        courses[:, i + 1] = courses[:, i] + (1 - np.exp(-rate)) * (optimum - courses[:, i]) + shock
    return courses


def answers(rate: float, optimum: float, worlds: int, trials: int) -> np.ndarray:
    """p, strength with bounds and optimum with bounds of many sets of worlds, shape (7, trials)."""
    rng, found = np.random.default_rng(1), []
    for _ in range(trials):
        neutral = [pulled(rng, 150, 0.0) for _ in range(worlds)]
        one = reversion(list(pulled(rng, worlds, rate, optimum)), neutral)
        assert one is not None
        found.append(
            (one.p, one.strength, one.strength_low, one.strength_high, one.optimum, one.optimum_low, one.optimum_high)
        )
    return np.array(found).T


def covered(low: np.ndarray, value: float, high: np.ndarray) -> float:
    return float(np.mean((low <= value) & (value <= high)))


@pytest.mark.parametrize("worlds", [1, 5])
def test_brownian_motion_is_called_held_no_more_often_than_promised(worlds: int) -> None:
    p, strength, low, high, optimum, *_ = answers(0.0, 0.0, worlds, 120 // worlds)
    assert np.mean(p <= 0.05) <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / len(p))
    assert covered(low, 0.0, high) >= 0.95 - 3 * np.sqrt(0.05 * 0.95 / len(p))
    assert np.median(strength) < 0.01  # not biased by about 4 / 60, as the plain estimate is
    assert np.isnan(optimum[p > 0.05]).all()


def test_a_pull_is_found_with_its_strength_and_optimum() -> None:
    """Five worlds of 60 intervals, each of which closes a tenth of the distance: the power is nearly 1."""
    trials = 30
    p, strength, low, high, optimum, optimum_low, optimum_high = answers(0.1, 5.0, 5, trials)
    assert np.mean(p <= 0.05) > 0.9
    assert np.median(strength) == pytest.approx(0.1, rel=0.25)
    assert np.median(optimum) == pytest.approx(5.0, abs=1.0)
    least = 0.95 - 3 * np.sqrt(0.05 * 0.95 / trials)
    assert covered(low, 0.1, high) >= least
    assert covered(optimum_low, 5.0, optimum_high) >= least


def test_strength_and_p_do_not_depend_on_units() -> None:
    rng = np.random.default_rng(2)
    courses, neutral = pulled(rng, 3, 0.2, 2.0), [pulled(rng, 150, 0.0) for _ in range(3)]
    one, other = reversion(list(courses), neutral), reversion(list(10 * courses + 3), neutral)
    assert one is not None
    assert other is not None
    assert (other.p, other.strength) == (one.p, pytest.approx(one.strength))
    assert (other.optimum, other.optimum_high) == pytest.approx((10 * one.optimum + 3, 10 * one.optimum_high + 3))


def test_courses_without_a_change_give_no_answer() -> None:
    assert reversion([np.zeros(20), np.array([0.0, 1.0])], [np.zeros((9, 20)), np.zeros((9, 2))]) is None
    assert reversion([], []) is None
    late = np.concatenate([np.zeros(19), [1.0]])  # there was nothing to be pulled back from
    assert reversion([late], [np.zeros((9, 20))]) is None
    found = reversion([np.arange(20.0) % 3], [np.stack([late] * 8 + [np.arange(20.0) % 2])])
    assert found is not None
    assert found.p == pytest.approx(2 / 10)  # one neutral gene reverts more clearly; those that do not move do not


def test_a_course_that_is_unlike_drift_but_not_pulled_has_no_optimum():
    """If steps shrink, the test against drift may reject although the best-fitting strength is 0."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        time = np.linspace(0, 1, int(rng.integers(8, 60)))
        shocks = np.cumsum(rng.standard_t(2, size=len(time)) * np.exp(-3 * time)) * 0.02
        course = shocks + rng.random() * (1 - np.exp(-6 * time * rng.random()))
        found = reversion([course], [np.cumsum(rng.standard_t(2, (300, len(time))), axis=1)])
        assert found is not None
        given = found.p <= 0.05 and found.strength > 0
        assert np.isfinite([found.optimum, found.optimum_low, found.optimum_high]).tolist() == [given] * 3
        assert not given or found.optimum_low <= found.optimum <= found.optimum_high
        if found.p <= 0.05 and found.strength == 0:
            return
    pytest.fail("no such course among the seeds")
