"""Generalized advantage estimation against its definition, a double sum."""

from __future__ import annotations

import numpy as np
import pytest
from learning_case import config

from hedon import _engine


@pytest.mark.parametrize(("gamma", "lam"), [(0.999, 0.95), (0.9, 0.5), (1.0, 1.0), (0.99, 0.0)])
def test_gae_is_the_discounted_sum_of_deltas(gamma: float, lam: float):
    rng = np.random.default_rng(0)
    reward, value = rng.normal(size=(2, 200)).astype(np.float32)
    advantage, target = _engine.learning.gae(config(gamma=gamma, gae_lambda=lam), reward, value, 0.7)
    delta = reward + gamma * np.append(value[1:], 0.7).astype(np.float64) - value
    expected = [sum((gamma * lam) ** (k - t) * delta[k] for k in range(t, 200)) for t in range(200)]
    np.testing.assert_allclose(advantage, expected, rtol=1e-4, atol=1e-4)
    np.testing.assert_allclose(target, advantage + value, rtol=1e-6, atol=1e-6)


def test_lambda_one_gives_the_return():
    reward = np.array([1.0, 2.0, 3.0], np.float32)
    value = np.array([0.5, -1.0, 4.0], np.float32)
    _, target = _engine.learning.gae(config(gamma=0.5, gae_lambda=1.0), reward, value, 10.0)
    np.testing.assert_allclose(target, [1 + 0.5 * (2 + 0.5 * (3 + 0.5 * 10)), 2 + 0.5 * (3 + 5), 8], rtol=1e-6)


def test_lengths_are_checked():
    with pytest.raises(ValueError, match="value: length 2, expected 3"):
        _engine.learning.gae(config(), np.zeros(3, np.float32), np.zeros(2, np.float32), 0.0)


def test_scaled_rewards_have_deviation_one_and_normalized_advantages_too():
    rng = np.random.default_rng(1)
    reward, value = (rng.normal(3.0, 0.05, size=200).astype(np.float32), rng.normal(size=200).astype(np.float32))
    plain = _engine.learning.gae(config(), reward, value, 0.7)
    scaled = _engine.learning.gae(config(reward_scaling="window"), reward, value, 0.7)
    expected = _engine.learning.gae(config(), (reward / reward.std()).astype(np.float32), value, 0.7)
    np.testing.assert_allclose(scaled, expected, rtol=1e-5, atol=1e-4)
    advantage, target = _engine.learning.gae(config(advantage_normalization="window"), reward, value, 0.7)
    np.testing.assert_allclose(advantage, (plain[0] - plain[0].mean()) / plain[0].std(), rtol=1e-4, atol=1e-5)
    np.testing.assert_array_equal(target, plain[1])


@pytest.mark.parametrize("paid", [0.0, 2.0])
def test_equal_rewards_are_not_scaled_and_equal_advantages_become_0(paid: float):
    reward, value = np.full(8, paid, np.float32), np.zeros(8, np.float32)
    both = config(gamma=0.0, reward_scaling="window", advantage_normalization="window")
    advantage, target = _engine.learning.gae(both, reward, value, 0.0)
    np.testing.assert_array_equal(advantage, np.zeros(8, np.float32))
    np.testing.assert_array_equal(target, reward)
