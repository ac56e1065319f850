import math

import pytest

from hedon.statistic.interval import mean_interval


def test_interval_over_worlds() -> None:
    interval = mean_interval([1.0, 2.0, 3.0, 4.0, 5.0, None, math.nan])
    assert (interval.mean, interval.worlds) == (3.0, 5)
    half = 2.7764451051977987 * math.sqrt(2.5 / 5)  # t(0.975; 4), from a table
    assert (interval.low, interval.high) == pytest.approx((3.0 - half, 3.0 + half))
    assert mean_interval([1.0, 2.0, 3.0, 4.0]).low is None, "too few worlds"
    assert mean_interval([]).mean is None
