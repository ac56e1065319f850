import itertools

import numpy as np
import pytest
from scipy import stats

from hedon.statistic.drift import rank_score, rank_sum_p, score_tests


def test_rank_scores_are_normal() -> None:
    null, rng = np.arange(1999.0), np.random.default_rng(1)
    assert rank_score(999.5, null, rng) == pytest.approx(0.0, abs=1e-3)
    assert rank_score(1e9, null, rng) == pytest.approx(stats.norm.ppf(1999.5 / 2000))
    assert rank_score(-1e9, null, rng) == pytest.approx(-rank_score(1e9, null, rng))


def test_a_trait_that_cannot_change_has_no_test() -> None:
    score = rank_score(0.1, np.full(100, np.float64(np.float32(0.1))), np.random.default_rng(1))
    assert np.isnan(score)
    assert all(np.isnan(test.p) and test.worlds == 0 for test in score_tests(np.full(5, score)))


def test_ranks_among_ties_are_drawn() -> None:
    """Half of the draws are tied at no change; the scores of a trait drawn from them still spread as under drift."""
    rng = np.random.default_rng(2)
    null = np.concatenate([np.zeros(500), rng.normal(size=500)])
    scores = [rank_score(float(rng.choice(null)), null, rng) for _ in range(4000)]
    assert np.std(scores) == pytest.approx(1.0, abs=0.05)
    assert stats.kstest(scores, "norm").pvalue > 1e-3


def test_rank_sums() -> None:
    every = [sum(ranks) for ranks in itertools.product(range(1, 5), repeat=3)]
    assert rank_sum_p([4, 4, 4], [4, 4, 4]) == pytest.approx(2 / 64)
    assert rank_sum_p([1, 2, 1], [4, 4, 4]) == pytest.approx(2 * np.mean(np.array(every) <= 4))
    assert rank_sum_p([2, 1], [3, 1]) == 1.0
