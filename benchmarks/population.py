"""A yardstick for updates on a device: a population of PPO learners in JAX, vmapped, of a baseline world's sizes.

`python benchmarks/population.py` needs JAX alone, and takes whatever device JAX finds. Each learner has a network of
its own (95 inputs, twice 64 tanh, mean of 2 and value) and updates it as an agent does at the end of a window:
advantages of 1,024 steps, then 10 epochs of 4 minibatches of 256, each with one step of Adam. What is not measured:
worlds, senses, acting. The observations are random; a third are 0, as where a ray meets nothing.
"""

import argparse
import json
import statistics
import time
from typing import Any

import jax
import jax.numpy as jnp

INPUTS, HIDDEN, STEPS, EPOCHS, MINIBATCH = 95, 64, 1024, 10, 256
GAMMA, LAMBDA, CLIP, VALUE_COEF, ENTROPY_COEF = 0.999, 0.95, 0.2, 0.5, 0.001
RATE, BETA1, BETA2, EPSILON = 3e-4, 0.9, 0.999, 1e-7
REPEATS = 5


def make_learner(key: jax.Array) -> dict[str, jax.Array]:
    """Parameters of one network."""
    keys = jax.random.split(key, 3)

    def layer(key: jax.Array, inputs: int, outputs: int) -> jax.Array:
        limit = inputs**-0.5
        return jax.random.uniform(key, (inputs, outputs), minval=-limit, maxval=limit)

    return {
        "w1": layer(keys[0], INPUTS, HIDDEN),
        "b1": jnp.zeros(HIDDEN),
        "w2": layer(keys[1], HIDDEN, HIDDEN),
        "b2": jnp.zeros(HIDDEN),
        "w3": layer(keys[2], HIDDEN, 3),
        "b3": jnp.zeros(3),
        "log_sd": jnp.zeros(2),
    }


def make_rollout(key: jax.Array) -> dict[str, jax.Array]:
    """A window of one learner; `observation` has one more row, to which the last reward leads."""
    keys = jax.random.split(key, 4)
    seen = jax.random.uniform(keys[0], (STEPS + 1, INPUTS))
    return {
        "observation": jnp.where(seen < 1 / 3, 0.0, seen),
        "action": jax.random.normal(keys[1], (STEPS, 2)),
        "log_prob": -2.0 - jax.random.uniform(keys[2], (STEPS,)),
        "reward": jax.random.normal(keys[3], (STEPS,)),
    }


def forward(params: dict[str, jax.Array], x: jax.Array) -> jax.Array:
    """Mean (2) and value of each row."""
    hidden = jnp.tanh(x @ params["w1"] + params["b1"])
    hidden = jnp.tanh(hidden @ params["w2"] + params["b2"])
    return hidden @ params["w3"] + params["b3"]


def advantages(rollout: dict[str, jax.Array], value: jax.Array) -> jax.Array:
    """Generalized advantages of a window without ends of episodes."""
    error = rollout["reward"] + GAMMA * value[1:] - value[:-1]

    def back(later: jax.Array, here: jax.Array) -> tuple[jax.Array, jax.Array]:
        now = here + GAMMA * LAMBDA * later
        return now, now

    return jax.lax.scan(back, jnp.float32(0.0), error, reverse=True)[1]


def loss(params: dict[str, jax.Array], batch: dict[str, jax.Array]) -> jax.Array:
    """PPO's loss of a minibatch."""
    output = forward(params, batch["observation"])
    scaled = (batch["action"] - output[:, :2]) / jnp.exp(params["log_sd"])
    log_prob = (-0.5 * scaled**2 - params["log_sd"] - 0.5 * jnp.log(2 * jnp.pi)).sum(1)
    ratio = jnp.exp(log_prob - batch["log_prob"])
    clipped = jnp.clip(ratio, 1 - CLIP, 1 + CLIP)
    policy = -jnp.minimum(ratio * batch["advantage"], clipped * batch["advantage"]).mean()
    value = 0.5 * ((output[:, 2] - batch["target"]) ** 2).mean()
    return policy + VALUE_COEF * value - ENTROPY_COEF * params["log_sd"].sum()


def adam(state: tuple[Any, ...], gradient: dict[str, jax.Array]) -> tuple[Any, ...]:
    """One step of Adam on (params, first moment, second moment, number)."""
    params, first, second, number = state
    number = number + 1
    first = jax.tree.map(lambda m, g: BETA1 * m + (1 - BETA1) * g, first, gradient)
    second = jax.tree.map(lambda v, g: BETA2 * v + (1 - BETA2) * g * g, second, gradient)
    unbias1, unbias2 = 1 - BETA1**number, 1 - BETA2**number
    params = jax.tree.map(
        lambda p, m, v: p - RATE * (m / unbias1) / (jnp.sqrt(v / unbias2) + EPSILON), params, first, second
    )
    return params, first, second, number


def update(state: tuple[Any, ...], rollout: dict[str, jax.Array], key: jax.Array) -> tuple[Any, ...]:
    """What one learner does at the end of a window."""
    value = forward(state[0], rollout["observation"])[:, 2]
    advantage = advantages(rollout, value)
    steps = {name: rollout[name][:STEPS] for name in ("observation", "action", "log_prob")}
    steps |= {"advantage": advantage, "target": advantage + value[:STEPS]}
    order = jax.vmap(lambda k: jax.random.permutation(k, STEPS))(jax.random.split(key, EPOCHS))

    def minibatch(state: tuple[Any, ...], rows: jax.Array) -> tuple[tuple[Any, ...], None]:
        batch = {name: array[rows] for name, array in steps.items()}
        return adam(state, jax.grad(loss)(state[0], batch)), None

    return jax.lax.scan(minibatch, state, order.reshape(-1, MINIBATCH))[0]


def seconds_per_update(learners: int, precision: str) -> list[float]:
    """Seconds of an update of the whole population [s], `REPEATS` times, after one that compiles."""
    keys = jax.random.split(jax.random.key(1), learners)
    params = jax.vmap(make_learner)(keys)
    zeros = jax.tree.map(jnp.zeros_like, params)
    state = (params, zeros, zeros, jnp.zeros(learners))
    rollout = jax.vmap(make_rollout)(keys)
    with jax.default_matmul_precision(precision):
        step = jax.jit(jax.vmap(update))
        state = jax.block_until_ready(step(state, rollout, keys))
        taken = []
        for _ in range(REPEATS):
            begun = time.perf_counter()
            state = jax.block_until_ready(step(state, rollout, keys))
            taken.append(time.perf_counter() - begun)
    return taken


def main() -> None:
    """Prints a line of JSON for each number of learners and each precision of products."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--learners", type=int, nargs="+", default=[128, 1024, 8192, 32768])
    parser.add_argument("--precision", nargs="+", default=["highest", "default"], help="JAX's names")
    given = parser.parse_args()
    if min(given.learners) < 1:
        parser.error(f"--learners {min(given.learners)}: must be at least 1")
    device = jax.devices()[0]
    for precision in given.precision:
        for learners in given.learners:
            taken = seconds_per_update(learners, precision)
            rate = learners / statistics.median(taken)
            row = {"device": device.device_kind, "jax": jax.__version__, "precision": precision, "learners": learners}
            print(json.dumps({**row, "seconds": taken, "updates_per_second": round(rate, 1)}), flush=True)


if __name__ == "__main__":
    main()
