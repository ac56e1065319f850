"""Every kernel compared with the portable one, and AVX2 with AVX-512 bit by bit."""

from __future__ import annotations

import numpy as np
import pytest
from learning_case import KERNELS, ONE_KIND_RAW, SHAPES, Case, config, observations, random_case

from hedon import _engine

learning = _engine.learning
OTHERS = [name for name in KERNELS if name != "portable"]
Sizes = tuple[int, int, int, int]


def gradient(kernel: str, case: Case, **changes: object) -> tuple[np.ndarray, tuple[float, float, float]]:
    order = np.arange(len(case.observation), dtype=np.int32)
    return learning.gradient(kernel, case.shape, config(**changes), case.params, *case.batch(), order)


def edge_cases(shape: Sizes) -> dict[str, Case]:
    """Rollouts with extreme observations, weights and probabilities."""
    rays, types, touches, dense = shape
    count = 80
    one = np.ones((count, rays), np.float32)
    zero_types = np.zeros((count, rays), np.uint8)
    none = np.zeros(count, np.uint64)
    flat = np.zeros((count, dense), np.float32)
    seen = {
        "nothing seen": learning.pack(0 * one, zero_types, none, flat),
        "all at the skin": learning.pack(2 * one, zero_types + np.uint8(types - 1), none, flat),
        "touched all over": learning.pack(0 * one, zero_types, none + np.uint64(2**touches - 1), flat),
        "large numbers": observations(np.random.default_rng(1), shape, count, 1e4),
    }
    cases = {}
    for name, observation in seen.items():
        cases[name] = random_case(2, shape, count)
        cases[name].observation = observation
    cases["saturated"] = random_case(3, shape, count)
    cases["saturated"].params[:-208] *= 1000
    cases["all clipped"] = random_case(4, shape, count)
    cases["all clipped"].log_prob -= 5 * np.sign(cases["all clipped"].advantage)
    return cases


@pytest.mark.parametrize("kernel", OTHERS)
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_agreement_with_portable(kernel: str, shape: Sizes):
    for name, case in edge_cases(shape).items():
        slope, seen = gradient(kernel, case)
        expected, expected_seen = gradient("portable", case)
        assert np.isfinite(slope).all(), name
        np.testing.assert_allclose(seen, expected_seen, rtol=1e-4, atol=1e-5, err_msg=name)
        scale = max(np.abs(expected).max(), 1e-3)
        np.testing.assert_allclose(slope, expected, rtol=2e-3, atol=2e-5 * scale, err_msg=name)
        for rounded in (False, True):
            output = learning.forward(kernel, shape, case.params, case.observation, rounded)
            expected_output = learning.forward("portable", shape, case.params, case.observation, rounded)
            np.testing.assert_allclose(output, expected_output, rtol=1e-4, atol=1e-4, err_msg=name)


@pytest.mark.skipif("avx512" not in KERNELS, reason="this processor has no AVX-512")
@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize("target", ["per_state", "batch_mean"])
def test_avx2_and_avx512_give_the_same_bits(shape: Sizes, target: str):
    for case in [random_case(5, shape, 205), *edge_cases(shape).values()]:
        one, other = (gradient(kernel, case, critic_target=target) for kernel in ("avx2", "avx512"))
        np.testing.assert_array_equal(one[0].view(np.uint32), other[0].view(np.uint32))
        assert one[1] == other[1]
        for rounded in (False, True):
            outputs = [learning.forward(k, shape, case.params, case.observation, rounded) for k in ("avx2", "avx512")]
            np.testing.assert_array_equal(outputs[0].view(np.uint32), outputs[1].view(np.uint32))
    case = random_case(6, shape, 256)
    rng = np.random.default_rng(7)
    order = np.stack([rng.permutation(256) for _ in range(4)]).astype(np.int32)
    zero = np.zeros_like(case.params)
    settings = config(minibatch_size=64, update_epochs=4, critic_target=target)
    results = [
        learning.update(k, shape, settings, case.params, zero, zero, 0, *case.batch(), order)
        for k in ("avx2", "avx512")
    ]
    for one, other in zip(results[0][:3], results[1][:3], strict=True):
        np.testing.assert_array_equal(one.view(np.uint32), other.view(np.uint32))
    assert results[0][3:] == results[1][3:]


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("place", ["params", "dense", "ray", "advantage", "action", "log_prob", "target"])
def test_nan_propagates_and_nothing_hangs(kernel: str, place: str):
    case = random_case(8, ONE_KIND_RAW, 64)
    if place == "params":
        case.params[70 * 64] = np.nan
    elif place in ("dense", "ray"):
        at = 168 if place == "dense" else 0
        case.observation[5, at : at + 4] = np.frombuffer(np.float32(np.nan).tobytes(), np.uint8)
    else:
        getattr(case, place).flat[5] = np.nan
    slope, seen = gradient(kernel, case)
    assert np.isnan(slope).any()
    assert np.isnan(seen).any()
    zero = np.zeros_like(case.params)
    order = np.tile(np.arange(64, dtype=np.int32), (2, 1))
    settings = config(minibatch_size=32, update_epochs=2)
    params = learning.update(kernel, ONE_KIND_RAW, settings, case.params, zero, zero, 0, *case.batch(), order)[0]
    assert np.isnan(params).any()


@pytest.mark.parametrize("kernel", KERNELS)
def test_forward_gives_the_value_that_the_gradient_uses(kernel: str):
    case = random_case(9, ONE_KIND_RAW, 64)
    value = learning.forward(kernel, ONE_KIND_RAW, case.params, case.observation)[:, 2]
    case.target = value.copy()
    slope, seen = gradient(kernel, case)
    assert seen[1] == 0.0
    assert slope[-14] == 0.0


def test_names_and_unknown_names():
    assert KERNELS[-1] == "portable"
    assert set(KERNELS) <= {"avx512", "avx2", "portable"}
    with pytest.raises(ValueError, match="unknown name 'sse'"):
        learning.forward("sse", ONE_KIND_RAW, learning.init_network(ONE_KIND_RAW, 0), np.zeros((1, 192), np.uint8))
