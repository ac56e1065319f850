"""PPO in one file for any vector environment of Gymnasium with continuous actions.

Only the line after the imports is about hedon.

    python examples/vector_ppo.py --env hedon/baseline-v0
    python examples/vector_ppo.py --env Pendulum-v1

It needs Gymnasium and JAX: pip install "hedon[env,jax]".
"""

import argparse
import math
from functools import partial
from typing import Any, NamedTuple

import gymnasium
import jax
import numpy as np
from gymnasium.wrappers.vector import ClipAction, NormalizeObservation, RecordEpisodeStatistics
from jax import numpy as jnp

import hedon

gymnasium.register_envs(hedon)

HIDDEN, RATE, GAMMA, LAMBDA, CLIP, EPOCHS, PARTS = 64, 1e-3, 0.99, 0.95, 0.2, 4, 4


class Batch(NamedTuple):
    """Steps of all environments: observations, actions, their log probabilities, advantages and returns."""

    seen: Any
    action: Any
    log_chance: Any
    advantage: Any
    gained: Any


def network(key: jax.Array, inputs: int, outputs: int) -> dict[str, Any]:
    """Weights of a network with one hidden layer that gives means of actions and a value."""
    first, second = jax.random.split(key)
    return {
        "in": jax.random.normal(first, (inputs, HIDDEN)) / math.sqrt(inputs),
        "out": 0.01 * jax.random.normal(second, (HIDDEN, outputs + 1)),
        "log_sd": jnp.full(outputs, -0.5),
    }


def act(weights: dict[str, Any], seen: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Means of actions (rows, actions) and values (rows,)."""
    out = jnp.tanh(seen @ weights["in"]) @ weights["out"]
    return out[:, :-1], out[:, -1]


def log_chance(weights: dict[str, Any], mean: jax.Array, action: jax.Array) -> jax.Array:
    """Log density of actions, (rows,)."""
    z = (action - mean) / jnp.exp(weights["log_sd"])
    return -0.5 * (z**2 + math.log(2 * math.pi)).sum(axis=1) - weights["log_sd"].sum()


@jax.jit
def sample(weights: dict[str, Any], key: jax.Array, seen: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Actions, their log densities, and values."""
    mean, value = act(weights, seen)
    action = mean + jnp.exp(weights["log_sd"]) * jax.random.normal(key, mean.shape)
    return action, log_chance(weights, mean, action), value


def loss(weights: dict[str, Any], part: Batch) -> jax.Array:
    """The clipped objective and the squared error of values."""
    mean, value = act(weights, part.seen)
    ratio = jnp.exp(log_chance(weights, mean, part.action) - part.log_chance)
    advantage = (part.advantage - part.advantage.mean()) / (part.advantage.std() + 1e-8)
    gain = jnp.minimum(ratio * advantage, jnp.clip(ratio, 1 - CLIP, 1 + CLIP) * advantage)
    return -gain.mean() + 0.5 * ((value - part.gained) ** 2).mean()


@partial(jax.jit, donate_argnums=(0, 1))
def update(weights: Any, moments: Any, count: jax.Array, part: Batch) -> tuple[Any, Any]:
    """A step of Adam."""
    slope = jax.grad(loss)(weights, part)
    moments = jax.tree.map(
        lambda m, g: (0.9 * m[0] + 0.1 * g, 0.999 * m[1] + 0.001 * g**2), moments, slope, is_leaf=is_pair
    )
    scale = jnp.sqrt(1 - 0.999**count) / (1 - 0.9**count)
    step = jax.tree.map(lambda m: RATE * scale * m[0] / (jnp.sqrt(m[1]) + 1e-8), moments, is_leaf=is_pair)
    return jax.tree.map(jnp.subtract, weights, step), moments


def is_pair(node: Any) -> bool:
    """Whether a node of the tree of moments is a pair of them."""
    return isinstance(node, tuple)


def train(env_id: str, num_envs: int, steps: int, rounds: int, seed: int) -> list[float]:
    """Trains, prints how long episodes are and what they return, and gives the mean return of each round."""
    envs = ClipAction(NormalizeObservation(RecordEpisodeStatistics(gymnasium.make_vec(env_id, num_envs=num_envs))))
    entries, actions = envs.single_observation_space.shape[0], envs.single_action_space.shape[0]
    key, rng = jax.random.key(seed), np.random.default_rng(seed)
    weights = network(key, entries, actions)
    moments = jax.tree.map(lambda each: (jnp.zeros_like(each), jnp.zeros_like(each)), weights)
    seen, _ = envs.reset(seed=seed)
    count, means = 0, []
    for turn in range(rounds):
        kept: list[tuple[Any, ...]] = []
        returns, lengths = [], []
        for _ in range(steps):
            key, now = jax.random.split(key)
            action, chance, value = map(np.asarray, sample(weights, now, jnp.asarray(seen, jnp.float32)))
            after, reward, terminated, truncated, infos = envs.step(action)
            kept.append((seen, action, chance, value, reward, terminated | truncated))
            seen = after
            if "episode" in infos:
                returns += infos["episode"]["r"][infos["_episode"]].tolist()
                lengths += infos["episode"]["l"][infos["_episode"]].tolist()
        rows = [np.array(each, np.float32) for each in zip(*kept, strict=True)]
        following = np.asarray(act(weights, jnp.asarray(seen, jnp.float32))[1])
        advantage, last = np.zeros_like(rows[4]), np.zeros(num_envs, np.float32)
        for t in reversed(range(steps)):
            goes_on = 1.0 - rows[5][t]
            error = rows[4][t] + GAMMA * goes_on * following - rows[3][t]
            last = error + GAMMA * LAMBDA * goes_on * last
            advantage[t], following = last, rows[3][t]
        whole = Batch(rows[0], rows[1], rows[2], advantage, advantage + rows[3])
        flat = Batch(*(each.reshape(steps * num_envs, *each.shape[2:]) for each in whole))
        for _ in range(EPOCHS):
            for part in np.array_split(rng.permutation(steps * num_envs), PARTS):
                count += 1
                weights, moments = update(weights, moments, jnp.float32(count), Batch(*(each[part] for each in flat)))
        means.append(float(np.mean(rows[4])))
        told = f"; {len(returns)} episodes ended"
        told += f", of {np.mean(lengths):.0f} steps, return {np.mean(returns):.3g}" if returns else ""
        print(f"round {turn + 1}: mean reward {means[-1]:.4g}{told}")
    envs.close()
    return means


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--env", default="hedon/baseline-v0")
    parser.add_argument("--envs", type=int, default=8)
    parser.add_argument("--steps", type=int, default=256, help="of each environment in a round")
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    train(asked.env, asked.envs, asked.steps, asked.rounds, asked.seed)
