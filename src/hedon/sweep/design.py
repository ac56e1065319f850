"""Which settings a sweep has: factors crossed, zipped, or drawn by a Latin hypercube or a Sobol sequence."""

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
    """How factors are put together.

    Attributes:
        draw: how values are drawn from ranges, one of `DRAWS`.
        points: how many are drawn; 0 where nothing is.
        seed: of the draw, and of the order of settings.
        zipped: groups of factors that go together, value by value.
    """

    draw: str = SOBOL
    points: int = 0
    seed: int = 1
    zipped: tuple[tuple[str, ...], ...] = ()


def all_settings(factors: Sequence[Factor], design: Design) -> list[Settings]:
    """Every combination: groups of zipped factors and all others are crossed, what is drawn from ranges too.

    Returns:
        Without factors, one empty setting.
    """
    groups = [[{}]]
    taken = {name for group in design.zipped for name in group}
    by_name = {factor.name: factor for factor in factors}
    for factor in factors:
        group = next((group for group in design.zipped if factor.name == group[0]), None)
        if group is not None:
            rows = zip(*(by_name[name].values for name in group), strict=True)
            groups.append([dict(zip(group, row, strict=True)) for row in rows])
        elif factor.values and factor.name not in taken:
            groups.append([{factor.name: value} for value in factor.values])
    drawn = [factor for factor in factors if factor.drawn]
    if drawn:
        groups.append(_draw(drawn, design))
    names = [factor.name for factor in factors]
    combined = [{name: value for part in parts for name, value in part.items()} for parts in product(*groups)]
    return [{name: settings[name] for name in names} for settings in combined]


def _draw(factors: Sequence[Factor], design: Design) -> list[Settings]:
    """Points in the ranges of some factors: spread evenly, and the same for the same seed."""
    from scipy.stats import qmc

    kind = {LATIN: qmc.LatinHypercube, SOBOL: qmc.Sobol}[design.draw]
    with warnings.catch_warnings():
        # Sobol's points are most even where their number is a power of 2; the guide says so.
        warnings.simplefilter("ignore", UserWarning)
        shares = kind(d=len(factors), seed=design.seed).random(design.points).tolist()
    return [{factor.name: factor.at(share) for factor, share in zip(factors, row, strict=True)} for row in shares]
