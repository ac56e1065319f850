"""The verdicts on the paper's claims as a table."""

from dataclasses import asdict

from hedon.analysis.table import ResultTable, table
from hedon.analysis.world.record import Conditions
from hedon.study.verdict import verdicts


def verdict(conditions: Conditions) -> list[ResultTable]:
    """The paper's claims."""
    found = verdicts(world for worlds in conditions.values() for world in worlds)
    rows = [asdict(row) for row in found]
    note = (
        "verdict: the 95 % interval over worlds lies within the region in which the claim holds, outside of it, or "
        "across its border. Fewer than three worlds, or shorter ones than the paper's, decide nothing. against_paper "
        "is another question: whether our share differs from the paper's count, by p_paper (mid-p Fisher). That no "
        "difference is shown does not mean that there is none. Means cannot be compared, since the paper gives no "
        "spread. Lifetimes and food are read as unweighted means over agents; the paper does not say."
    )
    return [table("verdict", "The paper's claims", rows, note)]
