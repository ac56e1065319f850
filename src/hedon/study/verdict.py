"""Do a study's claims hold in these runs? Applies the rules of the claims.

There are two separate questions. *Does the claim hold here?* is answered by comparing the interval of our figure with
the region of the claim. *Do we differ from its source?* is answered by a two-sample test, if the source reports a count
of worlds. For means it cannot be answered without their spread.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from itertools import product

import numpy as np
from numpy.typing import NDArray

from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.world.extinction import species_loss, world_extinction
from hedon.analysis.world.record import Conditions, WorldRecord, by_condition
from hedon.error import failure
from hedon.statistic.contrast import fisher_mid_p
from hedon.statistic.minimum import FOR_FULL_LENGTH
from hedon.study.catalogue import installed
from hedon.study.claim import Claim, Order
from hedon.study.estimate import ClaimEstimate, compare, estimate

HOLDS, FAILS, UNDECIDED = "holds", "fails", "undecided"
DIFFERS, NOT_SHOWN = "differs", "no difference shown"
NO_SPREAD, NO_COUNT = "the source gives no spread", "the source gives no count"
FAILED = "its measure failed: "
"""The start of the reason of a claim whose measure raised an error."""
TOO_FEW, CROSSES = f"fewer than {FOR_FULL_LENGTH} worlds", "the interval crosses the border"
LEVEL = 0.05
"""Significance level of the second question."""
_NOTE = (
    "verdict: the 95 % interval over worlds lies within the region in which the claim holds, outside of it, or "
    "across its border. Fewer than six worlds, or shorter ones than the claim asks for, decide nothing. "
    "against_reported is another question: whether our share differs from the source's count, by p_reported (mid-p "
    "Fisher). That no difference is shown does not mean that there is none. Where a source gives no spread, means "
    "cannot be compared."
)
_UNTESTABLE = {"mean": NO_SPREAD, "ratio": NO_SPREAD, "setting": ""}
"""Why the second question cannot be answered, by the way worlds are combined; a setting is the same in every world."""


@dataclass(frozen=True)
class Verdict:
    """The verdict of some worlds of one or two conditions on one claim.

    Attributes:
        claim: Name of the claim.
        condition: The condition whose worlds were tested, or two with "against" between them.
        verdict: "holds", "fails" or "undecided".
        value: Our figure; NaN if there is none.
        low, high: Bounds of its 95 % interval; NaN if there is none.
        reported: What the source reports.
        p_reported: p value of the difference between our share and the source's; NaN if it cannot be computed.
        against_reported: "differs", "no difference shown", or why the question cannot be answered.
        worlds: Number of worlds behind the figure.
        reason: Why the claim is undecided, and further remarks.
        text: The claim, in words.
        region_low, region_high: The region in which the claim holds.
        source: Where the source makes the claim.
    """

    claim: str
    condition: str
    verdict: str
    value: float
    low: float
    high: float
    reported: str
    p_reported: float
    against_reported: str
    worlds: int
    reason: str
    text: str
    region_low: float
    region_high: float
    source: str


def verdict(conditions: Conditions, claims: Iterable[Claim | Order] | None = None) -> list[ResultTable]:
    """The verdicts on all claims about the conditions of some worlds.

    Args:
        conditions: Worlds by condition.
        claims: Claims to judge; None for the claims in all installed studies.
    """
    if claims is None:
        claims = (claim for study in installed()[0].values() for claim in study.claims)
    return [verdict_table(verdicts((world for worlds in conditions.values() for world in worlds), claims))]


def verdict_table(judged: Iterable[Verdict]) -> ResultTable:
    """The table of some verdicts."""
    return make_table("verdict", "Claims about these conditions", [asdict(row) for row in judged], _NOTE)


def verdicts(worlds: Iterable[WorldRecord], claims: Iterable[Claim | Order]) -> list[Verdict]:
    """A verdict for each condition and each claim about it, then for each pair of conditions and each claim about two.

    A condition matches a claim if it has exactly the settings of the claim's condition, with any fidelity. If a claim's
    measure fails, the claim is undecided, and the reason is the error.
    Two conditions are compared if their fidelity is the same.

    Args:
        worlds: Worlds of any conditions.
        claims: Claims about one condition or two.
    """
    groups, claim_list = by_condition(worlds), list(claims)
    single_verdicts = [
        _guarded(claim, name, partial(judge, claim, name, group))
        for name, group in groups.items()
        for claim in claim_list
        if isinstance(claim, Claim) and claim.condition.is_of(group[0])
    ]
    pair_verdicts = [
        _guarded(order, _both(first, second), partial(judge_order, order, first, second))
        for order in claim_list
        if isinstance(order, Order)
        for first, second in product(groups.values(), repeat=2)
        if order.first.is_of(first[0])
        and order.second.is_of(second[0])
        and first[0].config.fidelity == second[0].config.fidelity
    ]
    return single_verdicts + pair_verdicts


def judge(claim: Claim, condition: str, worlds: Sequence[WorldRecord]) -> Verdict:
    """Applies a claim's rule to worlds of one condition."""
    if claim.over_worlds == "extinction":
        return _judge_extinction(claim, condition, worlds)
    used_worlds, shortfall, remarks = _assessed(claim, worlds)
    values = _figures(claim, used_worlds)
    result = estimate(claim, values, used_worlds)
    name = result.verdict or place(result.low, result.high, claim.low, claim.high)
    reason = result.reason or (CROSSES if name == UNDECIDED and len(values) else "")
    if claim.over_worlds == "setting":
        remarks = []
    elif shortcomings := _shortcomings(len(values), shortfall):
        name, reason = UNDECIDED, shortcomings
    p, against = math.nan, _UNTESTABLE.get(claim.over_worlds, NO_COUNT)
    if claim.over_worlds == "share":
        p, against = _against_reported(claim, int(np.count_nonzero(values > 0)), len(values), 0)
    return _verdict(claim, condition, name, result, p, against, len(values), [reason, *remarks])


def judge_order(order: Order, first: Sequence[WorldRecord], second: Sequence[WorldRecord]) -> Verdict:
    """Applies the rule of a claim about two conditions.

    Args:
        order: The claim.
        first: Worlds of its first condition.
        second: Worlds of its second condition.
    """
    parts, remarks, shortfalls = [], [], []
    for worlds in (first, second):
        used_worlds, shortfall, world_remarks = _assessed(order, worlds)
        parts.append(_figures(order, used_worlds))
        remarks += [f"{worlds[0].condition}: {remark}" for remark in world_remarks]
        shortfalls += [f"{worlds[0].condition}: {shortfall}"] if shortfall else []
    fewest = min(map(len, parts))
    value, low, high = compare(order.comparison, parts[0], parts[1], order.level) if fewest > 1 else (math.nan,) * 3
    name = place(low, high, order.low, order.high)
    reason = CROSSES if name == UNDECIDED else ""
    if shortcomings := _shortcomings(fewest, *shortfalls):
        name, reason = UNDECIDED, shortcomings
    result = ClaimEstimate(value, low, high)
    condition, total = _both(first, second), sum(map(len, parts))
    return _verdict(order, condition, name, result, math.nan, NO_SPREAD, total, [reason, *remarks])


def place(low: float, high: float, region_low: float, region_high: float) -> str:
    """The verdict for an interval that is within a region, outside of it, or across its border (or has no bounds).

    Args:
        low: Lower bound of the interval.
        high: Upper bound of the interval.
        region_low: Lower end of the region in which the claim holds.
        region_high: Upper end of the region.

    Returns:
        `HOLDS`, `FAILS` or `UNDECIDED`.
    """
    if region_low < low and high < region_high:
        return HOLDS
    if high < region_low or low > region_high:
        return FAILS
    return UNDECIDED


def _judge_extinction(claim: Claim, condition: str, worlds: Sequence[WorldRecord]) -> Verdict:
    """Uses all worlds, however long; those whose records end before the step are censored there."""
    extinction = world_extinction(worlds, claim.steps)
    name = place(extinction.low, extinction.high, claim.low, claim.high) if extinction.worlds else UNDECIDED
    unknown = extinction.worlds - extinction.extinct - extinction.followed
    reasons = [CROSSES if name == UNDECIDED else ""]
    if shortcomings := _shortcomings(extinction.worlds):
        name, reasons = UNDECIDED, [shortcomings]
    if unknown:
        reasons.append(f"{unknown} of {extinction.worlds} worlds live and end before step {claim.steps:,}")
    if unknown and not extinction.followed:
        reasons.append(f"the share is that by step {extinction.known_until:,.0f}")
    p, against = _against_reported(claim, extinction.extinct, extinction.worlds, unknown)
    share_estimate = ClaimEstimate(extinction.share, extinction.low, extinction.high)
    return _verdict(claim, condition, name, share_estimate, p, against, extinction.worlds, reasons)


def _both(first: Sequence[WorldRecord], second: Sequence[WorldRecord]) -> str:
    return f"{first[0].condition} against {second[0].condition}"


def _guarded(claim: Claim | Order, condition: str, rule: Callable[[], Verdict]) -> Verdict:
    """The verdict of a rule; undecided, with the error as its reason, if the claim's measure fails."""
    try:
        return rule()
    except Exception as error:  # a measure of another package may raise anything
        reason = f"{FAILED}{failure(error)}"
        return _verdict(claim, condition, UNDECIDED, ClaimEstimate(), math.nan, "", 0, [reason])


def _shortcomings(worlds: int, *shortfalls: str) -> str:
    """Why worlds decide nothing, whatever their interval; empty if they may."""
    return "; ".join(filter(None, (TOO_FEW if worlds < FOR_FULL_LENGTH else "", *shortfalls)))


def _assessed(claim: Claim | Order, worlds: Sequence[WorldRecord]) -> tuple[list[WorldRecord], str, list[str]]:
    """The worlds to use, why they may not decide the claim, and remarks on worlds that were left out.

    Extinct worlds are left out, since papers replace them. If all species must survive, a remark gives the share of
    worlds in which they do. If some worlds are long enough, only these are used.
    """
    steps, remarks, shortfall = claim.steps, list[str](), ""
    living = [world for world in worlds if world.extinct_step is None]
    if extinct_count := len(worlds) - len(living):
        remarks.append(f"{extinct_count} extinct left out")
    if claim.together:
        if apart_count := sum(world.apart_step is not None for world in living):
            living = [world for world in living if world.apart_step is None]
            remarks.append(f"{apart_count} left out where another species died out")
        remarks.append(_lasting(worlds, steps))
    long_enough = [world for world in living if world.last_step >= steps]
    if living and not long_enough:
        shortfall = f"the worlds reach {max(world.last_step for world in living):,} of {steps:,} steps"
    elif short_count := len(living) - len(long_enough):
        remarks.append(f"{short_count} shorter left out")
    return long_enough or living, shortfall, remarks


def _lasting(worlds: Sequence[WorldRecord], steps: int) -> str:
    """The share of all worlds, including those left out, that keeps every species; the claim is about this share."""
    loss = species_loss(worlds, steps)
    share, low, high = (f"{100 * (1 - part):.0f}" for part in (loss.share, loss.high, loss.low))
    return (
        f"every species lasts to step {loss.known_until:,.0f} in {share} % ({low} … {high}) of {loss.worlds} worlds "
        "(Kaplan and Meier)"
    )


def _figures(claim: Claim | Order, worlds: Sequence[WorldRecord]) -> NDArray[np.float64]:
    """The figures of the worlds that have one, (n,)."""
    return np.array([value for world in worlds if (value := claim.measure(world)) is not None], np.float64)


def _against_reported(claim: Claim, count: int, total: int, unknown: int) -> tuple[float, str]:
    """Answers the second question for a share; worlds of unknown fate get the outcome that gives the largest p."""
    if claim.reported_count is None:
        return math.nan, NO_COUNT
    if not total:
        return math.nan, ""
    p = max(fisher_mid_p(count + extra, total, *claim.reported_count) for extra in range(unknown + 1))
    return p, DIFFERS if p <= LEVEL else NOT_SHOWN


def _verdict(
    claim: Claim | Order,
    condition: str,
    name: str,
    result: ClaimEstimate,
    p: float,
    against: str,
    worlds: int,
    reasons: Sequence[str],
) -> Verdict:
    return Verdict(
        claim.name,
        condition,
        name,
        result.value,
        result.low,
        result.high,
        claim.reported,
        p,
        against,
        worlds,
        "; ".join(filter(None, reasons)),
        claim.text,
        claim.low,
        claim.high,
        claim.source,
    )
