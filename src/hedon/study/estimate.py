"""Combines the figures of worlds into the estimate for a claim, with its interval."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hedon.analysis.gene.drift import standard_drift
from hedon.analysis.gene.weight import LAST_AGENTS
from hedon.analysis.world.record import WorldRecord
from hedon.statistic.contrast import difference_interval, spread_ratio_interval
from hedon.statistic.correction import holm
from hedon.statistic.drift import score_tests
from hedon.statistic.interval import LEVEL, distance_interval, exact_share_interval, mean_bounds, spread_interval
from hedon.statistic.mode import modes
from hedon.study.claim import Claim, Comparison
from hedon.text import p_phrase

Floats = NDArray[np.float64]

NAN = math.nan
_LEVEL = 0.05


@dataclass(frozen=True)
class ClaimEstimate:
    """The estimate for a claim.

    Attributes:
        value: The estimate; NaN if there is none.
        low, high: Bounds of its 95 % interval; NaN if there is none.
        verdict: Verdict of a test that decides in place of the interval; otherwise empty.
        reason: Remark for the reader.
    """

    value: float = NAN
    low: float = NAN
    high: float = NAN
    verdict: str = ""
    reason: str = ""


def estimate(claim: Claim, figures: Floats, worlds: Sequence[WorldRecord]) -> ClaimEstimate:
    """Combines the figures of some worlds as a claim specifies.

    Args:
        claim: The claim.
        figures: Figure of each world that has one, shape (n,).
        worlds: The worlds of the figures, for their neutral genes.
    """
    if len(figures) == 0:
        return ClaimEstimate()
    if claim.over_worlds == "modes":
        return _modes(figures)
    if claim.over_worlds == "walk":
        return _walk(figures)
    if claim.over_worlds == "share":
        count = int(np.count_nonzero(figures > 0))
        return ClaimEstimate(count / len(figures), *exact_share_interval(count, len(figures), claim.level))
    if claim.over_worlds == "setting":
        value = float(figures[0])
        return ClaimEstimate(value, value, value)
    if claim.over_worlds in ("spread", "distance"):
        return _against_neutral(claim, figures, worlds)
    logs = claim.over_worlds == "ratio"
    value, low, high = mean_bounds(np.log(figures[figures > 0]) if logs else figures)
    return ClaimEstimate(math.exp(value), math.exp(low), math.exp(high)) if logs else ClaimEstimate(value, low, high)


def _modes(values: Floats) -> ClaimEstimate:
    """With two modes the claim holds. It never fails, since finding no second mode does not show that there is one."""
    result = modes(values)
    power = f"power {result.power:.2f}"
    if result.answer == "two":
        sides = f"{result.low_worlds} worlds around {result.low:.2f}, {result.high_worlds} around {result.high:.2f}"
        return ClaimEstimate(verdict="holds", reason=f"{sides}; dip test: {p_phrase(result.p)}, {power}")
    return ClaimEstimate(verdict="undecided", reason=f"dip test: {p_phrase(result.p)}, {power} to find two clear modes")


def _walk(scores: Floats) -> ClaimEstimate:
    """Whether scores differ from those of neutral genes, in a common direction or in their distance from the middle.

    The two tests are corrected for each other. The claim never fails, since a negative result does not show that the
    weight drifts.
    """
    direction, distance, held = score_tests(scores)
    p_direction, p_distance = holm([direction.p, min(1.0, 2.0 * min(held.p, distance.p))])
    return ClaimEstimate(
        direction.effect,
        direction.drift_low,
        direction.drift_high,
        "holds" if min(p_direction, p_distance) <= _LEVEL else "undecided",
        f"against neutral walks: {p_phrase(p_direction)} for a direction, {p_phrase(p_distance)} for a distance",
    )


def _against_neutral(claim: Claim, scores: Floats, worlds: Sequence[WorldRecord]) -> ClaimEstimate:
    """Spread or distance of scores, 1 for a neutral gene; undecided if recorded neutral genes have another value."""
    if claim.over_worlds == "spread":
        if len(scores) < 2:
            return ClaimEstimate()
        value, low, high = spread_interval(scores)
    else:
        value, low, high = distance_interval(scores)
    drifts = [(world, drift) for world in worlds for drift in standard_drift(world, LAST_AGENTS)]
    neutral = np.array([drift.score for world, drift in drifts if drift.weight in world.neutral_names], np.float64)
    if len(neutral) < 2:
        return ClaimEstimate(value, low, high)
    control = distance_interval(neutral)
    control_text = "recorded neutral genes: {:.2f} ({:.2f} … {:.2f})".format(*control)
    if control[1] <= 1.0 <= control[2]:
        return ClaimEstimate(value, low, high, reason=control_text)
    return ClaimEstimate(value, low, high, "undecided", f"{control_text}, which differ from the walks")


def compare(
    comparison: Comparison, values: NDArray[np.float64], others: NDArray[np.float64], level: float = LEVEL
) -> tuple[float, float, float]:
    """Compares two groups, with an interval; two values or more in each, above 0 for a "ratio".

    Args:
        comparison: "difference" of means, "ratio" of geometric means, or "spread", a ratio of standard deviations.
        values: The first group, shape (n,).
        others: The second group, shape (m,).
        level: Confidence level.

    Returns:
        The estimate, lower and upper bound.
    """
    if comparison == "spread":
        return spread_ratio_interval(values, others, level)
    if comparison == "ratio":
        value, low, high = (math.exp(x) for x in difference_interval(np.log(values), np.log(others), level))
        return value, low, high
    return difference_interval(values, others, level)
