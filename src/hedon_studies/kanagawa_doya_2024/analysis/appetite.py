"""How large must the weight of food be before an agent eats well?

Computes foods eaten per step lived, for agents that differ in their inherited weight. Counts are known only for dead
agents, and agents with short lives had no time to learn, so a life must have `WINDOWS` windows of learning. Agents with
larger weights were mostly born later, among other agents. The result is therefore an association, not the causal effect
of the weight.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import polars as pl

from hedon.analysis import WorldRecord, dead_agents

WINDOWS = 5
EDGES = (-10.0, -3.0, -1.0, -0.3, -0.1, 0.0, 0.1, 0.3, 1.0, 3.0, 10.0)
"""Edges of the bins, up to the limit of weights: two per factor of ten, since the effect spans orders of magnitude."""
FEWEST = 20
"""Smallest number of agents for a bin of a world to be shown."""


@dataclass(frozen=True)
class AppetiteBin:
    """The agents of one world with a weight between two bounds.

    Attributes:
        low, high: Bounds of the weight; the lower bound belongs to the bin.
        agents: Number of agents that died after at least `WINDOWS` windows.
        weight: Their median weight.
        steps: Steps that they lived, summed [step].
        eaten: Foods eaten per 1000 steps.
    """

    low: float
    high: float
    agents: int
    weight: float
    steps: int
    eaten: float


def appetite(world: WorldRecord, kind: str = "normal", edges: Sequence[float] = EDGES) -> list[AppetiteBin]:
    """Food eaten by the agents of one world, by their weight for it; bins with too few agents are left out.

    Args:
        world: The world.
        kind: Food kind.
        edges: Edges of the bins, in ascending order.

    Returns:
        A bin for each pair of neighboring edges, with the dead that lived for at least `WINDOWS` windows of learning.
    """
    min_lifetime = WINDOWS * world.config.world.rollout_steps
    agents = dead_agents(world.agents).filter(pl.col("lifetime") >= min_lifetime)
    weight, foods = agents[f"w_{kind}"].to_numpy().astype(np.float64), agents[f"eaten_{kind}"].to_numpy()
    steps = agents["lifetime"].to_numpy()
    at = np.clip(np.searchsorted(edges, weight, side="right") - 1, 0, len(edges) - 2)
    bins = []
    for i, (low, high) in enumerate(pairwise(edges)):
        in_bin = at == i
        if in_bin.sum() >= FEWEST:
            total_steps = int(steps[in_bin].sum())
            rate = 1000.0 * float(foods[in_bin].sum()) / total_steps
            bins.append(AppetiteBin(low, high, int(in_bin.sum()), float(np.median(weight[in_bin])), total_steps, rate))
    return bins


def half_way_weight(bins: Sequence[AppetiteBin]) -> float | None:
    """The weight at which agents eat half-way between agents with negative weights and those of the best bin.

    It is interpolated linearly between the median weights of the last bin below that rate, up to the best, and the next
    bin.

    Returns:
        The weight; None if no bin has negative weights, or the best bin does.
    """
    negative_bins = [b for b in bins if b.high <= 0]
    best = max(range(len(bins)), key=lambda i: bins[i].eaten, default=0)
    if not negative_bins or best < len(negative_bins):
        return None
    low = sum(b.eaten * b.steps for b in negative_bins) / sum(b.steps for b in negative_bins)
    middle = 0.5 * (low + bins[best].eaten)
    lower_index = max(i for i in range(best) if bins[i].eaten < middle)
    lower, upper = bins[lower_index], bins[lower_index + 1]
    share = (middle - lower.eaten) / (upper.eaten - lower.eaten)
    return lower.weight + share * (upper.weight - lower.weight)
