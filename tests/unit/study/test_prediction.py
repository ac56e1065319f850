import numpy as np
import pytest

from hedon_studies.kanagawa_doya_2024.analysis.prediction import prediction


def test_the_interval_of_the_slope_covers_as_often_as_promised() -> None:
    rng = np.random.default_rng(8)
    covered = 0
    for _ in range(1000):
        x = rng.normal(size=8)
        found = prediction(x, 0.7 * x + rng.normal(size=8))
        covered += found["low"] <= 0.7 <= found["high"]
    assert covered / 1000 == pytest.approx(0.95, abs=0.025)


def test_predictions_by_hand() -> None:
    found = prediction([1.0, 2.0, -1.0, np.nan], [2.0, 4.0, -2.0, 5.0])
    assert (found["pairs"], found["same_sign"], found["p_sign"]) == (3, 3, 0.25)
    assert (found["correlation"], found["rank_correlation"]) == pytest.approx((1.0, 1.0))
    assert (found["slope"], found["low"], found["high"]) == pytest.approx((2.0, 2.0, 2.0))
    few = prediction([1.0, -1.0], [1.0, 1.0])
    assert (few["pairs"], few["same_sign"], few["p_sign"]) == (2, 1, 1.0)
    assert np.isnan(few["slope"])
    assert np.isnan(prediction([], [])["p_sign"])
