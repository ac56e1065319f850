"""How many children does an agent have in its life, and how unequally?

Only the dead have had all their children, and those who die early are over-represented among the dead of a short
record. So the numbers are taken over birth cohorts, and each says which share of it has died.
"""

from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.agent.cohort import complete_share

_MANY = 10  # agents with this many children or more are counted together


@dataclass(frozen=True)
class Reproduction:
    """Children of the agents of one cohort, whether these died or not.

    Attributes:
        agents: in the cohort.
        complete: share of them that has died.
        mean: children per agent, the realized net reproduction; None for no agents, as all below.
        variance: of the number of children, with n − 1; None for fewer than two agents.
        opportunity: variance over squared mean: the opportunity for selection, the upper limit of what
            selection can move any trait by, in squared standard deviations (Crow 1958).
        childless: share without children.
        top_tenth: share of all children that the tenth of the agents with the most children had.
        counts: agents with 0, 1, …, 9 and with 10 or more children.
    """

    agents: int
    complete: float
    mean: float | None
    variance: float | None
    opportunity: float | None
    childless: float | None
    top_tenth: float | None
    counts: tuple[int, ...]


def reproduction(cohort: pl.DataFrame) -> Reproduction:
    """Lifetime reproductive success in a cohort.

    Args:
        cohort: rows of the table `agents`.
    """
    children = cohort["children"].to_numpy().astype(np.float64)
    counts = tuple(np.bincount(np.minimum(children.astype(np.int64), _MANY), minlength=_MANY + 1).tolist())
    if len(children) == 0:
        return Reproduction(0, 1.0, None, None, None, None, None, counts)
    mean = float(children.mean())
    variance = float(children.var(ddof=1)) if len(children) > 1 else None
    top = np.sort(children)[::-1][: max(round(len(children) / 10), 1)].sum()
    return Reproduction(
        agents=len(children),
        complete=complete_share(cohort),
        mean=mean,
        variance=variance,
        opportunity=variance / mean**2 if variance is not None and mean else None,
        childless=float((children == 0).mean()),
        top_tenth=float(top / children.sum()) if mean else None,
        counts=counts,
    )
