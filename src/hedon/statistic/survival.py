"""How long do agents live, counting those still alive? The Kaplan–Meier estimate (1958).

If an agent is alive when the records end, only a lower bound of its lifetime is known: the lifetime is *censored*.
Leaving such agents out, as a mean over the dead does, makes lifetimes too short, since it is long lives that are cut
off. The estimator assumes that censoring is unrelated to the rest of the life. Here this fails only if the
chance of death changes in the course of the run, because censored agents were born last.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.statistic.interval import LEVEL
from hedon.statistic.law import normal_quantile

AT_RISK = 20
"""Number of agents that must reach an age for the curve to be trusted there; beyond, it rests on a few lives."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SurvivalCurve:
    """The share of the newborn that reach an age.

    Attributes:
        age: Ages at which agents died [step], in ascending order, shape (k,).
        share: Share that survives each age, shape (k,).
        low, high: Bounds of its pointwise interval, from Greenwood's variance on the log-log scale; NaN if
            no agent remains at risk; shape (k,).
        at_risk: Number of agents known to reach each age, shape (k,).
        deaths: Number of deaths at each age, shape (k,).
    """

    age: Floats
    share: Floats
    low: Floats
    high: Floats
    at_risk: NDArray[np.int64]
    deaths: NDArray[np.int64]

    def trusted_age(self, at_risk: int = AT_RISK) -> float:
        """The largest age at death that at least `at_risk` agents reached [step]; 0 if there is none."""
        ages = self.age[self.at_risk >= at_risk]
        return float(ages[-1]) if len(ages) else 0.0

    def quantile(self, share: float = 0.5) -> tuple[float | None, float | None, float | None]:
        """The age by which a share of the newborn has died, with its interval [step]; None beyond the record.

        The interval contains the ages at which the curve's own interval contains 1 − share (Brookmeyer & Crowley
        1982).
        """
        level = 1.0 - share
        return (
            self._first_below(self.share, level),
            self._first_below(self.low, level),
            self._first_below(self.high, level),
        )

    def _first_below(self, curve: Floats, level: float) -> float | None:
        ages = self.age[curve <= level]
        return float(ages[0]) if len(ages) else None


@dataclass(frozen=True)
class RestrictedMean:
    """The mean of min(lifetime, until).

    Attributes:
        mean: The mean [step].
        error: Its standard error [step], assuming independent agents.
        until: The age limit [step].
    """

    mean: float
    error: float
    until: float


def survival_curve(duration: Floats, died: NDArray[np.bool_], level: float = LEVEL) -> SurvivalCurve:
    """The product-limit estimate, equal to that of `scipy.stats.ecdf`, which takes half a second to load.

    Args:
        duration: Lifetime of each agent, or its age when last seen [step], shape (n,).
        died: Whether the duration is a lifetime, shape (n,). An agent last seen at an age at which others die
            counts as at risk there.
        level: Confidence level of the pointwise interval.
    """
    age, deaths = np.unique(duration[died], return_counts=True)
    if len(age) == 0:
        none = np.empty(0)
        return SurvivalCurve(none, none, none, none, np.empty(0, np.int64), np.empty(0, np.int64))
    at_risk = len(duration) - np.searchsorted(np.sort(duration), age, side="left")
    survivors = at_risk - deaths
    share = np.cumprod(survivors / at_risk, dtype=np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):  # NaN if no agent remains, as documented
        error = np.sqrt(np.cumsum(deaths / (at_risk * survivors))) / np.abs(np.log(share))
        half_width = normal_quantile((1 + level) / 2) * error
        low, high = (np.asarray(share ** np.exp(sign * half_width), np.float64) for sign in (1, -1))
    return SurvivalCurve(age, share, low, high, at_risk, deaths)


def restricted_mean(curve: SurvivalCurve, until: float) -> RestrictedMean:
    """The area under the curve from birth to an age [step], with Greenwood's variance.

    Its variance is the sum over ages at death of (area right of the age)² · d/(n·(n − d)).

    Args:
        curve: Share alive by age.
        until: Age at which the area ends [step].
    """
    is_within = curve.age < until
    age, share = curve.age[is_within], curve.share[is_within]
    steps = np.diff(np.concatenate([[0.0], age, [until]]))
    areas = steps * np.concatenate([[1.0], share])
    area_beyond = np.cumsum(areas[::-1])[::-1][1:]  # area right of each age
    n, d = curve.at_risk[is_within].astype(np.float64), curve.deaths[is_within].astype(np.float64)
    alive = n > d
    variance = np.sum(area_beyond[alive] ** 2 * d[alive] / (n[alive] * (n[alive] - d[alive])))
    return RestrictedMean(float(areas.sum()), float(np.sqrt(variance)), float(until))


def exposure_mean(duration: Floats, died: NDArray[np.bool_]) -> float | None:
    """Steps lived by all agents per death [step]: the mean lifetime if the chance of death did not depend on age.

    Args:
        duration: How long each agent was seen [step], shape (n,).
        died: Whether its life ended then, shape (n,).

    Returns:
        The mean; None if no agent died.
    """
    deaths = int(died.sum())
    return float(duration.sum()) / deaths if deaths else None
