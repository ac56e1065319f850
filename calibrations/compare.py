"""Comparisons of two conditions: false alarms, intervals, and power at the number of worlds promised."""

from collections.abc import Callable

import numpy as np
import polars as pl

from calibrations.calibration import Calibration
from hedon.compare.contrast import compare
from hedon.compare.power import PAIRS, spreads
from hedon.compare.source import WorldTable
from hedon.statistic.contrast import Contrast
from hedon.statistic.extinction import log_rank
from hedon.statistic.power import Design, worlds_needed

LEVEL = 0.05


def _worlds(rng: np.random.Generator, seeds: int, settings: int = 2, effect: float = 0.0) -> pl.DataFrame:
    """Worlds of two levels x other settings x seeds: settings and seeds differ by much, and noise has sd 1."""
    level, setting, seed = (index.ravel() for index in np.indices((2, settings, seeds)))
    value = rng.normal(0, 10, settings)[setting] + rng.normal(0, 3, seeds)[seed] + effect * level
    return pl.DataFrame({"seed": seed, "level": level, "other": setting, "y": value + rng.normal(size=len(value))})


def _contrast(table: pl.DataFrame, *, paired: bool) -> Contrast:
    first, second = (table.filter(pl.col("level") == level) for level in (0, 1))
    return compare(first, second, {"y": "y"}, ["other"], paired=paired)[0].contrast


def _partial(paired: bool, kind: str) -> Callable[[np.random.Generator], bool | None]:
    """Whether a sweep of which a part is done, with missing values, rejects or misses the truth."""

    def draw(rng: np.random.Generator) -> bool | None:
        effect = float(rng.normal())
        table = _worlds(rng, int(rng.integers(6, 13)), effect=0.0 if kind == "p" else effect)
        kept = table.filter(pl.Series(rng.random(table.height) < rng.uniform(0.4, 1.0)))
        found = _contrast(kept, paired=paired)
        if kind == "p":
            return None if np.isnan(found.p) else found.p <= LEVEL
        return None if np.isnan(found.low) else not found.low <= effect <= found.high

    return draw


def _unequal(few: tuple[int, int], kind: str) -> Callable[[np.random.Generator], bool | None]:
    """Whether independent worlds, the smaller group three times as variable, reject or miss the truth."""

    def draw(rng: np.random.Generator) -> bool | None:
        small, large = int(rng.integers(few[0], few[1] + 1)), int(rng.integers(10, 21))
        one = pl.DataFrame({"seed": np.arange(small), "other": 0, "y": rng.normal(0, 3, small)})
        two = pl.DataFrame({"seed": np.arange(large), "other": 0, "y": rng.normal(0, 1, large)})
        found = compare(one, two, {"y": "y"}, ["other"], paired=False)[0].contrast
        if kind == "p":
            return found.p <= LEVEL
        return None if np.isnan(found.low) else not found.low <= 0 <= found.high

    return draw


def _found(design: Design) -> Callable[[np.random.Generator], bool]:
    """Whether `compare` finds an effect with as many worlds as `power` says that it takes."""

    def draw(rng: np.random.Generator) -> bool:
        effect = float(np.exp(rng.uniform(np.log(0.6), np.log(3.5))))
        needed = worlds_needed(effect / (1.0 if design == "independent" else np.sqrt(2)), design)
        assert needed is not None
        table = pl.DataFrame(
            {
                "seed": np.tile(np.arange(needed), 2),
                "level": np.repeat([0, 1], needed),
                "other": 0,
                "y": np.repeat([0.0, effect], needed) + rng.normal(size=2 * needed),
            }
        )
        return _contrast(table, paired=design == "pairs").p <= LEVEL

    return draw


def _spread(rng: np.random.Generator) -> float:
    """The error of the spread of pairs that a pilot of several settings gives, as a share of the truth."""
    pilot = WorldTable("pilot", _worlds(rng, int(rng.integers(6, 13)), settings=4), ("level", "other"))
    (found,) = (each for each in spreads(pilot, "level") if each.design == PAIRS)
    return found.sd / np.sqrt(2) - 1.0


def _log_rank(rng: np.random.Generator) -> bool | None:
    """Worlds of two conditions that die out alike, in settings in which they do so sooner or later."""
    worlds = int(rng.integers(8, 41))
    stratum = rng.integers(0, 3, worlds)
    lived = rng.exponential(np.array([0.5, 1.0, 4.0])[stratum])
    p = log_rank(np.minimum(lived, 1.0).round(2), lived < 1.0, rng.random(worlds) < 0.4, stratum, 400)
    return None if np.isnan(p) else p <= LEVEL


_DONE = "6 to 12 seeds x 2 settings x 2 levels, of which 40 to 100 % are done; seeds and settings differ by much"
_SMALL = "independent worlds, {} against 10 to 20; those of the smaller group vary three times as much"
COVERS = ("tool:compare",)

CALIBRATIONS = [
    Calibration("contrast, p of pairs", COVERS, _DONE, "false alarms", LEVEL, _partial(True, "p")),
    Calibration("contrast, interval of pairs", COVERS, _DONE, "missed", LEVEL, _partial(True, "interval")),
    Calibration("contrast, p of independent worlds", COVERS, _DONE, "false alarms", LEVEL, _partial(False, "p")),
    Calibration(
        "contrast, interval of independent worlds", COVERS, _DONE, "missed", LEVEL, _partial(False, "interval")
    ),
    Calibration(
        "contrast, p of independent worlds",
        COVERS,
        _SMALL.format("3 to 8"),
        "false alarms",
        LEVEL,
        _unequal((3, 8), "p"),
    ),
    Calibration(
        "contrast, interval of independent worlds",
        COVERS,
        _SMALL.format("5 to 8"),
        "missed",
        LEVEL,
        _unequal((5, 8), "interval"),
    ),
    Calibration(
        "power, worlds needed in pairs",
        ("tool:power",),
        "effects of 0.4 to 2.5 sd, tested by contrast with as many pairs as power asks for",
        "found",
        0.8,
        _found("pairs"),
    ),
    Calibration(
        "power, worlds needed of each condition",
        ("tool:power",),
        "effects of 0.6 to 3.5 sd, tested by contrast with as many worlds as power asks for",
        "found",
        0.8,
        _found("independent"),
    ),
    Calibration(
        "power, sd of pairs",
        ("tool:power",),
        "pilots of 6 to 12 seeds x 4 settings x 2 levels",
        "bias",
        0.0,
        _spread,
        tolerance=0.05,
    ),
    Calibration(
        "worlds that died out, p of the log-rank test",
        COVERS,
        "8 to 40 worlds in three settings, of which 22 to 86 % die out; ties",
        "false alarms",
        LEVEL,
        _log_rank,
    ),
]
