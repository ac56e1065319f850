"""Fitness against frequency: is the rarer of two groups the fitter one?

Worlds begin with several shares of the first group. If its selection coefficient per generation at share p is
s(p) = a + b·p, the share drifts by s(p)·p(1 − p) per generation with a noise of variance proportional to p(1 − p). The
maximum-likelihood estimate of that diffusion solves

    Σ Δp  = a ΣV  + b ΣpV
    Σ pΔp = a ΣpV + b Σp²V,   V = p(1 − p)Δg

over the intervals of all worlds, with p at the beginning of each: so shares may move as far as they like within a
world. Without b it is the coefficient of `contest`, with its interval. That of the line comes from a bootstrap over
seeds: worlds of one seed with several shares begin with the same places, so they are drawn together.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hedon.assay.contest import Lines
from hedon.assay.resample import (
    Estimate,
    Floats,
    bounded,
    diffusion_strength,
    share_estimate,
    world_draws,
    world_interval,
)

COEXIST, EXCLUDE, NONE, OPEN = "coexist", "exclude", "none", "open"
VERDICTS = {
    COEXIST: "each group grows where it is rare: the crossing attracts",
    EXCLUDE: "each group grows where it is common: the crossing repels",
    NONE: "the same group grows at every share: there is no crossing",
    OPEN: "these worlds cannot tell",
}
GRID = 401
"""Shares at which the line's interval is asked for 0."""
_SEED = 20260803


@dataclass(frozen=True, eq=False)
class AtShare:
    """How two groups fared in worlds that began with one share.

    Attributes:
        start: share of the first group among the founders.
        share: its mean over the worlds' generations, weighted by p(1 − p); NaN if it never varied.
        selection: coefficient of the first group per generation.
        end: share at the end, mean over worlds.
        worlds: how many.
        extinct: how many of them died out; they count for as long as they lived.
        fixed, lost: worlds in which only the first, or only the second group was left.
        generations: mean over worlds, at the end.
    """

    start: float
    share: float
    selection: Estimate
    end: Estimate
    worlds: int
    extinct: int
    fixed: int
    lost: int
    generations: float


@dataclass(frozen=True, eq=False)
class Frequency:
    """Fitness of the first of two groups against its frequency.

    Attributes:
        groups: their names.
        shares: what was found at each, in ascending order.
        slope: of the selection coefficient over the share, per generation: below 0, the rarer group is favored.
        crossing: share at which the coefficient is 0, within the shares that worlds began with; NaN if there is none.
            Its bounds are the shares at which the line's interval has 0.
        line: shares, the line, and the bounds of its interval, (4, GRID).
        verdict: one of `VERDICTS`.
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
        groups: names of the first and the second group.
        worlds: numbers over time of the worlds that began with each share, two shares or more.
    """
    starts = sorted(worlds)
    seeds = sorted({lines.seed for start in starts for lines in worlds[start]})
    rng = np.random.default_rng(_SEED)
    draws = np.concatenate([np.ones((1, len(seeds))), world_draws(len(seeds), rng)])
    sums = np.zeros((len(starts), len(seeds), 5))
    for i, start in enumerate(starts):
        for lines in worlds[start]:
            sums[i, seeds.index(lines.seed)] += _sums(lines)
    found = tuple(_at_share(start, worlds[start], sums[i]) for i, start in enumerate(starts))
    whole = draws @ sums.sum(axis=0)
    change, weighted, variation, first, second = whole.T
    with np.errstate(divide="ignore", invalid="ignore"):
        determinant = variation * second - first**2
        slope = (variation * weighted - first * change) / determinant
        base = (second * change - first * weighted) / determinant
    share = np.linspace(starts[0], starts[-1], GRID)
    lines = base[:, None] + slope[:, None] * share
    low, high = world_interval(lines[1:], len(seeds))
    within = share[(low <= 0) & (high >= 0)]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = -base[0] / slope[0]
    known = starts[0] <= crossing <= starts[-1]
    bounds = (float(within[0]), float(within[-1])) if len(within) else (np.nan, np.nan)
    return Frequency(
        groups=groups,
        shares=found,
        slope=bounded(slope[0], slope[1:], len(seeds)),
        crossing=Estimate(float(crossing) if known else np.nan, *bounds),
        line=np.stack([share, lines[0], low, high]),
        verdict=_verdict(low, high),
    )


def _sums(lines: Lines) -> Floats:
    """Sums over the intervals of one world: Δp, pΔp, V, pV and p²V, with p at their beginnings and V = p(1 − p)Δg."""
    share, change = lines.share[:-1], np.diff(lines.share)
    variation = share * (1.0 - share) * np.diff(lines.generation)
    parts = (change, share * change, variation, share * variation, share**2 * variation)
    return np.array([part.sum() for part in parts])


def _at_share(start: float, worlds: Sequence[Lines], sums: Floats) -> AtShare:
    """What worlds of one share tell; `sums` are those of each seed."""
    _, _, variation, first, _ = sums.sum(axis=0)
    ends = np.array([lines.share[-1] for lines in worlds])
    mean = first / variation if variation > 0 else np.nan
    parts = [(np.diff(lines.share), lines.variation) for lines in worlds]
    change, varied = (np.concatenate(part) for part in zip(*parts, strict=True))
    return AtShare(
        start=start,
        share=float(mean),
        selection=diffusion_strength(change, varied, len(worlds)),
        end=share_estimate(ends),
        worlds=len(worlds),
        extinct=sum(lines.ended for lines in worlds),
        fixed=int((ends == 1).sum()),
        lost=int((ends == 0).sum()),
        generations=float(np.mean([lines.generation[-1] for lines in worlds])),
    )


def _verdict(low: Floats, high: Floats) -> str:
    """What the interval of the line tells, from its ends and, for no crossing, all along."""
    if (low > 0).all() or (high < 0).all():
        return NONE
    if low[0] > 0 and high[-1] < 0:
        return COEXIST
    return EXCLUDE if high[0] < 0 and low[-1] > 0 else OPEN
