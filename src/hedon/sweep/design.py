"""Computes the conditions of a sweep: factors are crossed, zipped, or drawn by Latin hypercube or Sobol sequence."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

from hedon.ensemble.condition import Settings
from hedon.sweep.factor import Factor

LATIN, SOBOL = "latin", "sobol"
DRAWS = (LATIN, SOBOL)


@dataclass(frozen=True)
class Design:
    """How factors are combined.

    Attributes:
        draw: How values are drawn from ranges, one of `DRAWS`.
        points: Number of points to draw; 0 if no factor has a range.
        seed: Seed of the points, and of the order of conditions.
        zipped: Groups of factors that vary together, value by value.
    """

    draw: str = SOBOL
    points: int = 0
    seed: int = 1
    zipped: tuple[tuple[str, ...], ...] = ()


def all_settings(factors: Sequence[Factor], design: Design) -> list[Settings]:
    """All combinations of values: groups of zipped factors, drawn points and all other factors are crossed.

    Args:
        factors: The factors of the sweep.
        design: How they are combined.

    Returns:
        The values of each combination; one empty combination if there are no factors.
    """
    groups = [[{}]]
    zipped_names = {name for group in design.zipped for name in group}
    by_name = {factor.name: factor for factor in factors}
    for factor in factors:
        group = next((group for group in design.zipped if factor.name == group[0]), None)
        if group is not None:
            rows = zip(*(by_name[name].values for name in group), strict=True)
            groups.append([dict(zip(group, row, strict=True)) for row in rows])
        elif factor.values and factor.name not in zipped_names:
            groups.append([{factor.name: value} for value in factor.values])
    drawn_factors = [factor for factor in factors if factor.drawn]
    if drawn_factors:
        groups.append(_draw(drawn_factors, design))
    names = [factor.name for factor in factors]
    combined = [{name: value for part in parts for name, value in part.items()} for parts in product(*groups)]
    return [{name: settings[name] for name in names} for settings in combined]


def _draw(factors: Sequence[Factor], design: Design) -> list[Settings]:
    """Evenly spread points in the ranges of some factors; equal seeds give equal points."""
    from scipy.stats import qmc

    kind = {LATIN: qmc.LatinHypercube, SOBOL: qmc.Sobol}[design.draw]
    with warnings.catch_warnings():
        # Sobol points are most even if their number is a power of 2, as the guide explains; this needs no warning.
        warnings.simplefilter("ignore", UserWarning)
        shares = kind(d=len(factors), seed=design.seed).random(design.points).tolist()
    return [{factor.name: factor.at(share) for factor, share in zip(factors, row, strict=True)} for row in shares]
