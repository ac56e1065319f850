"""Trains one policy for all agents in a program of JAX: worlds, policy and training in one `jit`, by `vmap` and `scan`.

    pip install "hedon[jax]"
    python examples/scan.py [--generations 12]

The policy is linear, as in foraging.py: two motors from what the rays read of food. Each world tries one candidate in
all of its agents; the cross-entropy method (Rubinstein 1999) makes the next ones of the best quarter.
"""

import argparse

import jax
import numpy as np
from jax import numpy as jnp

import hedon
from hedon.env import JaxEnv

CANDIDATES = 32
STEPS = 300
SETTINGS = (
    *("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50"),
    *("food.normal.gene.initial_mean=1", "food.normal.gene.initial_sd=0", "reward.action_coef=0"),
)
"""Nobody is born or dies, every slot has an agent, and the reward is what it eats."""


class Trainer:
    """Worlds, one for each candidate, and the program that evaluates all of them."""

    def __init__(self, threads: int = 0) -> None:
        self.env = JaxEnv(
            hedon.load_config("baseline", overrides=SETTINGS), CANDIDATES, actions="logit", threads=threads
        )
        self.food = np.array([i for i, name in enumerate(self.env.columns) if name.startswith("ray_normal_")])
        self.forage = jax.jit(self._forage)

    def act(self, weights: jax.Array, seen: jax.Array) -> jax.Array:
        """The actions (slots, 2) of the agents of a world by weights (rays + 1,); the right motor mirrors the left."""
        near = jnp.maximum(seen[:, self.food], 0.0)
        return jnp.stack([near @ weights[:-1], near @ weights[-2::-1]], axis=1) + weights[-1]

    def _forage(self, key: jax.Array, weights: jax.Array) -> jax.Array:
        """Foods per agent in an episode of each world, by weights (worlds, rays + 1)."""

        def step(carry: tuple, key: jax.Array) -> tuple:
            seen, state = carry
            keys = jax.random.split(key, CANDIDATES)
            seen, state, paid, _, _ = jax.vmap(self.env.step)(keys, state, jax.vmap(self.act)(weights, seen))
            return (seen, state), paid.mean(axis=1)

        begin, go_on = jax.random.split(key)
        carry = jax.vmap(self.env.reset)(jax.random.split(begin, CANDIDATES))
        return jax.lax.scan(step, carry, jax.random.split(go_on, STEPS))[1].sum(axis=0)

    def train(self, key: jax.Array, generations: int) -> jax.Array:
        """The mean of the candidates after some generations, (rays + 1,)."""
        mean, sd = jnp.zeros(len(self.food) + 1), jnp.full(len(self.food) + 1, 2.0)
        for generation in range(generations):
            draw, live = jax.random.split(jax.random.fold_in(key, generation))
            tried = mean + sd * jax.random.normal(draw, (CANDIDATES, len(mean)))
            foods = self.forage(live, tried)
            best = tried[jnp.argsort(foods)[-CANDIDATES // 4 :]]
            mean, sd = best.mean(axis=0), best.std(axis=0) + 0.1
            print(f"generation {generation + 1:2}: {foods.mean():.2f} foods per agent, the best {foods.max():.2f}")
        return mean

    def compare(self, generations: int) -> tuple[np.ndarray, np.ndarray]:
        """Foods per agent in worlds that training did not see: with the trained weights, and with random ones."""
        weights = self.train(jax.random.key(1), generations)
        unseen = jax.random.key(1_000_000)
        random = 2.0 * jax.random.normal(jax.random.key(2), (CANDIDATES, len(weights)))
        trained = self.forage(unseen, jnp.tile(weights, (CANDIDATES, 1)))
        return np.asarray(trained), np.asarray(self.forage(unseen, random))


def main() -> None:
    """Trains and prints the comparison."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--generations", type=int, default=12)
    trained, random = Trainer().compare(parser.parse_args().generations)
    for name, foods in (("trained", trained), ("random weights", random)):
        error = 1.96 * foods.std(ddof=1) / np.sqrt(len(foods))
        print(f"{name}: {foods.mean():.2f} ± {error:.2f} foods per agent in {STEPS} steps, {len(foods)} worlds")


if __name__ == "__main__":
    main()
