"""Fitness against frequency: is the rarer of two groups fitter?

Worlds start with several shares of the first group. If its selection coefficient per generation at share p is
s(p) = a + b·p, the share changes by s(p)·p(1 − p) per generation, with noise whose variance is proportional to
p(1 − p). The maximum-likelihood estimate for this diffusion solves

    Σ Δp  = a ΣV  + b ΣpV
    Σ pΔp = a ΣpV + b Σp²V,   V = p(1 − p)Δg

over the intervals of all worlds, with p at the start of each interval, so shares may change by any amount within a
world. Without b, this is the coefficient of `contest`, with its interval. The interval of the line comes from a
bootstrap over seeds. Worlds with the same seed and different shares start with the same positions, so they are
resampled together.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hedon.assay.contest import AtShare, Lines, at_share
from hedon.assay.resample import Estimate, Floats, bounded, world_draws, world_interval

COEXIST, EXCLUDE, NONE, OPEN = "coexist", "exclude", "none", "open"
VERDICTS = {
    COEXIST: "each group grows where it is rare: the crossing attracts",
    EXCLUDE: "each group grows where it is common: the crossing repels",
    NONE: "the same group grows at every share: there is no crossing",
    OPEN: "these worlds cannot tell",
}
GRID = 401
"""Number of shares at which the line's interval is tested for containing 0."""
_SEED = 20260803


@dataclass(frozen=True, eq=False)
class Frequency:
    """Fitness of the first of two groups against its frequency.

    Attributes:
        groups: Names of the groups.
        shares: Result at each starting share, in ascending order.
        slope: Slope of the selection coefficient over the share, per generation; if below 0, the rarer group is
            favored.
        crossing: Share at which the coefficient is 0, within the range of starting shares; NaN if there is none. Its
            bounds are the shares at which the line's interval contains 0.
        line: Shares, the line, and the bounds of its interval, shape (4, GRID).
        verdict: One of `VERDICTS`.
    """

    groups: tuple[str, str]
    shares: tuple[AtShare, ...]
    slope: Estimate
    crossing: Estimate
    line: Floats
    verdict: str


def estimate_frequency(groups: tuple[str, str], worlds: Mapping[float, Sequence[Lines]]) -> Frequency:
    """Estimates how the fitness of the first of two groups depends on its share.

    Args:
        groups: Names of the first and the second group.
        worlds: Numbers over time in the worlds that started with each share; two shares or more.
    """
    starts = sorted(worlds)
    seeds = sorted({lines.seed for start in starts for lines in worlds[start]})
    rng = np.random.default_rng(_SEED)
    draws = world_draws(len(seeds), rng)
    sums = np.zeros((len(starts), len(seeds), 5))
    for i, start in enumerate(starts):
        for lines in worlds[start]:
            sums[i, seeds.index(lines.seed)] += lines.sums
    totals = draws @ sums.sum(axis=0)
    change, weighted, variation, first, second = totals.T
    with np.errstate(divide="ignore", invalid="ignore"):
        determinant = variation * second - first**2
        slope = (variation * weighted - first * change) / determinant
        base = (second * change - first * weighted) / determinant
    share = np.linspace(starts[0], starts[-1], GRID)
    lines = base[:, None] + slope[:, None] * share
    low, high = world_interval(lines[1:], len(seeds))
    plausible = share[(low <= 0) & (high >= 0)]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = -base[0] / slope[0]
    in_range = starts[0] <= crossing <= starts[-1]
    bounds = (float(plausible[0]), float(plausible[-1])) if len(plausible) else (np.nan, np.nan)
    return Frequency(
        groups=groups,
        shares=tuple(at_share(start, worlds[start]) for start in starts),
        slope=bounded(slope, len(seeds)),
        crossing=Estimate(float(crossing) if in_range else np.nan, *bounds),
        line=np.stack([share, lines[0], low, high]),
        verdict=_verdict(low, high),
    )


def _verdict(low: Floats, high: Floats) -> str:
    """The verdict from the interval of the line: from its ends and, if it never crosses 0, from its whole length."""
    if (low > 0).all() or (high < 0).all():
        return NONE
    if low[0] > 0 and high[-1] < 0:
        return COEXIST
    return EXCLUDE if high[0] < 0 and low[-1] > 0 else OPEN
