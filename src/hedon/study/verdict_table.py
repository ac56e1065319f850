"""The verdicts on claims as a table."""

from collections.abc import Iterable
from dataclasses import asdict

from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.world.record import Conditions
from hedon.study.catalogue import installed
from hedon.study.claim import Claim, Order
from hedon.study.verdict import verdicts

_NOTE = (
    "verdict: the 95 % interval over worlds lies within the region in which the claim holds, outside of it, or "
    "across its border. Fewer than six worlds, or shorter ones than the claim asks for, decide nothing. "
    "against_reported is another question: whether our share differs from the source's count, by p_reported (mid-p "
    "Fisher). That no difference is shown does not mean that there is none. Where a source gives no spread, means "
    "cannot be compared."
)


def verdict(conditions: Conditions, claims: Iterable[Claim | Order] | None = None) -> list[ResultTable]:
    """The verdicts on all claims about the conditions of some worlds.

    Args:
        conditions: Worlds by condition.
        claims: Claims to judge; None for the claims in all installed studies.
    """
    if claims is None:
        claims = (claim for study in installed()[0].values() for claim in study.claims)
    judged = verdicts((world for worlds in conditions.values() for world in worlds), claims)
    return [make_table("verdict", "Claims about these conditions", [asdict(row) for row in judged], _NOTE)]
