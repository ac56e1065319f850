"""Quantiles and tails of common distributions.

Computed with `scipy.special`; the results are bit-identical to `scipy.stats`, which takes half a second to load.
"""

from typing import Any

from lazy_loader import load

special: Any = load("scipy.special", suppress_warning=True)  # takes a fifth of a second to load


def normal_quantile(share: float) -> float:
    """The value below which a share of a standard normal distribution lies."""
    return float(special.ndtri(share))


def normal_below(value: float) -> float:
    """The share of a standard normal distribution below a value."""
    return float(special.ndtr(value))


def normal_above(value: float) -> float:
    """The share of a standard normal distribution above a value."""
    return float(special.ndtr(-value))


def t_quantile(share: float, degrees: float) -> float:
    """The value below which a share of Student's t distribution with some degrees of freedom lies."""
    return float(special.stdtrit(degrees, share))


def t_above(value: float, degrees: float) -> float:
    """The share of Student's t distribution with some degrees of freedom above a value."""
    return float(special.stdtr(degrees, -value))


def chi2_quantile(share: float, degrees: float) -> float:
    """The value below which a share of a χ² distribution with some degrees of freedom lies."""
    return 2.0 * float(special.gammaincinv(degrees / 2, share))


def chi2_below(value: float, degrees: float) -> float:
    """The share of a χ² distribution with some degrees of freedom below a value."""
    return float(special.chdtr(degrees, value))


def chi2_above(value: float, degrees: float) -> float:
    """The share of a χ² distribution with some degrees of freedom above a value."""
    return float(special.chdtrc(degrees, value))


def beta_quantile(share: float, a: float, b: float) -> float:
    """The value below which a share of the beta distribution with parameters a and b lies."""
    return float(special.betaincinv(a, b, share))


def beta_below(value: float, a: float, b: float) -> float:
    """The share of the beta distribution with parameters a and b below a value."""
    return float(special.betainc(a, b, value))
