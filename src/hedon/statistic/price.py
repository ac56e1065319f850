"""How much of the change from parents to offspring is selection, and how much is mutation? Price (1970, 1972).

For a cohort of agents with weight z, each having w children whose mean weight differs from its own by Δz, the
change from the mean of the cohort to the mean of all its children is exactly

    Δz̄ = Cov(w, z) / w̄ + E(w·Δz) / w̄,

selection plus transmission. Nothing learned is inherited, so transmission is mutation alone: of mean zero, but for
the clipping at the weight limit, and heavy-tailed, since mutations are Cauchy. Selection holds no mutation, so it is
the less noisy of the two.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class PriceTerms:
    """The change of one weight from a cohort to its children.

    Attributes:
        parents: agents of the cohort, with or without children.
        offspring: children of the cohort.
        change: mean of the children minus mean of the cohort; NaN without children, as all below.
        selection: Cov(w, z) / w̄.
        transmission: E(w·Δz) / w̄.
        residual: change − selection − transmission: rounding alone.
    """

    parents: int
    offspring: int
    change: float
    selection: float
    transmission: float
    residual: float


def price(weight: NDArray[np.float64], parent: NDArray[np.int64], cohort: NDArray[np.bool_]) -> PriceTerms:
    """Price's equation for one weight.

    Args:
        weight: of each agent, (n,).
        parent: position of each agent's parent, −1 where it has none, (n,).
        cohort: who belongs to the cohort of parents, (n,).
    """
    members = np.flatnonzero(cohort)
    children = np.flatnonzero((parent >= 0) & cohort[parent])
    if len(children) == 0:
        return PriceTerms(len(members), 0, np.nan, np.nan, np.nan, np.nan)
    count = np.bincount(parent[children], minlength=len(parent))[members].astype(np.float64)
    mean_count = len(children) / len(members)
    mean = weight[members].mean()
    change = float(weight[children].mean() - mean)
    selection = float(np.mean((count - mean_count) * (weight[members] - mean)) / mean_count)
    transmission = float(np.sum(weight[children] - weight[parent[children]]) / len(members) / mean_count)
    return PriceTerms(len(members), len(children), change, selection, transmission, change - selection - transmission)
