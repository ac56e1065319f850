import numpy as np
import pytest
from scipy import stats

from hedon.statistic.drift import rank_score, sign_flip_p


def test_rank_scores_are_normal() -> None:
    null = np.arange(1999.0)
    assert rank_score(999.0, null) == pytest.approx(0.0, abs=1e-9)
    assert rank_score(1e9, null) == pytest.approx(stats.norm.ppf(1999.5 / 2000))
    assert rank_score(-1e9, null) == pytest.approx(-rank_score(1e9, null))


def test_sign_flips() -> None:
    rng = np.random.default_rng(1)
    assert sign_flip_p(np.array([1.0, 2.0, 3.0]), rng) == 2 / 8
    assert sign_flip_p(np.array([1.0, -2.0, 3.0]), rng) == 6 / 8  # all but the two sums of 0
    many = sign_flip_p(rng.normal(1.0, 1.0, 30), rng)
    assert many < 0.001
