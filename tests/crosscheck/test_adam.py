"""The kernels' Adam against its published algorithm in float64."""

from __future__ import annotations

import numpy as np
import pytest
from learning_case import KERNELS, config
from ppo_reference import Adam

from hedon import _engine


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("epsilon", [1e-7, 0.1])
def test_steps_of_adam(kernel: str, epsilon: float):
    settings = config(learning_rate=0.01, adam_epsilon=epsilon)
    rng = np.random.default_rng(0)
    params = rng.normal(size=160).astype(np.float32)
    m, v, updates = np.zeros_like(params), np.zeros_like(params), 0
    expected, adam = params.astype(np.float64), Adam(settings, 160)
    for _ in range(60):
        slope = (10.0 ** rng.uniform(-6, 2, 160) * rng.normal(size=160)).astype(np.float32)
        slope[:16] = 0.0
        params, m, v, updates, _ = _engine.learning.adam(kernel, settings, slope, params, m, v, updates)
        expected = adam(expected, slope.astype(np.float64))
        np.testing.assert_allclose(params, expected, rtol=1e-5, atol=1e-5)
    assert updates == 60
    np.testing.assert_allclose(m, adam.m, rtol=1e-3, atol=1e-9)
    np.testing.assert_allclose(v, adam.v, rtol=1e-3, atol=1e-12)
    assert (m[:16] == 0).all()


@pytest.mark.parametrize("kernel", KERNELS)
def test_first_step_is_the_learning_rate_and_late_steps_need_no_correction(kernel: str):
    slope = np.full(16, 1e-3, np.float32)
    zero = np.zeros(16, np.float32)
    settings = config(learning_rate=0.25)
    params, *_ = _engine.learning.adam(kernel, settings, slope, zero, zero, zero, 0)
    np.testing.assert_allclose(params, -0.25 * 1e-3 / (1e-3 + 1e-7), rtol=1e-5)
    params, _, _, updates, _ = _engine.learning.adam(kernel, settings, slope, zero, slope, slope**2, 10**7)
    np.testing.assert_allclose(params, -0.25 * 1e-3 / (1e-3 + 1e-7), rtol=1e-5)
    assert updates == 10**7 + 1
