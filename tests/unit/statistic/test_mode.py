import numpy as np
import pytest
from scipy.optimize import linprog

from hedon.statistic.minimum import FOR_VERDICT
from hedon.statistic.mode import LEVEL, dip, modes


def dip_by_programming(x: np.ndarray) -> float:
    """By definition: the least distance to a distribution that is convex up to a data point and concave after it."""
    points, first, counts = np.unique(x, return_index=True, return_counts=True)
    jumps = np.stack([first, first + counts], axis=1) / len(x)
    return min(_distance(points, jumps, mode) for mode in range(len(points)))


def _distance(x: np.ndarray, jumps: np.ndarray, mode: int) -> float:
    # Unknowns: the curve just before and at each point, and the distance.
    n = len(x)
    rows, bounds, equal = [], [], []

    def unknown(*terms: tuple[int, float]) -> np.ndarray:
        row = np.zeros(2 * n + 1)
        for index, factor in terms:
            row[index] += factor
        return row

    def slope(i: int) -> list[tuple[int, float]]:
        width = x[i + 1] - x[i]
        return [(n + i, -1 / width), (i + 1, 1 / width)]  # from the value at i to that just before i + 1

    for i in range(n):
        for index, level in zip((i, n + i), jumps[i], strict=True):
            rows += [unknown((index, 1), (2 * n, -1)), unknown((index, -1), (2 * n, -1))]
            bounds += [level, -level]
        if i == mode:
            rows.append(unknown((i, 1), (n + i, -1)))
            bounds.append(0.0)
        else:
            equal.append(unknown((i, 1), (n + i, -1)))
    for i in range(n - 1):
        rows.append(-unknown(*slope(i)))
        bounds.append(0.0)
        if i < n - 2 and i + 1 != mode:
            bend = unknown(*slope(i)) - unknown(*slope(i + 1))
            rows.append(bend if i + 1 < mode else -bend)
            bounds.append(0.0)
    cost = unknown((2 * n, 1))
    fixed = {"A_eq": np.array(equal), "b_eq": np.zeros(len(equal))} if equal else {}
    return linprog(cost, A_ub=np.array(rows), b_ub=bounds, bounds=(None, None), **fixed).fun


def test_the_dip_is_the_distance_to_the_nearest_distribution_with_one_mode() -> None:
    rng = np.random.default_rng(1)
    for trial in range(40):
        n = int(rng.integers(3, 13))
        x = rng.normal(size=n) + (trial % 3) * 2.0 * (rng.random(n) < 0.5)
        x = np.sort(np.round(x) if trial % 4 == 0 else x)  # sometimes with equal values
        assert dip(x) == pytest.approx(dip_by_programming(x), abs=1e-8)


def test_known_dips() -> None:
    assert dip(np.arange(10.0)) == pytest.approx(1 / 20)  # evenly spread: the smallest possible dip
    assert dip(np.array([0.0] * 5 + [1.0] * 5)) == pytest.approx(0.25)
    tight = np.concatenate([np.linspace(0, 1e-9, 50), 1 + np.linspace(0, 1e-9, 50)])
    assert dip(tight) == pytest.approx(0.25, abs=0.01)
    assert dip(np.full(3, 2.0)) == pytest.approx(1 / 6)  # a single point has one mode
    assert dip(np.array([0.0, 0, 0, 1, 2, 2])) == pytest.approx(1 / 6)  # by hand


@pytest.mark.parametrize("draw", ["normal", "uniform", "exponential"])
@pytest.mark.parametrize("count", [5, 10, 30])
def test_one_mode_is_called_two_no_more_often_than_promised(draw: str, count: int) -> None:
    rng = np.random.default_rng(2)
    wrong = sum(modes(getattr(rng, draw)(size=count)).answer == "two" for _ in range(400))
    assert wrong / 400 <= LEVEL + 3 * np.sqrt(LEVEL * (1 - LEVEL) / 400)


def test_two_modes_are_found_and_counted() -> None:
    rng = np.random.default_rng(3)
    found = modes(np.concatenate([rng.normal(5, 0.2, 6), rng.normal(-1, 0.2, 14)]))
    assert (found.answer, found.low_worlds, found.high_worlds) == ("two", 14, 6)
    assert found.low == pytest.approx(-1, abs=0.5)
    assert found.high == pytest.approx(5, abs=0.5)
    assert found.p < 0.01


def test_power_allows_for_the_chance_in_how_worlds_split() -> None:
    """Thirty worlds find two clear modes four times out of five; ten find them about a third of the time."""
    values = np.random.default_rng(5).normal(size=FOR_VERDICT)
    power = {count: modes(values[:count]).power for count in (5, 10, FOR_VERDICT)}
    assert power[5] < 0.2
    assert power[10] == pytest.approx(0.35, abs=0.1)
    assert power[FOR_VERDICT] >= 0.8
    rng = np.random.default_rng(6)
    drawn = (rng.normal(size=FOR_VERDICT) + 6 * (rng.random(FOR_VERDICT) < 0.5) for _ in range(200))
    found = sum(modes(values).answer == "two" for values in drawn) / 200
    assert found == pytest.approx(power[FOR_VERDICT], abs=0.1)


def test_finding_no_second_mode_decides_nothing() -> None:
    rng = np.random.default_rng(4)
    assert [modes(rng.normal(size=n)).answer for n in (0, 3, 5, 40)] == ["undecided"] * 4
    assert modes(np.full(20, 2.0)).answer == "undecided"
