"""Intervals of quantities that cannot be negative or cannot exceed one."""

import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hedon.analysis.result import over_worlds
from hedon.statistic.interval import AMOUNT, ANY, SHARE, mean_interval

shares = st.lists(st.sampled_from([0.0, 0.01, 0.4, 0.99, 1.0]), min_size=5, max_size=12)


@given(shares)
def test_an_interval_is_clipped_to_possible_values(values):
    free, cut = mean_interval(values), mean_interval(values, within=SHARE)
    assert (cut.mean, cut.worlds) == (free.mean, free.worlds)
    assert free.low is not None
    assert free.high is not None
    assert (cut.low, cut.high) == (max(free.low, 0.0), min(free.high, 1.0))
    assert max(free.low, 0.0) <= (cut.mean or 0.0) <= min(free.high, 1.0)


def test_a_table_limits_the_possible_values_by_column():
    rows = pl.DataFrame(
        {"condition": ["one"] * 5, "energy": [0.1, 0.2, 0.1, 0.3, 9.0], "weight": [0.0, 0.0, 0.0, 0.0, 9.0]}
    )
    energy, weight = over_worlds(rows, (), {"energy": "energy", "weight": "weight"}, {"energy": AMOUNT})
    assert energy["low"] == 0.0
    assert weight["low"] < 0.0
    assert over_worlds(rows, (), {"weight": "weight"}, ANY)[0]["low"] == pytest.approx(weight["low"])
