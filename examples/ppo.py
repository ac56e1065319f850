"""Trains one policy for all agents by PPO of Stable-Baselines3, compares it with random actions, and records its world.

    pip install "hedon[env]" stable-baselines3
    python examples/ppo.py [--seeds 5] [--steps 120000] [--out runs/ppo]
    hedon view runs/ppo

All agents of all worlds share one network: to the library, each slot is an environment of its own. It sees what the
engine's networks see, and is paid 1 for each food. Torch for the processor only is 200 MB (`--index-url
https://download.pytorch.org/whl/cpu`); as PyPI gives it, with libraries for graphics cards, it is 5 GB.
"""

import argparse
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from stable_baselines3 import PPO

import hedon
from hedon.env import SlotVecEnv, VectorEnv

WORLDS = 8
STEPS = 300
HOLD = 4
"""Steps for which an action is held: food is rare, so each decision should count."""
UNSEEN = 1_000_000
"""Seeds of worlds from here on are for tests only."""
SETTINGS = (
    *("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50"),
    *("food.normal.gene.initial_mean=1", "food.normal.gene.initial_sd=0", "reward.action_coef=0"),
)
"""Nobody is born or dies, every slot has an agent, and the reward is what it eats."""
Policy = Callable[[Any], Any]
"""Actions (agents, 2) from observations (agents, entries)."""


def make(worlds: int, seed: int, **options: Any) -> VectorEnv:
    """Worlds in which agents forage for some hundred steps, and then in the next worlds."""
    config = hedon.load_config("baseline", overrides=SETTINGS)
    return hedon.make(config, worlds, seed, repeat=HOLD, threads=1, **options)


def forage(worlds: VectorEnv, choose: Policy) -> float:
    """Foods per agent in an episode."""
    eaten = 0.0
    for _ in range(STEPS // HOLD):
        seen = worlds.observations.reshape(-1, worlds.observations.shape[-1])
        worlds.step(choose(seen))
        eaten += float(worlds.rewards.sum())
    return eaten / worlds.alive.sum()


def train(seed: int, steps: int) -> PPO:
    """A policy that has learned for a number of decisions of agents."""
    model = PPO(
        "MlpPolicy",
        SlotVecEnv(make(WORLDS, 10_000 * seed, max_steps=STEPS)),
        n_steps=STEPS // HOLD,
        batch_size=1500,
        n_epochs=4,
        gamma=0.95,
        learning_rate=1e-3,
        seed=seed,
        device="cpu",
    )
    return model.learn(steps)


def policy_of(model: PPO) -> Policy:
    """What a trained model does, with the noise with which it learned."""
    return lambda seen: model.predict(seen)[0]


def compare(models: Sequence[PPO], worlds: int = 16) -> tuple[list[float], float]:
    """Foods per agent in worlds that no training saw: with the policy of each model, and with random actions."""
    rng = np.random.default_rng(1)
    random = forage(make(worlds, UNSEEN), lambda seen: rng.uniform(-1, 1, (len(seen), 2)).astype(np.float32))
    return [forage(make(worlds, UNSEEN), policy_of(model)) for model in models], random


def record(model: PPO, out: Path, steps: int = STEPS) -> None:
    """Writes what the agents of one world do, as `hedon run` writes a run: `hedon view` and `report` read it."""
    config = hedon.load_config("baseline", overrides=SETTINGS)
    with hedon.make(config, seed=UNSEEN, repeat=HOLD, record=out, frames=HOLD) as world:
        for _ in range(steps // HOLD):
            world.step(policy_of(model)(world.observations[0])[None])


def main() -> None:
    """Trains and prints the comparison."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=120_000)
    parser.add_argument("--out", type=Path, help="folder for the record of a world of the first policy")
    given = parser.parse_args()
    models = list(map(partial(train, steps=given.steps), range(1, given.seeds + 1)))
    trained, random = compare(models)
    factors = np.array(trained) / random
    print("foods per agent: " + ", ".join(f"{each:.2f}" for each in trained) + f"; random {random:.2f}")
    print(f"trained over random: {factors.mean():.2f}, from {factors.min():.2f} to {factors.max():.2f} by seed")
    if given.out is not None:
        record(models[0], given.out)
        print(f"look at it: hedon view {given.out}")


if __name__ == "__main__":
    main()
