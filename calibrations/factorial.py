"""Effects of several factors: designs in which none of them does anything."""

import itertools
from collections.abc import Callable

import numpy as np

from calibrations.calibration import Calibration
from hedon.statistic import Cell, fit_factorial

LEVEL = 0.05


def _design(rng: np.random.Generator, balanced: bool, seed_sd: float) -> dict[Cell, dict[int, float]]:
    """Worlds of 2 or 3 factors that do nothing; one cell varies up to five times as much as the others."""
    cells = list(itertools.product((False, True), repeat=int(rng.integers(2, 4))))
    count = int(rng.integers(2, 5))
    seeds = rng.normal(0.0, seed_sd, 21)
    sds = np.ones(len(cells))
    sds[rng.integers(len(cells))] = rng.uniform(1.0, 5.0)
    counts = [count if balanced else int(rng.integers(3, 21)) for _ in cells]
    return {
        cell: {seed: float(seeds[seed] + sd * rng.normal()) for seed in range(worlds)}
        for cell, sd, worlds in zip(cells, sds, counts, strict=True)
    }


def _alarm(balanced: bool, seed_sd: float = 0.0) -> Callable[[np.random.Generator], bool]:
    def draw(rng: np.random.Generator) -> bool:
        cells = _design(rng, balanced, seed_sd)
        effects = fit_factorial(cells, len(next(iter(cells)))).effects
        return effects[rng.integers(len(effects))].p <= LEVEL

    return draw


def _unequal(rng: np.random.Generator) -> bool:
    """Four cells of 3, 20, 20 and 20 worlds, of which the small one varies five times as much."""
    cells = list(itertools.product((False, True), repeat=2))
    worlds = {
        cell: dict(enumerate(rng.normal(0.0, sd, count).tolist()))
        for cell, sd, count in zip(cells, (5, 1, 1, 1), (3, 20, 20, 20), strict=True)
    }
    return fit_factorial(worlds, 2).effects[0].p <= LEVEL


COVERS = ("tool:factorial",)
_FACTORS = "2 or 3 factors without effect; one cell varies up to five times as much; {} worlds per cell"
CALIBRATIONS = [
    Calibration("factorial effect, p", COVERS, _FACTORS.format("2 to 4"), "false alarms", LEVEL, _alarm(balanced=True)),
    Calibration(
        "factorial effect, p", COVERS, _FACTORS.format("3 to 20"), "false alarms", LEVEL, _alarm(balanced=False)
    ),
    Calibration(
        "factorial effect, p",
        COVERS,
        "cells of 3 and 20 worlds, the small one five times as variable",
        "false alarms",
        LEVEL,
        _unequal,
    ),
    Calibration(
        "factorial effect, p",
        COVERS,
        f"{_FACTORS.format('2 to 4')} that share seeds, which vary as much as worlds",
        "false alarms",
        LEVEL,
        _alarm(balanced=True, seed_sd=1.0),
    ),
]
