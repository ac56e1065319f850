"""How much of the change from parents to offspring is selection, and how much is mutation? Price (1970, 1972).

For a cohort of agents with weight z, each having w children whose mean weight differs from its own by Δz, the
change from the mean of the cohort to the mean of all its children is exactly

    Δz̄ = Cov(w, z) / w̄ + E(w·Δz) / w̄,

selection plus transmission. Nothing learned is inherited, so transmission is mutation alone: of mean zero, but for
the clipping at the weight limit, and heavy-tailed, since mutations are Cauchy. Selection holds no mutation, so it is
the less noisy of the two.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.genealogy import Genealogy


@dataclass(frozen=True)
class PriceTerms:
    """The change of one weight from a cohort to its children.

    Attributes:
        weight: genome column.
        parents: agents of the cohort, with or without children.
        offspring: children of the cohort.
        change: mean of the children minus mean of the cohort; NaN without children, as all below.
        selection: Cov(w, z) / w̄.
        transmission: E(w·Δz) / w̄.
        residual: change − selection − transmission: rounding alone.
    """

    weight: str
    parents: int
    offspring: int
    change: float
    selection: float
    transmission: float
    residual: float


def price(agents: pl.DataFrame, tree: Genealogy, cohort: np.ndarray, names: Sequence[str]) -> list[PriceTerms]:
    """Price's equation for each weight.

    Args:
        agents: table `agents` of one world, by agent_id.
        tree: its pedigree.
        cohort: who belongs to the cohort of parents, bool, shape (n,).
        names: genome columns.
    """
    members = np.flatnonzero(cohort)
    children = np.flatnonzero((tree.parent >= 0) & cohort[tree.parent])
    if len(children) == 0:
        nothing = (float("nan"),) * 4
        return [PriceTerms(name, len(members), 0, *nothing) for name in names]
    count = np.bincount(tree.parent[children], minlength=tree.size)[members].astype(np.float64)
    mean_count = len(children) / len(members)
    terms = []
    for name in names:
        z = agents[name].to_numpy().astype(np.float64)
        mean = z[members].mean()
        change = z[children].mean() - mean
        selection = float(np.mean((count - mean_count) * (z[members] - mean)) / mean_count)
        transmission = float(np.sum(z[children] - z[tree.parent[children]]) / len(members) / mean_count)
        residual = float(change - selection - transmission)
        terms.append(PriceTerms(name, len(members), len(children), float(change), selection, transmission, residual))
    return terms
