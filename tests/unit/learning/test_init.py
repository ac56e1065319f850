"""A fresh network: ranges, distribution, the orthogonal head, independence of agents."""

from __future__ import annotations

import numpy as np
import pytest
from learning_case import ONE_KIND_RAW, SHAPES

from hedon import _engine

learning = _engine.learning


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES.keys())
def test_ranges_and_distribution(shape: tuple[int, int, int, int]):
    rays, types, touches, dense = shape
    inputs = rays * types + touches + dense
    params = np.stack([learning.init_network(shape, seed) for seed in range(20)])
    assert params.shape[1] == learning.param_count(shape) == inputs * 64 + 64 + 64 * 64 + 64 + 192 + 16
    first = params[:, : inputs * 64 + 64] * np.sqrt(inputs)
    at = inputs * 64 + 64
    later = np.concatenate([params[:, at : at + 65 * 64], params[:, -16 - 64 : -16], params[:, -16:-13]], axis=1) * 8.0
    for values in (first.ravel(), later.ravel()):
        assert np.abs(values).max() <= 1.0
        assert np.abs(values).max() > 0.999
        # Uniform: the Kolmogorov-Smirnov distance at the 0.1 % level.
        ranks = (np.arange(values.size) + 0.5) / values.size
        assert np.abs((np.sort(values) + 1) / 2 - ranks).max() < 1.95 / np.sqrt(values.size)
    assert (params[:, -13:] == 0).all()


def test_mean_head_is_orthogonal_with_gain():
    for seed in range(50):
        head = learning.init_network(ONE_KIND_RAW, seed)[-16 - 192 : -16 - 64].reshape(2, 64).astype(np.float64)
        np.testing.assert_allclose(head @ head.T, 1e-4 * np.eye(2), atol=1e-10)


def test_directions_of_the_mean_head_are_uniform():
    heads = np.stack([learning.init_network(ONE_KIND_RAW, s)[-208:-80].reshape(2, 64) for s in range(300)]) * 100
    assert np.abs(heads.mean(0)).max() < 5 / np.sqrt(64 * 300)
    assert heads.var() == pytest.approx(1 / 64, rel=1e-3)


def test_every_agent_has_its_own_reproducible_network():
    one = learning.init_network(ONE_KIND_RAW, 1, 2, 3)
    np.testing.assert_array_equal(one, learning.init_network(ONE_KIND_RAW, 1, 2, 3))
    others = [(0, 2, 3), (1, 0, 3), (1, 2, 0)]
    for other in others:
        assert (one[:-13] != learning.init_network(ONE_KIND_RAW, *other)[:-13]).mean() > 0.99


def test_pack_and_unpack():
    ray = np.array([[1.25, 0.0, 2.0]], np.float32)
    ray_type = np.array([[1, 0, 0]], np.uint8)
    dense = np.arange(5, dtype=np.float32)[None]
    packed = learning.pack(ray, ray_type, np.array([0b1001], np.uint64), dense)
    full = learning.unpack((3, 2, 4, 5), packed)
    np.testing.assert_allclose(full, [[-1, -1, 1, 0.25, -1, -1, 1, 0, 0, 1, 0, 1, 2, 3, 4]])


def test_wrong_arguments_are_named():
    with pytest.raises(ValueError, match="rays must be 0 to 32"):
        learning.init_network((33, 3, 18, 5), 0)
    with pytest.raises(ValueError, match="unknown name 'none'"):
        learning.forward("none", ONE_KIND_RAW, learning.init_network(ONE_KIND_RAW, 0), np.zeros((1, 192), np.uint8))
