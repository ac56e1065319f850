"""Times the kernels on one thread, beside the rate of multiply-adds that the processor reaches in registers.

Run `uv run python benchmarks/kernel.py`. Each time is the best of several; compare them only within one run.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from learning_case import KERNELS, ONE_KIND_RAW, config, random_case

from hedon import _engine

STEPS = 1024
EPOCHS = 10
FLOP_PER_SAMPLE = 33e3
"""Multiplications and additions that one sample needs, forward and backward, with the sparse first layer."""
RAY_REPEATS = 2000
TYPE_CHANGES = 0.006
"""Chance per step that a ray hits another type than before, as in worlds of the baseline."""


def best_time(body: Callable[[], object], repeats: int) -> float:
    """The shortest time of `body` [s]."""
    times = []
    for _ in range(repeats):
        before = time.perf_counter()
        body()
        times.append(time.perf_counter() - before)
    return min(times)


def slow_types(rng: np.random.Generator, steps: int) -> np.ndarray:
    """Packed observations of rays that all hit something, and the same type for long."""
    rays, types, touches, dense = ONE_KIND_RAW
    stretch = (rng.random((steps, rays)) < TYPE_CHANGES).cumsum(0)
    ray_type = np.take_along_axis(rng.integers(0, types, (steps + 1, rays)), stretch, 0).astype(np.uint8)
    ray = rng.uniform(1, 2, (steps, rays)).astype(np.float32)
    touch = rng.integers(0, 2**touches, steps, dtype=np.uint64) & rng.integers(0, 2**touches, steps, dtype=np.uint64)
    touch &= rng.integers(0, 2**touches, steps, dtype=np.uint64)
    return _engine.learning.pack(ray, ray_type, touch, rng.normal(size=(steps, dense)).astype(np.float32))


def time_update(kernel: str) -> float:
    """One learner's whole update, its minibatches in the order of time [s]."""
    case = random_case(0, ONE_KIND_RAW, STEPS)
    rng = np.random.default_rng(1)
    case.observation = slow_types(rng, STEPS)
    minibatches = (EPOCHS, STEPS // config()["minibatch_size"], -1)
    order = np.stack([rng.permutation(STEPS) for _ in range(EPOCHS)]).astype(np.int32)
    order = np.sort(order.reshape(minibatches), axis=2).reshape(EPOCHS, STEPS)
    zero = np.zeros_like(case.params)

    def body() -> tuple:
        return _engine.learning.update(kernel, ONE_KIND_RAW, config(), case.params, zero, zero, 0, *case.batch(), order)

    params = body()[0]
    if not np.isfinite(params).all() or (params == case.params).all():
        raise RuntimeError(f"{kernel}: the update left parameters unchanged or not finite")
    return best_time(body, 15)


def time_forward(kernel: str) -> float:
    """One forward pass with the network in the cache [s]."""
    case = random_case(0, ONE_KIND_RAW, 10 * STEPS)

    def body() -> np.ndarray:
        return _engine.learning.forward(kernel, ONE_KIND_RAW, case.params, case.observation)

    if not np.isfinite(body()).all():
        raise RuntimeError(f"{kernel}: the outputs are not finite")
    return best_time(body, 15) / (10 * STEPS)


def time_rays(kernel: str) -> float:
    """The 24 rays of one agent among 70 circles and 12 segments, none of them culled [s]."""
    rng = np.random.default_rng(2)
    circles = np.column_stack([rng.uniform(-200, 200, (70, 2)), rng.choice([4.0, 10.0], 70)]).astype(np.float32)
    kind = rng.integers(0, 2, 70).astype(np.int32)
    segments = rng.uniform(-200, 200, (12, 4)).astype(np.float32)
    angle = np.linspace(-np.pi / 3, np.pi / 3, 24)
    direction = np.stack([-np.sin(angle), np.cos(angle)], 1).astype(np.float32)

    def body() -> tuple[np.ndarray, np.ndarray]:
        return _engine.kernel.cast_rays(kernel, circles, kind, segments, 2, direction, 10.0, 200.0, RAY_REPEATS)

    reading, _ = body()
    if not ((reading == 0) | ((reading >= 1) & (reading <= 2))).all() or (reading == 0).all():
        raise RuntimeError(f"{kernel}: readings out of range, or no hit")
    return best_time(body, 15) / RAY_REPEATS


def main() -> None:
    """Prints one line per kernel."""
    print("kernel    peak [GF/s]  update [ms]  [GF/s]  of peak  forward [us]  rays [us]")
    for kernel in KERNELS:
        peak = max(_engine.kernel.calibrate(kernel, 1_000_000) for _ in range(9))
        update = time_update(kernel)
        rate = FLOP_PER_SAMPLE * STEPS * EPOCHS / update * 1e-9
        print(
            f"{kernel:9} {peak:11.1f}  {update * 1e3:11.3f} {rate:7.1f}  {rate / peak:6.1%}"
            f"  {time_forward(kernel) * 1e6:12.3f} {time_rays(kernel) * 1e6:10.3f}"
        )


if __name__ == "__main__":
    main()
