"""Generalized advantage estimation against its definition, a double sum."""

from __future__ import annotations

import numpy as np
import pytest

from hedon import _engine


@pytest.mark.parametrize(("gamma", "lam"), [(0.999, 0.95), (0.9, 0.5), (1.0, 1.0), (0.99, 0.0)])
def test_gae_is_the_discounted_sum_of_deltas(gamma: float, lam: float):
    rng = np.random.default_rng(0)
    reward, value = rng.normal(size=(2, 200)).astype(np.float32)
    advantage, target = _engine.learning.gae(reward, value, 0.7, gamma, lam)
    delta = reward + gamma * np.append(value[1:], 0.7).astype(np.float64) - value
    expected = [sum((gamma * lam) ** (k - t) * delta[k] for k in range(t, 200)) for t in range(200)]
    np.testing.assert_allclose(advantage, expected, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(target, advantage + value, rtol=1e-6, atol=1e-6)


def test_lambda_one_gives_the_return():
    reward = np.array([1.0, 2.0, 3.0], np.float32)
    value = np.array([0.5, -1.0, 4.0], np.float32)
    _, target = _engine.learning.gae(reward, value, 10.0, 0.5, 1.0)
    np.testing.assert_allclose(target, [1 + 0.5 * (2 + 0.5 * (3 + 0.5 * 10)), 2 + 0.5 * (3 + 5), 8], rtol=1e-6)


def test_lengths_are_checked():
    with pytest.raises(ValueError, match="value: length 2, expected 3"):
        _engine.learning.gae(np.zeros(3, np.float32), np.zeros(2, np.float32), 0.0, 0.9, 0.9)
