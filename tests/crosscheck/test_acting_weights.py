"""Acting with 16-bit weights: how they are rounded, that the engine reads them, and how far they shift actions."""

import numpy as np
import ppo_reference as reference
import pytest
from acting_weights import AFTER_W2, HIDDEN, as_read, pair, unpair
from learning_case import KERNELS, ONE_KIND_RAW, SHAPES, random_case
from worlds import QUICK, make_simulation

from hedon import _engine

learning = _engine.learning


def both_ways(numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All pairs of numbers, as arrays of their first and second members."""
    first, second = np.meshgrid(numbers, numbers)
    return first.ravel(), second.ravel()


def cases() -> tuple[np.ndarray, np.ndarray]:
    """Pairs at rounding boundaries, and random pairs over 60 powers of ten."""
    upper = np.array([0x3F80, 0x3F81, 0x3FFF, 0x4000, 0x0080, 0x7F00], np.uint32)[:, None] << 16
    border = (upper + np.array([0, 1, 0x7FFF, 0x8000, 0x8001, 0xFFFF], np.uint32)).ravel().view(np.float32)
    rng = np.random.default_rng(1)
    spread = rng.choice([-1, 1], 20_000) * 10.0 ** rng.uniform(-30, 30, 20_000)
    random = spread.astype(np.float32).reshape(2, -1)
    first, second = both_ways(np.concatenate([border, -border]))
    return np.concatenate([first, random[0]]), np.concatenate([second, random[1]])


def test_pairs_are_bit_for_bit_the_nearest():
    first, second = cases()
    np.testing.assert_array_equal(learning.pair_weights(first, second).view(np.uint32), pair(first, second).view("u4"))


def test_both_of_a_pair_are_off_by_at_most_1_in_256():
    given = cases()
    for read, wanted in zip(unpair(learning.pair_weights(*given)), given, strict=True):
        assert np.abs(read / wanted.astype(np.float64) - 1).max() <= 2**-8


def test_pairs_with_zero_infinity_or_nan():
    zero, one, inf = (np.array([x], np.float32) for x in (0, 1, np.inf))
    first, second = unpair(learning.pair_weights(zero, one))
    assert 0 <= first[0] < 1e-40
    assert second[0] == 1
    assert unpair(learning.pair_weights(one, zero))[1][0] == 0
    for bad in (inf, -inf):
        assert not np.isfinite(unpair(learning.pair_weights(one, bad))[1][0])
        assert not np.abs(unpair(learning.pair_weights(bad, one))[0][0]) < 3e38
    for bits in (0x7FC00000, 0xFFC00000, 0x7FFFFFFF, 0xFFFFFFFF, 0x7F800001):
        bad = np.array([bits], np.uint32).view(np.float32)
        for words in (learning.pair_weights(bad, one), learning.pair_weights(one, bad)):
            assert np.isnan(unpair(words)).all()


@pytest.mark.parametrize("kernel", KERNELS)
def test_forward_reads_the_rounded_weights(kernel: str):
    for shape in SHAPES.values():
        case = random_case(10, shape, 100)
        rounded = as_read(case.params)
        output = learning.forward(kernel, shape, case.params, case.observation, rounded=True)
        expected = reference.forward(rounded.astype(np.float64), case.full())[2]
        np.testing.assert_allclose(output, expected, rtol=1e-5, atol=3e-6)
        # Only the weights are rounded: with weights rounded beforehand, it is the float32 forward pass.
        np.testing.assert_array_equal(output, learning.forward(kernel, shape, rounded, case.observation))


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_nan_weight_propagates(kernel: str):
    case = random_case(8, ONE_KIND_RAW, 64)
    for at in (0, 16, len(case.params) - AFTER_W2 - 1, len(case.params) - AFTER_W2 - 17):
        params = case.params.copy()
        params[at] = np.nan
        output = learning.forward(kernel, ONE_KIND_RAW, params, case.observation, rounded=True)
        assert np.isnan(output).any()


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_world_acts_with_its_own_rounded_weights(kernel: str):
    simulation = make_simulation(*QUICK, "birth.kappa=0.01", backend=kernel)
    world = simulation.worlds[0]
    simulation.run(200)  # learners, newborns, and slots that were used before
    assert world.counters["births"] > 5
    params = world.view("params")[world.living]
    count = params.shape[1] - AFTER_W2
    read = as_read(params)[:, :count].reshape(len(params), -1, 2, 16)
    words = world.view("packed_weights")[world.living].reshape(len(params), -1, 16)
    matrices = np.ones(len(read[0]), bool)
    matrices[(count - HIDDEN * (HIDDEN + 1)) // 32 :][:2] = False  # the first bias is not read from here
    for got, wanted in zip(unpair(words), (read[:, :, 0], read[:, :, 1]), strict=True):
        np.testing.assert_array_equal(got[:, matrices], wanted[:, matrices])
    rows = as_read(params).astype(np.float64)[:, : 24 * 3 * HIDDEN].reshape(len(params), -1, HIDDEN)
    b1 = params[:, count - HIDDEN * (HIDDEN + 1) :][:, :HIDDEN]
    np.testing.assert_allclose(world.view("folded_bias")[world.living], b1 - rows.sum(axis=1), rtol=0, atol=1e-5)


def test_float32_reads_the_parameters_themselves():
    simulation = make_simulation(*QUICK, 'learning.acting_weights="float32"')
    assert simulation.worlds[0].view("packed_weights").size == 0
    assert simulation.engine.bytes_per_world < make_simulation(*QUICK).engine.bytes_per_world


def test_actions_move_by_far_less_than_their_noise():
    simulation = make_simulation(*QUICK, "food.normal.gene.initial_mean=1", *("hazard.kappa=0", "hazard.alpha_age=0"))
    world = simulation.worlds[0]
    simulation.run(20 * 64)
    moved = []
    for slot in world.living[:20]:
        params, seen = world.view("params")[slot], np.ascontiguousarray(world.view("observation")[slot, :64])
        one, other = (learning.forward("", ONE_KIND_RAW, params, seen, rounded=r) for r in (True, False))
        moved.append(one - other)
    error = np.sqrt(np.mean(np.square(moved), axis=(0, 1)))
    log_sd = world.view("params")[world.living][:, -13:-11]
    assert (error > 1e-6).all()
    assert (error < 2e-3).all()
    assert np.exp(log_sd).min() > 0.8
