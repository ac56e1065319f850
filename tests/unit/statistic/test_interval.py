import math

import pytest

from hedon.statistic.interval import mean_interval


def test_interval_over_worlds() -> None:
    interval = mean_interval([1.0, 2.0, 3.0, None, math.nan])
    assert (interval.mean, interval.worlds) == (2.0, 3)
    assert interval.high == pytest.approx(2 + 4.302652729749464 / math.sqrt(3))  # t(0.975; 2), from a table
    assert interval.low == pytest.approx(2 - 4.302652729749464 / math.sqrt(3))
    assert mean_interval([5.0]).low is None
    assert mean_interval([]).mean is None
