"""Where drift alone would have a weight: the gray bands of figures."""

from functools import cache
from typing import Any

import numpy as np
import polars as pl

from calibrations.calibration import Calibration
from hedon import load_config
from hedon.analysis import WorldRecord, drift_bands
from hedon.config import Config

_TIMES, _INTERVAL = 10, 1024
_LAWS: tuple[dict[str, Any], ...] = (
    {},
    {"food.normal.gene.initial_mean": 1.0, "food.normal.gene.initial_sd": 0.05},
    {"food.normal.gene.initial_mean": -2.0, "genome.mutation.w_normal": {"law": "normal", "probability": 0.3}},
    {"food.normal.gene.initial_sd": 0.0, "genome.mutation.w_normal": {"law": "uniform", "scale": 0.1}},
    {"food.normal.gene.initial_mean": 5.0, "genome.mutation.w_normal": {"scale": 0.5, "limit": 5.0}},
)
"""Settings of the weight that is drawn: all but the first make it unlike the neutral genes of its world."""
_GENE = "w_normal"


@cache
def _config(law: int) -> Config:
    config = load_config("baseline")
    for path, value in _LAWS[law].items():
        config = config.with_(path, value)
    return config


def _mutations(rng: np.random.Generator, config: Config, count: int) -> np.ndarray:
    genome = config.species["agent"].genome
    mutation = genome.mutation.get(_GENE)
    law = mutation.law if mutation else genome.mutation_law
    scale, probability = (
        (mutation.scale, mutation.probability) if mutation else (genome.mutation_scale, genome.mutation_probability)
    )
    draws = {"cauchy": rng.standard_cauchy, "normal": rng.standard_normal}
    noise = draws[law](count) if law in draws else rng.uniform(-1.0, 1.0, count)
    return scale * noise * (rng.random(count) < probability)


def _world(rng: np.random.Generator, config: Config) -> WorldRecord:
    """A world whose weight nothing selects: in each interval a tenth to a half of the living die and others bear."""
    genome, law = config.species["agent"].genome, config.food["normal"].gene
    limit = genome.mutation[_GENE].limit if _GENE in genome.mutation else genome.weight_limit
    size = int(rng.integers(5, 60))
    value = list(np.clip(rng.normal(law.initial_mean, law.initial_sd, size), -limit, limit))
    birth = [0] * size
    parent: list[int | None] = [None] * size
    death: list[int | None] = [None] * size
    living, rows = list(range(size)), []
    for step in range(_INTERVAL, (_TIMES + 1) * _INTERVAL, _INTERVAL):
        parents = rng.choice(living, rng.binomial(len(living), rng.uniform(0.1, 0.5)))
        gone = {int(i) for i in rng.choice(living, min(len(parents), len(living) - 1), replace=False)}
        for up, noise in zip(parents, _mutations(rng, config, len(parents)), strict=True):
            living.append(len(value))
            parent.append(int(up))
            birth.append(step)
            death.append(None)
            value.append(float(np.clip(value[up] + noise, -limit, limit)))
        for i in gone:
            death[i] = step
        living = [i for i in living if i not in gone]
        mean = float(np.mean([value[i] for i in living]))
        rows.append({"world": 0, "step": step, "alive": len(living), f"{_GENE}_mean": mean})
    columns = {"agent_id": range(len(value)), "parent_id": parent, "birth_step": birth, "death_step": death}
    agents = pl.DataFrame({**columns, _GENE: value}, schema_overrides={"parent_id": pl.Int64, "death_step": pl.Int64})
    population = pl.DataFrame(rows)
    return WorldRecord(
        "c", "r", 1, config, ("normal",), (_GENE,), (), agents, population, _TIMES * _INTERVAL, extinct_step=None
    )


def _outside(rng: np.random.Generator) -> bool | None:
    world = _world(rng, _config(int(rng.integers(len(_LAWS)))))
    band = drift_bands([world])[_GENE]
    row = int(rng.integers(_TIMES))  # any time of the figure
    step, mean = world.population.row(row)[1], world.population.row(row)[3]
    low, high = (float(np.interp(step, band.step, bound)) for bound in (band.low, band.high))
    return not low <= mean <= high


CALIBRATIONS = (
    Calibration(
        "band of drift in figures, at one time",
        ("figure:history",),
        "1 world of 5 to 60 agents; a weight with founders and mutations unlike those of the neutral genes",
        "false alarms",
        0.05,
        _outside,
    ),
)
