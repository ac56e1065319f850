"""Trains one policy for all agents by PPO of Stable-Baselines3, and compares it with random actions.

    pip install stable-baselines3
    uv run python examples/ppo.py [--seeds 5] [--steps 120000]

All agents of all worlds share one network: to the library, each slot is an environment of its own. It sees what the
engine's networks see, and is paid 1 for each food. Torch for the processor only is 200 MB (`--index-url
https://download.pytorch.org/whl/cpu`); as PyPI gives it, with libraries for graphics cards, it is 5 GB.
"""

import argparse
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import VecEnv

import hedon
import hedon.env

WORLDS = 8
STEPS = 300
HOLD = 4
"""Steps for which an action is held: food is rare, so each decision should count."""
LIMIT = 4.0
"""Largest action before the sigmoid, which is 0.98 there."""
UNSEEN = 1_000_000
"""Seeds of worlds from here on are for tests only."""
SETTINGS = (
    *("hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0", "population.capacity=50"),
    *("food.normal.gene.initial_mean=1", "food.normal.gene.initial_sd=0", "reward.action_coef=0"),
)
"""Nobody is born or dies, every slot has an agent, and the reward is what it eats."""


class Foragers(VecEnv):
    """All agents of some worlds, each as an environment of Stable-Baselines3; an episode is `STEPS` steps."""

    def __init__(self, first_seed: int, worlds: int = WORLDS) -> None:
        config = hedon.load_config("baseline", overrides=SETTINGS)
        self.worlds = hedon.env.vector_env(config, range(first_seed, first_seed + worlds), threads=1)
        self.agents = self.worlds.groups["agent"]
        self.next_seed, self.step_count = first_seed, 0
        slots = self.agents.ids.size
        entries = len(self.agents.columns)
        super().__init__(slots, Box(-np.inf, np.inf, (entries,)), Box(-LIMIT, LIMIT, (2,)))

    def reset(self) -> Any:
        """Begins in worlds that were not seen yet: (agents, entries)."""
        count = len(self.worlds.simulation.seeds)
        self.worlds.reset(range(self.next_seed, self.next_seed + count))
        self.next_seed, self.step_count = self.next_seed + count, 0
        return self._seen()

    def step_async(self, actions: Any) -> None:
        """Tells every agent what to do: (agents, 2)."""
        self.agents.actions[...] = actions.reshape(self.agents.actions.shape)

    def step_wait(self) -> Any:
        """Holds the actions for some steps; all episodes end at once."""
        rewards = np.zeros(self.num_envs, np.float32)
        for _ in range(HOLD):
            self.worlds.step()
            rewards += self.agents.rewards.ravel()
        self.step_count += HOLD
        over = self.step_count >= STEPS
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        seen = self._seen()
        if over:
            infos = [{"terminal_observation": row, "TimeLimit.truncated": True} for row in seen]
            seen = self.reset()
        return seen, rewards, np.full(self.num_envs, over), infos

    def _seen(self) -> Any:
        return self.agents.observations.reshape(self.num_envs, -1).copy()

    def close(self) -> None:
        """Has nothing to close."""

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """The same for all agents."""
        return [getattr(self, attr_name)] * self.num_envs

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """No agent has attributes of its own."""
        raise NotImplementedError("the agents share what they are")

    def env_method(self, method_name: str, *arguments: Any, indices: Any = None, **options: Any) -> list[Any]:
        """No agent has methods of its own."""
        raise NotImplementedError("the agents share what they do")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """None is."""
        return [False] * self.num_envs


def foods(choose: Any, worlds: int = 16) -> float:
    """Foods per agent in an episode of worlds that no training saw; `choose(observations)` gives the actions."""
    test = Foragers(UNSEEN, worlds)
    seen, eaten = test.reset(), 0.0
    for _ in range(STEPS // HOLD):
        test.step_async(choose(seen))
        for _ in range(HOLD):
            test.worlds.step()
            eaten += float(test.agents.rewards.sum())
        seen = test._seen()
    return eaten / test.num_envs


def train(seed: int, steps: int) -> PPO:
    """A policy that has learned for a number of decisions of agents."""
    decisions = STEPS // HOLD
    model = PPO(
        "MlpPolicy",
        Foragers(10_000 * seed),
        n_steps=decisions,
        batch_size=1500,
        n_epochs=4,
        gamma=0.95,
        learning_rate=1e-3,
        seed=seed,
        device="cpu",
    )
    return model.learn(steps)


def compare(seeds: Sequence[int], steps: int) -> tuple[list[float], float]:
    """Foods per agent with the policy of each seed, and with random actions."""
    rng = np.random.default_rng(1)
    random = foods(lambda seen: rng.standard_normal((len(seen), 2), np.float32))
    policies = [train(seed, steps) for seed in seeds]
    return [foods(partial(_act, policy)) for policy in policies], random


def _act(policy: PPO, seen: Any) -> Any:
    return policy.predict(seen)[0]


def main() -> None:
    """Trains and prints the comparison."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=120_000)
    given = parser.parse_args()
    trained, random = compare(range(1, given.seeds + 1), given.steps)
    factors = np.array(trained) / random
    print("foods per agent: " + ", ".join(f"{each:.2f}" for each in trained) + f"; random {random:.2f}")
    print(f"trained over random: {factors.mean():.2f}, from {factors.min():.2f} to {factors.max():.2f} by seed")


if __name__ == "__main__":
    main()
