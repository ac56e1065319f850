"""What a calibration is, how one is observed, and when a number holds its level."""

import math
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import stats

Kind = Literal["false alarms", "missed", "found", "bias"]
RARE = 1e-4
"""Chance with which a sound calibration may look unsound: each is observed anew in every test run."""
_SEED = 20261127


@dataclass(frozen=True)
class Calibration:
    """One number that hedon prints, and data of which the truth is known.

    Attributes:
        number: What is printed, by the words that users see: "drift, p of held".
        covers: What prints it, as keys of the coverage test: "topic:drift", "assay:compete", "verdict:mean lifetime".
        design: The data that are drawn, in one line: "3 to 10 worlds; the gene cannot change".
        kind: What `draw` counts. "false alarms": a test rejects though nothing is there. "missed": an interval leaves
            out the truth. "found": a known effect is found, as often as promised. "bias": the error of an estimate, as
            a share of its truth or scale.
        nominal: The rate that the number promises, 0.05 for a 95 % interval; 0 for a bias.
        draw: Simulates one data set and feeds it through the functions that users call. Returns whether the event of
            `kind` happened, or the error of an estimate; None if the number declines to answer (too few worlds).
        tolerance: How far the rate may lie on the harmful side of nominal: above it for false alarms and missed
            truths, below it for found effects, on either side for a bias.
        note: What users have to know if the level is off by more than two points; the page and the guide say it.
    """

    number: str
    covers: tuple[str, ...]
    design: str
    kind: Kind
    nominal: float
    draw: Callable[[np.random.Generator], float | bool | None]
    tolerance: float = 0.02
    note: str = ""

    @property
    def key(self) -> str:
        """Number and design, which together name a calibration."""
        return f"{self.number} | {self.design}"


@dataclass(frozen=True)
class Level:
    """What came of many simulations.

    Attributes:
        simulations: How many data sets were drawn.
        answered: In how many of them the number gave an answer.
        observed: Rate of the event among those, or mean error; NaN without answers.
        error: Its standard error.
    """

    simulations: int
    answered: int
    observed: float
    error: float


def observe(calibration: Calibration, simulations: int) -> Level:
    """Simulates data and counts; the same data for the same calibration, whatever else is observed.

    Args:
        calibration: The number and its design.
        simulations: Data sets to draw.
    """
    seed = np.random.SeedSequence([_SEED, zlib.crc32(calibration.key.encode())])
    results = [calibration.draw(np.random.default_rng(child)) for child in seed.spawn(simulations)]
    values = np.array([value for value in results if value is not None], np.float64)
    if not len(values):
        return Level(simulations, 0, math.nan, math.nan)
    spread = float(values.std(ddof=1)) if len(values) > 1 else math.nan
    return Level(simulations, len(values), float(values.mean()), spread / math.sqrt(len(values)))


def holds(calibration: Calibration, level: Level) -> bool:
    """Whether what was observed is compatible with the promise, within the tolerance.

    Rates are judged by an exact binomial test at the edge of the tolerance, a bias by its standard error.

    Args:
        calibration: The promise.
        level: What came of its simulations; one without answers holds nothing.
    """
    if not level.answered:
        return False
    if calibration.kind == "bias":
        slack = float(stats.norm.isf(RARE / 2)) * level.error
        return abs(level.observed - calibration.nominal) <= calibration.tolerance + slack
    events, side = round(level.observed * level.answered), "less" if calibration.kind == "found" else "greater"
    edge = calibration.nominal + (-1 if side == "less" else 1) * calibration.tolerance
    return bool(stats.binomtest(events, level.answered, min(max(edge, 0.0), 1.0), side).pvalue >= RARE)
