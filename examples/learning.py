"""Do agents learn? Compares agents with a fixed reward for food with agents that have no reward.

Agents neither die nor have children. The example runs every combination of observation scaling and critic, and one
with weights of 32 bits for acting, each in several worlds, and writes a figure and a table:

    python examples/learning.py --windows 60 --seeds 10 --out docs/results/learning
"""

import argparse
import json
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy import stats

import hedon
from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation

# No deaths and no births. Food grows fast, so that the supply does not limit what skilled agents eat.
SETTING = (
    "hazard.kappa=0",
    "hazard.alpha_age=0",
    "birth.kappa=0",
    "food.normal.gene.initial_sd=0",
    "genome.action.initial_sd=0",
    "food.normal.growth_rate=1.0",
)


@dataclass(frozen=True)
class Condition:
    """One curve of the figure."""

    name: str
    reward: float
    scaling: str
    critic: str
    acting: str = "bfloat16"

    @property
    def overrides(self) -> tuple[str, ...]:
        """The settings that make this condition."""
        return (
            *SETTING,
            f"food.normal.gene.initial_mean={self.reward}",
            f'sensor.scaling="{self.scaling}"',
            f'learning.critic_target="{self.critic}"',
            f'learning.acting_weights="{self.acting}"',
        )


CONDITIONS = (
    Condition("food reward, raw, critic per state", 1.0, "raw", "per_state"),
    Condition("the same, acting by float32", 1.0, "raw", "per_state", "float32"),
    Condition("food reward, raw, critic batch mean", 1.0, "raw", "batch_mean"),
    Condition("food reward, unit, critic per state", 1.0, "unit", "per_state"),
    Condition("food reward, unit, critic batch mean", 1.0, "unit", "batch_mean"),
    Condition("no reward, raw", 0.0, "raw", "per_state"),
    Condition("no reward, unit", 0.0, "unit", "per_state"),
)


def food_per_agent_step(condition: Condition, seeds: list[int], windows: int) -> np.ndarray:
    """Foods eaten per agent and step in each window: (worlds, windows)."""
    config = load_config("baseline", overrides=condition.overrides)
    simulation = Simulation(config, seeds)
    eaten = np.zeros((len(seeds), windows + 1))
    for window in range(windows):
        simulation.run(config.world.rollout_steps)
        eaten[:, window + 1] = [world.view("food_stock.eaten")[0] for world in simulation.worlds]
    agent_steps = config.species["agent"].population.initial_count * config.world.rollout_steps
    return np.diff(eaten, axis=1) / agent_steps


def interval(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean over worlds and half the width of its 95 % t interval."""
    count = values.shape[0]
    return values.mean(axis=0), stats.t.ppf(0.975, count - 1) * stats.sem(values, axis=0)


def main() -> None:
    """Runs the experiment and writes its figure, its numbers and a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--windows", type=int, default=60)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--out", type=Path, default=Path("runs/learning"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    seeds = list(range(1, options.seeds + 1))

    figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
    colors = ("#0072b2", "#009e73", "#56b4e9", "#d55e00", "#e69f00", "#555555", "#aaaaaa")
    numbers = {"hedon": hedon.__version__, "seeds": seeds, "windows": options.windows, "conditions": {}}
    ends = (slice(0, 3), slice(-10, None))
    for condition, color in zip(CONDITIONS, colors, strict=True):
        curves = food_per_agent_step(condition, seeds, options.windows)
        mean, half = interval(curves)
        steps = np.arange(1, options.windows + 1)
        axes.plot(steps, 1e3 * mean, color=color, label=condition.name)
        axes.fill_between(steps, 1e3 * (mean - half), 1e3 * (mean + half), color=color, alpha=0.15, linewidth=0)
        start, end = (interval(curves[:, span].mean(axis=1, keepdims=True)) for span in ends)
        numbers["conditions"][condition.name] = {
            "first_3_windows": [start[0].item(), start[1].item()],
            "last_10_windows": [end[0].item(), end[1].item()],
            "per_world_last_10": curves[:, ends[1]].mean(axis=1).tolist(),
        }
        (before, _), (after, half) = ((1e3 * mean.item(), 1e3 * half.item()) for mean, half in (start, end))
        print(f"{condition.name:40s} {before:6.3f} -> {after:6.3f} ± {half:.3f} foods per 1000 agent-steps", flush=True)
    axes.set_xlabel(f"window of {load_config('baseline').world.rollout_steps} steps")
    axes.set_ylabel("foods per 1000 agent-steps")
    axes.set_ylim(bottom=0)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=8)
    figure.savefig(options.out / "learning.png", dpi=150)
    (options.out / "learning.json").write_text(json.dumps(numbers, indent=2) + "\n")


if __name__ == "__main__":
    main()
