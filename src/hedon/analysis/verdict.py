"""Do the paper's claims hold in these runs? The rules stand in `claim`; here they are applied."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy import stats

from hedon.analysis.claim import CLAIMS, SOURCE, Claim
from hedon.analysis.interval import LEVEL, mean_interval
from hedon.analysis.mode import modes
from hedon.analysis.world import WorldRecord, by_condition
from hedon.config import Config, digest, load_config

HOLDS, FAILS, UNDECIDED = "holds", "fails", "undecided"
FEWEST_WORLDS = 3


@dataclass(frozen=True)
class Verdict:
    """What some worlds of one condition say of one claim.

    Attributes:
        claim: its name.
        condition: whose worlds were asked.
        verdict: "holds", "fails" or "undecided".
        value: our figure; NaN where there is none, as its bounds.
        low, high: bounds of its 95 % interval.
        paper: what the paper reports.
        worlds: that the figure is made of.
        reason: why it is undecided, or what else a reader must know.
        text: the claim in words.
        region_low, region_high: where it holds.
        source: where it stands.
    """

    claim: str
    condition: str
    verdict: str
    value: float
    low: float
    high: float
    paper: str
    worlds: int
    reason: str
    text: str
    region_low: float
    region_high: float
    source: str = SOURCE


def verdicts(worlds: Iterable[WorldRecord], claims: Sequence[Claim] = CLAIMS) -> list[Verdict]:
    """A verdict for each condition and each claim that is about it.

    A condition is what a claim is about if its settings are those of the claim's preset, with any fidelity,
    and nothing else is changed.
    """
    return [
        judge(claim, condition, group)
        for condition, group in by_condition(worlds).items()
        for claim in claims
        if digest(group[0].config) == _digest(claim, group[0].config)
    ]


def judge(claim: Claim, condition: str, worlds: Sequence[WorldRecord]) -> Verdict:
    """Applies a claim's rule to worlds of one condition."""
    asked = [world for world in worlds if world.extinct_step is None] if claim.survivors else list(worlds)
    long_enough = [world for world in asked if _is_long_enough(claim, world)]
    used = long_enough or asked
    figures = np.array([figure for world in used if (figure := claim.measure(world)) is not None], np.float64)
    value, low, high, name, reason = _over_worlds(claim, figures)
    if len(figures) < FEWEST_WORLDS:
        name, reason = UNDECIDED, f"fewer than {FEWEST_WORLDS} worlds"
    elif not long_enough:
        reach = max(world.last_step for world in used)
        name, reason = UNDECIDED, f"the worlds reach {reach:,} of {claim.steps:,} steps"
    if left_out := len(worlds) - len(asked):
        reason = "; ".join(filter(None, [reason, f"{left_out} extinct left out, as in the paper"]))
    return Verdict(
        claim.name,
        condition,
        name,
        value,
        low,
        high,
        claim.paper,
        len(figures),
        reason,
        claim.text,
        claim.low,
        claim.high,
    )


def place(low: float, high: float, region_low: float, region_high: float) -> str:
    """Where an interval lies: within the region, outside of it, or across its border (or without bounds)."""
    if region_low < low and high < region_high:
        return HOLDS
    if high < region_low or low > region_high:
        return FAILS
    return UNDECIDED


def share_interval(count: int, of: int, level: float = LEVEL) -> tuple[float, float]:
    """Clopper & Pearson's (1934) interval of a share: covers at least as often as promised, for any number."""
    tail = 0.5 * (1.0 - level)
    low = float(stats.beta.ppf(tail, count, of - count + 1)) if count else 0.0
    high = float(stats.beta.ppf(1.0 - tail, count + 1, of - count)) if count < of else 1.0
    return low, high


def spread_interval(values: np.ndarray, level: float = LEVEL) -> tuple[float, float, float]:
    """Standard deviation and its interval from the chi-squared law, if the values are normally distributed."""
    n, tail = len(values), 0.5 * (1.0 - level)
    sd = float(values.std(ddof=1))
    low, high = (sd * math.sqrt((n - 1) / stats.chi2.ppf(q, n - 1)) for q in (1.0 - tail, tail))
    return sd, low, high


def _over_worlds(claim: Claim, figures: np.ndarray) -> tuple[float, float, float, str, str]:
    """Value, bounds, verdict and remark."""
    nan = math.nan
    if len(figures) == 0:
        return nan, nan, nan, UNDECIDED, ""
    if claim.over_worlds == "modes":
        found = modes(figures)
        name = {"two": HOLDS, "one": FAILS}.get(found.answer, UNDECIDED)
        if found.answer == "two":
            remark = f"{found.low_worlds} worlds around {found.low:.2f}, {found.high_worlds} around {found.high:.2f}"
        else:
            remark = f"dip test: p {found.p:.2f}; it would find two clear modes with chance {found.power:.2f}"
        return nan, nan, nan, name, remark
    if claim.over_worlds == "share":
        count = int(np.count_nonzero(figures > 0))
        value, (low, high) = count / len(figures), share_interval(count, len(figures))
    elif len(figures) < 2:
        value, low, high = float(figures[0]) if claim.over_worlds != "spread" else nan, nan, nan
    elif claim.over_worlds == "spread":
        value, low, high = spread_interval(figures)
    else:
        logs = claim.over_worlds == "ratio"
        interval = mean_interval(np.log(figures[figures > 0]) if logs else figures)
        bounds = [nan if x is None else float(x) for x in (interval.mean, interval.low, interval.high)]
        value, low, high = (math.exp(x) for x in bounds) if logs else bounds
    name = place(low, high, claim.low, claim.high)
    return value, low, high, name, "the interval crosses the border" if name == UNDECIDED else ""


def _is_long_enough(claim: Claim, world: WorldRecord) -> bool:
    return world.last_step >= claim.steps or (world.extinct_step is not None and not claim.survivors)


def _digest(claim: Claim, config: Config) -> str:
    return _claim_digest(claim.preset, config.fidelity, claim.costs)


@cache
def _claim_digest(preset: str, fidelity: str, costs: tuple[float, float] | None) -> str:
    config = load_config(preset, fidelity)
    if costs is not None:
        config = replace(config, energy=replace(config.energy, basic_cost=costs[0], action_cost=costs[1]))
    return digest(config)
