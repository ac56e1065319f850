"""The floor: the least possible time of a step on a machine with known rates."""

from dataclasses import dataclass

from hedon.config.config import Config
from hedon.config.schema.species import ONLY

HIDDEN = 64
"""Units of each hidden layer."""
OUTPUTS = 3
"""Two means and a value."""
FLOAT_BYTES = 4
WEIGHT_BYTES = {"float32": 4, "bfloat16": 2}
"""Bytes of a weight of the hidden layers, by `learning.acting_weights`."""


@dataclass(frozen=True, slots=True)
class Floor:
    """Least possible times of one step of one world, all threads together [s]."""

    learning_seconds: float
    forward_seconds: float

    @property
    def seconds(self) -> float:
        """The sum of both."""
        return self.learning_seconds + self.forward_seconds


def network_flop(config: Config) -> tuple[int, int]:
    """Operations of the products for one sample, forward and backward, two per weight.

    Forward, the weights are a row of 64 per ray and per dense entry (the sparse first layer; touch is mostly 0),
    64 × 64, and three heads. Backward, the gradients of the same weights take the same number, and 64 × 64 and the
    heads count again for the gradients of the units. With the baseline 12,288 and 20,864: 33 kflop.
    """
    sensor = config.species[ONLY].sensor
    rows = sensor.ray_count + (5 if sensor.scaling == "raw" else 6)
    square_and_heads = HIDDEN * HIDDEN + OUTPUTS * HIDDEN
    forward = 2 * (rows * HIDDEN + square_and_heads)
    return forward, forward + 2 * square_and_heads


def step_floor(
    config: Config, alive: float, learners: float, multiply_add_gflops: float, cache_read_gbytes_per_s: float
) -> Floor:
    """The least possible time of a step, from the work of the networks and the rates of the machine.

    Learning: each learner of a window uses its rollout `update_epochs` times, in minibatches: with the baseline 40
    updates of 256 samples, with 33 kflop per sample (see `network_flop`). The work of a window is divided by its steps.

    Forward: each agent acts with its own weights, which do not stay in the cache of a core: the same rows and 64 × 64
    in the precision of `learning.acting_weights`, the folded bias and the heads with all biases in float32; 13 kB with
    24 rays and bfloat16. The reads or the operations count, whichever take longer.

    Not counted, so with a floor of 0: elementwise functions, Adam, sampling, rays, touch, physics, life, food, and
    barriers of threads.

    Args:
        config: Sizes of networks and windows.
        alive: Agents that act in the step.
        learners: Agents that learn at the end of a window.
        multiply_add_gflops: Rate of all threads that work on the world [1e9/s].
        cache_read_gbytes_per_s: Rate of the same threads, from the last-level cache [1e9 byte/s].
    """
    forward_flop, backward_flop = network_flop(config)
    samples = learners * config.species[ONLY].learning.update_epochs * config.world.rollout_steps
    learning_flop_per_step = samples * (forward_flop + backward_flop) / config.world.rollout_steps

    heads = OUTPUTS * HIDDEN
    biases = HIDDEN + HIDDEN + OUTPUTS
    hidden_bytes = WEIGHT_BYTES[config.species[ONLY].learning.acting_weights] * (forward_flop // 2 - heads)
    reading = alive * (hidden_bytes + FLOAT_BYTES * (heads + biases)) / (cache_read_gbytes_per_s * 1e9)
    computing = alive * forward_flop / (multiply_add_gflops * 1e9)
    return Floor(learning_flop_per_step / (multiply_add_gflops * 1e9), max(reading, computing))
