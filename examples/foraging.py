"""Trains one policy for all agents of many worlds, from outside, and compares it with random actions.

    uv run python examples/foraging.py [--generations 12]

The policy is linear: two motors from what the 24 rays read of food, the left motor's weights mirrored for the right.
The cross-entropy method (Rubinstein 1999) finds them: each world tries one candidate in all of its agents, and the
best quarter makes the next ones. It uses NumPy alone; `worlds.groups[...]` are arrays that any trainer can read.
About half a minute on two cores.
"""

import argparse

import numpy as np
from numpy.typing import NDArray

import hedon

CANDIDATES = 32
STEPS = 300
SETTINGS = ("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0")
"""Nobody is born or dies: what counts is food."""


def eaten(worlds: hedon.env.VectorEnv) -> NDArray[np.float64]:
    """Foods eaten per agent since the beginning, (worlds,)."""
    return np.array([world.agents()["eaten"].sum() / world.alive for world in worlds.simulation.worlds])


def forage(worlds: hedon.env.VectorEnv, weights: NDArray[np.float64], seeds: range) -> NDArray[np.float64]:
    """Lets the agents of each world act by the weights of its row, (worlds, rays + 1); returns `eaten`."""
    worlds.reset(seed=seeds)
    agents = worlds.groups["agent"]
    food = [i for i, name in enumerate(agents.columns) if name.startswith("ray_normal_")]
    motors = np.stack([weights[:, :-1], weights[:, -2::-1]], axis=2).astype(np.float32)  # (worlds, rays, 2)
    bias = weights[:, None, -1:].astype(np.float32)
    for _ in range(STEPS):
        seen = np.maximum(agents.observations[:, :, food], 0.0)  # (worlds, slots, rays), 0 where there is no food
        np.matmul(seen, motors, out=agents.actions)
        agents.actions += bias
        worlds.step(agents.actions)
    return eaten(worlds)


def train(worlds: hedon.env.VectorEnv, generations: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """The mean of the candidates after some generations of the cross-entropy method, (rays + 1,)."""
    rays = worlds.config.species["agent"].sensor.ray_count
    mean, sd = np.zeros(rays + 1), np.full(rays + 1, 2.0)
    for generation in range(generations):
        tried = mean + sd * rng.standard_normal((CANDIDATES, rays + 1))
        foods = forage(worlds, tried, range(generation * CANDIDATES, (generation + 1) * CANDIDATES))
        best = tried[np.argsort(foods)[-CANDIDATES // 4 :]]
        mean, sd = best.mean(axis=0), best.std(axis=0) + 0.1
        print(f"generation {generation + 1:2}: {foods.mean():.2f} foods per agent, the best {foods.max():.2f}")
    return mean


def compare(generations: int, threads: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Foods per agent in worlds that training did not see: with the trained policy, and with random actions."""
    config = hedon.load_config("baseline", overrides=SETTINGS)
    worlds = hedon.make(config, CANDIDATES, actions="logit", threads=threads)
    weights = train(worlds, generations, np.random.default_rng(1))
    fresh = range(1_000_000, 1_000_000 + CANDIDATES)
    trained = forage(worlds, np.tile(weights, (CANDIDATES, 1)), fresh)
    random = hedon.load_config("baseline", overrides=[*SETTINGS, 'learning.policy="random"'])
    simulation = hedon.Simulation(random, fresh, threads)
    simulation.run(STEPS)
    return trained, np.array([world.agents()["eaten"].sum() / world.alive for world in simulation.worlds])


def main() -> None:
    """Trains and prints the comparison."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--generations", type=int, default=12)
    trained, random = compare(parser.parse_args().generations)
    for name, foods in (("trained", trained), ("random", random)):
        error = 1.96 * foods.std(ddof=1) / np.sqrt(len(foods))
        print(f"{name}: {foods.mean():.2f} ± {error:.2f} foods per agent in {STEPS} steps, {len(foods)} worlds")


if __name__ == "__main__":
    main()
