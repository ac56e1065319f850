"""The network's kernels on one thread: acting (`forward`) and one learner's PPO (`update`)."""

import numpy as np

from benchmarks.check import require, require_finite
from benchmarks.floor import network_flop
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, interleave, median, spread
from benchmarks.plan import Plan
from benchmarks.scene import peopled
from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_config
from hedon.config.layout import layouts, observation_columns
from hedon.config.schema.species import ONLY

FORWARD_ROWS = 10_240
"""Observations in one timed call, enough that the cost of the call itself does not matter."""


def shape(config: Config) -> tuple[int, int, int, int]:
    """Rays, types, touch bits and dense entries of an observation."""
    name, layout = next(iter(layouts(config).items()))
    sensor = config.species[name].sensor
    rays, types = sensor.ray_count, len(layout.sees)
    touches = len(layout.touches) * sensor.touch_sectors
    return rays, types, touches, len(observation_columns(config, name)) - rays * types - touches


def measure_forward(plan: Plan, _: Calibration) -> list[Row]:
    """One row per instruction set: the oldest agent's network on its own observations, in the caches of a core."""
    config, world = plan.config(), peopled(plan)
    slot = world.living[0]
    params = world.view("params")[slot]
    seen = world.view("observation")[slot, : config.world.rollout_steps]
    observation = np.ascontiguousarray(np.resize(seen, (FORWARD_ROWS // (16 if plan.quick else 1), seen.shape[1])))

    def act(kernel: str) -> np.ndarray:
        rounded = config.species[ONLY].learning.acting_weights == "bfloat16"
        return _engine.learning.forward(kernel, shape(config), params, observation, rounded)

    for kernel in plan.kernels:
        output = act(kernel)
        require_finite(f"forward, {kernel}", output)
        require(np.ptp(output[:, 0]) > 0, f"forward, {kernel}: all actions are equal")
    times = interleave({kernel: lambda k=kernel: act(k) for kernel in plan.kernels}, plan.repeats)
    flop = network_flop(config)[0]
    return [
        {"kernel": k, "threads": 1, "flop": flop, "forward_seconds": [t / len(observation) for t in times[k]]}
        for k in plan.kernels
    ]


def measure_update(plan: Plan, _: Calibration) -> list[Row]:
    """One row per instruction set: the oldest agent learns from its last rollout."""
    config, times = plan.config(), update_seconds(plan)
    flop = sum(network_flop(config)) * config.species[ONLY].learning.update_epochs * config.world.rollout_steps
    return [{"kernel": k, "threads": 1, "flop": flop, "update_seconds": times[k]} for k in plan.kernels]


def update_seconds(plan: Plan) -> dict[str, list[float]]:
    """Times of one learner's updates with each instruction set, in turns [s]."""
    config, world = plan.config(), peopled(plan)
    steps = config.world.rollout_steps
    slot = world.living[0]
    settings = engine_config(config)["species"][0]["learning"]
    names = ("params", "first_moment", "second_moment", "log_prob", "value", "reward")
    arrays = {name: world.view(name)[slot] for name in names}
    arrays["observation"] = world.view("observation")[slot, :steps]
    arrays["action"] = world.view("action")[slot].reshape(steps, 2)

    def learn(kernel: str) -> np.ndarray:
        return _engine.learning.learn(
            kernel,
            shape(config),
            settings,
            updates=int(world.view("updates")[slot]),
            bootstrap=float(arrays["value"][-1]),
            seed=world.seed,
            agent_id=0,
            step=steps,
            **arrays,
        )[0]

    for kernel in plan.kernels:
        params = learn(kernel)
        require_finite(f"update, {kernel}", params)
        require(not np.array_equal(params, arrays["params"]), f"update, {kernel}: no parameter changed")
    return interleave({kernel: lambda k=kernel: learn(k) for kernel in plan.kernels}, plan.repeats)


def table_forward(rows: list[Row], calibration: Calibration) -> Table:
    """Microseconds per observation."""
    title = "forward: one agent's network, one observation, in the caches of a core"
    return _table(title, "forward [us]", rows, calibration, 1e6, "forward_seconds")


def table_update(rows: list[Row], calibration: Calibration) -> Table:
    """Milliseconds per learner."""
    title = "update: PPO of one learner for one window"
    return _table(title, "update [ms]", rows, calibration, 1e3, "update_seconds")


def _table(title: str, heading: str, rows: list[Row], calibration: Calibration, factor: float, name: str) -> Table:
    lines = []
    for row in rows:
        rate = row["flop"] / median(row[name]) * 1e-9
        peak = calibration.multiply_add_gflops[row["kernel"]][1]
        lines.append((row["kernel"], spread(row[name], 3, factor), f"{rate:.1f}", f"{peak:.1f}", f"{rate / peak:.1%}"))
    return Table(title, ("kernel", heading, "GF/s", "peak GF/s", "of peak"), lines)
