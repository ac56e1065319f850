"""The kernels' loss, gradient and update against plain NumPy in float64."""

from __future__ import annotations

import numpy as np
import ppo_reference as reference
import pytest
from learning_case import KERNELS, ONE_KIND_RAW, SHAPES, SMALL, Case, config, random_case

from hedon import _engine

learning = _engine.learning


def doubles(case: Case) -> tuple[np.ndarray, ...]:
    return tuple(a.astype(np.float64) for a in (case.action, case.log_prob, case.advantage, case.target))


def test_reference_gradient_is_the_slope_of_its_loss():
    for target in ("per_state", "batch_mean"):
        case = random_case(1, SMALL, 32)
        settings = config(critic_target=target, entropy_coef=0.02, value_coef=0.7)
        x, sample, params = case.full(), doubles(case), case.params.astype(np.float64)
        slope = reference.gradient(params, x, sample, settings)
        rng = np.random.default_rng(0)
        chosen = [*rng.choice(len(params) - 16, 60, replace=False), *range(len(params) - 16, len(params))]
        for i in chosen:
            step = np.zeros_like(params)
            step[i] = 1e-5
            up = reference.loss(params + step, x, sample, settings)
            down = reference.loss(params - step, x, sample, settings)
            assert (up - down) / 2e-5 == pytest.approx(slope[i], rel=1e-5, abs=1e-8)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize("target", ["per_state", "batch_mean"])
def test_gradient_and_losses(kernel: str, shape: tuple[int, int, int, int], target: str):
    case = random_case(2, shape, 300)
    settings = config(critic_target=target, entropy_coef=0.02, value_coef=0.7)
    order = np.random.default_rng(3).permutation(300)[:256].astype(np.int32)
    slope, seen = learning.gradient(kernel, shape, settings, case.params, *case.batch(), order)
    sample = tuple(values[order] for values in doubles(case))
    params = case.params.astype(np.float64)
    expected = reference.gradient(params, case.full()[order], sample, settings)
    assert np.abs(expected).max() > 0.05
    np.testing.assert_allclose(slope, expected, rtol=2e-4, atol=2e-6)
    np.testing.assert_allclose(
        seen, reference.losses(params, case.full()[order], sample, settings), rtol=1e-5, atol=1e-6
    )


@pytest.mark.parametrize("kernel", KERNELS)
def test_gradient_is_the_slope_of_the_loss(kernel: str):
    case = random_case(4, ONE_KIND_RAW, 128)
    order = np.arange(128, dtype=np.int32)
    slope, _ = learning.gradient(kernel, ONE_KIND_RAW, config(), case.params, *case.batch(), order)
    x, sample, params = case.full(), doubles(case), case.params.astype(np.float64)
    rng = np.random.default_rng(5)
    for _ in range(20):
        direction = rng.normal(size=len(params))
        up = reference.loss(params + 1e-6 * direction, x, sample, config())
        down = reference.loss(params - 1e-6 * direction, x, sample, config())
        assert (up - down) / 2e-6 == pytest.approx(direction @ slope, rel=1e-3, abs=1e-4)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("size", [1, 7, 16, 63, 65, 100])
def test_any_minibatch_size(kernel: str, size: int):
    case = random_case(6, ONE_KIND_RAW, 128)
    order = np.random.default_rng(7).permutation(128)[:size].astype(np.int32)
    slope, seen = learning.gradient(kernel, ONE_KIND_RAW, config(), case.params, *case.batch(), order)
    sample = tuple(values[order] for values in doubles(case))
    params = case.params.astype(np.float64)
    expected = reference.gradient(params, case.full()[order], sample, config())
    np.testing.assert_allclose(slope, expected, rtol=5e-4, atol=1e-5)
    np.testing.assert_allclose(
        seen, reference.losses(params, case.full()[order], sample, config()), rtol=1e-5, atol=1e-6
    )


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("target", ["per_state", "batch_mean"])
def test_update_of_ten_epochs(kernel: str, target: str):
    case = random_case(8, ONE_KIND_RAW, 512)
    settings = config(critic_target=target, minibatch_size=128)
    rng = np.random.default_rng(9)
    order = np.stack([rng.permutation(512) for _ in range(10)]).astype(np.int32)
    zero = np.zeros_like(case.params)
    params, m, v, updates, seen = learning.update(
        kernel, ONE_KIND_RAW, settings, case.params, zero, zero, 0, *case.batch(), order
    )
    expected, losses = reference.update(case.params.astype(np.float64), case.full(), doubles(case), order, settings)
    assert updates == 40
    moved = np.abs(expected - case.params)
    assert moved.max() > 2e-3
    # An Adam step near a gradient of 0 may change its sign, so single parameters differ by more.
    assert np.abs(params - expected).mean() < 1e-3 * moved.mean()
    assert np.abs(params - expected).max() < 0.05 * moved.max()
    np.testing.assert_allclose(seen, losses, rtol=1e-4, atol=1e-5)
    assert np.isfinite(m).all()
    assert (v >= 0).all()
    assert (params[-11:] == 0).all()


@pytest.mark.parametrize("kernel", KERNELS)
def test_forward(kernel: str):
    for shape in SHAPES.values():
        case = random_case(10, shape, 100)
        expected = reference.forward(case.params.astype(np.float64), case.full())[2]
        output = learning.forward(kernel, shape, case.params, case.observation)
        np.testing.assert_allclose(output, expected, rtol=1e-5, atol=3e-6)


@pytest.mark.parametrize("kernel", KERNELS)
def test_forward_of_saturated_units(kernel: str):
    case = random_case(11, ONE_KIND_RAW, 50)
    params = case.params * np.float32(300.0)
    expected = reference.forward(params.astype(np.float64), case.full())[2]
    output = learning.forward(kernel, ONE_KIND_RAW, params, case.observation)
    # Sums in the thousands carry float32 rounding into the few units that are not saturated.
    np.testing.assert_allclose(output, expected, rtol=1e-4, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize("kernel", KERNELS)
def test_learn_is_gae_then_update_with_the_streams_minibatches_sorted_by_time(kernel: str):
    case = random_case(12, SMALL, 64)
    settings = config(minibatch_size=16)
    value, reward = case.target, case.advantage
    zero = np.zeros_like(case.params)
    got = learning.learn(
        kernel, SMALL, settings, case.params, zero, zero, 5, case.observation, case.action, case.log_prob,
        value, reward, 0.3, 42, 7, 1024,
    )  # fmt: skip
    advantage, target = learning.gae(settings, reward, value, 0.3)
    order = np.sort(learning.permutation(42, 7, 1024, 64, 10).reshape(10, 4, 16)).reshape(10, 64)
    expected = learning.update(
        kernel, SMALL, settings, case.params, zero, zero, 5, case.observation, case.action, case.log_prob,
        advantage, target, order,
    )  # fmt: skip
    for one, other in zip(got[:3], expected[:3], strict=True):
        np.testing.assert_array_equal(one, other)
    assert got[3:] == expected[3:]


def test_permutations_are_permutations_and_uniform():
    order = learning.permutation(1, 2, 3, 50, 400)
    assert (np.sort(order, axis=1) == np.arange(50)).all()
    assert len(np.unique(order, axis=0)) == 400
    # Each number is in each place about equally often: Poisson with mean 8; chi-square over 50 x 50 cells.
    counts = np.stack([np.bincount(order[:, place], minlength=50) for place in range(50)])
    chi_square = ((counts - 8.0) ** 2 / 8.0).sum()
    assert abs(chi_square - 49 * 49) < 5 * np.sqrt(2 * 49 * 49)
    assert (learning.permutation(1, 3, 3, 50, 1) != order[:1]).any()
