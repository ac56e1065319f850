"""How long do agents live, counting those who still live? Kaplan & Meier (1958).

An agent that lives when the records end has a lifetime of which only a lower bound is known: it is *censored*.
Leaving it out, as a mean over the dead does, makes lives too short, since the long lives are those cut off.
The estimator assumes that being cut off tells nothing about the rest of the life. Here that fails only where
chances of death drift over the run, because those cut off were born last.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL
from hedon.statistic.law import normal_quantile

AT_RISK = 20
"""Agents that must have reached an age for the curve to be read there: beyond, it is made of a few lives."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SurvivalCurve:
    """The share of the newborn that reach an age.

    Attributes:
        age: ages at which somebody died [step], ascending, shape (k,).
        share: that live on after each age, shape (k,).
        low, high: bounds of its pointwise interval, Greenwood's variance on the log-log scale; NaN where
            nobody is left at risk; shape (k,).
        at_risk: agents known to reach each age, shape (k,).
        deaths: at each age, shape (k,).
    """

    age: Floats
    share: Floats
    low: Floats
    high: Floats
    at_risk: NDArray[np.int64]
    deaths: NDArray[np.int64]

    def trusted_age(self, at_risk: int = AT_RISK) -> float:
        """The largest age at death that at least `at_risk` agents reached [step]; 0 where there is none."""
        reached = self.age[self.at_risk >= at_risk]
        return float(reached[-1]) if len(reached) else 0.0

    def quantile(self, share: float = 0.5) -> tuple[float | None, float | None, float | None]:
        """The age that a share of the newborn does not reach, with its interval [step]; None beyond the record.

        The interval holds the ages at which the curve's own interval holds 1 − share (Brookmeyer & Crowley
        1982).
        """
        level = 1.0 - share
        return (
            self._first_below(self.share, level),
            self._first_below(self.low, level),
            self._first_below(self.high, level),
        )

    def _first_below(self, curve: Floats, level: float) -> float | None:
        below = self.age[curve <= level]
        return float(below[0]) if len(below) else None


@dataclass(frozen=True)
class RestrictedMean:
    """The mean of min(lifetime, until).

    Attributes:
        mean: [step].
        error: its standard error [step], agents taken as independent.
        until: [step].
    """

    mean: float
    error: float
    until: float


def survival_curve(duration: Floats, died: NDArray[np.bool_], level: float = LEVEL) -> SurvivalCurve:
    """The product-limit estimate, as `scipy.stats.ecdf` gives it, which takes half a second to load.

    Args:
        duration: lifetime, or age when last seen [step], shape (n,).
        died: whether it is a lifetime, shape (n,). An agent last seen at an age at which others die
            counts as at risk there.
        level: of the pointwise interval.
    """
    age, deaths = np.unique(duration[died], return_counts=True)
    if len(age) == 0:
        none = np.empty(0)
        return SurvivalCurve(none, none, none, none, np.empty(0, np.int64), np.empty(0, np.int64))
    at_risk = len(duration) - np.searchsorted(np.sort(duration), age, side="left")
    left = at_risk - deaths
    share = np.cumprod(left / at_risk, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):  # NaN where nobody is left, as documented above
        error = np.sqrt(np.cumsum(deaths / (at_risk * left))) / np.abs(np.log(share))
        wide = normal_quantile((1 + level) / 2) * error
        low, high = (np.asarray(share ** np.exp(sign * wide), np.float64) for sign in (1, -1))
    return SurvivalCurve(age, share, low, high, at_risk, deaths)


def restricted_mean(curve: SurvivalCurve, until: float) -> RestrictedMean:
    """The area under the curve from birth to an age [step], with Greenwood's variance.

    Its variance is the sum over ages at death of (area right of the age)² · d/(n·(n − d)).

    Args:
        curve: share alive by age.
        until: the age where the area ends [step].
    """
    within = curve.age < until
    age, share = curve.age[within], curve.share[within]
    steps = np.diff(np.concatenate([[0.0], age, [until]]))
    areas = steps * np.concatenate([[1.0], share])
    beyond = np.cumsum(areas[::-1])[::-1][1:]  # area right of each age
    n, d = curve.at_risk[within].astype(np.float64), curve.deaths[within].astype(np.float64)
    left = n > d
    variance = np.sum(beyond[left] ** 2 * d[left] / (n[left] * (n[left] - d[left])))
    return RestrictedMean(float(areas.sum()), float(np.sqrt(variance)), float(until))


def exposure_mean(duration: Floats, died: NDArray[np.bool_]) -> float | None:
    """Steps lived by all over deaths [step]: the mean lifetime if the chance of death did not depend on age.

    Args:
        duration: how long each was seen [step], (n,).
        died: whether its life ended then, (n,).

    Returns:
        None where nobody died.
    """
    deaths = int(died.sum())
    return float(duration.sum()) / deaths if deaths else None
