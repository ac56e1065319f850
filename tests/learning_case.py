"""Random learning cases, shared by the tests of the kernels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from hedon import _engine

KERNELS: list[str] = _engine.kernel.kernel_names()
ONE_KIND_RAW = (24, 3, 18, 5)
TWO_KINDS_UNIT = (24, 4, 24, 6)
SMALL = (3, 2, 4, 5)
SHAPES = {"one kind, raw": ONE_KIND_RAW, "two kinds, unit": TWO_KINDS_UNIT, "small": SMALL}

Shape = tuple[int, int, int, int]


def config(**changes: Any) -> dict[str, Any]:
    """The learning settings of the baseline, with changes."""
    return {
        "policy": "ppo",
        "minibatch_size": 256,
        "update_epochs": 10,
        "gamma": 0.999,
        "gae_lambda": 0.95,
        "clip_coef": 0.2,
        "learning_rate": 3e-4,
        "adam_beta1": 0.9,
        "adam_beta2": 0.999,
        "adam_epsilon": 1e-7,
        "value_coef": 1.0,
        "entropy_coef": 0.001,
        "critic_target": "per_state",
        "acting_weights": "bfloat16",
        "reward_scaling": "none",
        "advantage_normalization": "none",
    } | changes


@dataclass
class Case:
    """A network and a rollout of `count` steps."""

    shape: Shape
    params: np.ndarray
    observation: np.ndarray
    action: np.ndarray
    log_prob: np.ndarray
    advantage: np.ndarray
    target: np.ndarray

    def batch(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The arguments that `gradient` and `update` take after the parameters."""
        return self.observation, self.action, self.log_prob, self.advantage, self.target

    def full(self) -> np.ndarray:
        """The full observations in float64."""
        return _engine.learning.unpack(self.shape, self.observation).astype(np.float64)


def observations(rng: np.random.Generator, shape: Shape, count: int, scale: float = 1.0) -> np.ndarray:
    """Packed observations in which a third of the rays hit nothing and a tenth of the sectors are touched."""
    rays, types, touches, dense = shape
    ray = 1.0 + rng.random((count, rays))
    ray_type = rng.integers(0, types, (count, rays))
    missed = rng.random((count, rays)) < 1 / 3
    ray[missed], ray_type[missed] = 0.0, 0
    bits = rng.random((count, touches)) < 0.1
    touch = np.array([sum(1 << i for i in np.flatnonzero(row)) for row in bits.tolist()], np.uint64)
    entries = scale * rng.normal(size=(count, dense))
    return _engine.learning.pack(ray.astype(np.float32), ray_type.astype(np.uint8), touch, entries.astype(np.float32))


def random_case(seed: int, shape: Shape = ONE_KIND_RAW, count: int = 256, mean_scale: float = 30.0) -> Case:
    """A fresh network with larger weights for the means, and a rollout with ratios on both sides of the clip."""
    rng = np.random.default_rng(seed)
    params = _engine.learning.init_network(shape, seed)
    w3 = _engine.learning.param_count(shape) - 16 - 3 * 64
    params[w3 : w3 + 2 * 64] *= mean_scale
    params[-13:-11] = rng.normal(scale=0.3, size=2)
    observation = observations(rng, shape, count)
    output = _engine.learning.forward("portable", shape, params, observation)
    action = output[:, :2] + rng.normal(size=(count, 2)) * np.exp(params[-13:-11])
    scaled = (action - output[:, :2]) / np.exp(params[-13:-11])
    log_prob = -0.5 * (scaled**2).sum(1) - params[-13:-11].sum() - np.log(2 * np.pi)
    log_prob += rng.normal(scale=0.2, size=count)
    single = np.float32
    return Case(
        shape,
        params,
        observation,
        action.astype(single),
        log_prob.astype(single),
        rng.normal(size=count).astype(single),
        rng.normal(loc=0.5, size=count).astype(single),
    )
