"""How much of the change from parents to offspring is selection, and how much is mutation? Price (1970, 1972).

Consider a cohort of agents with weight z, each with w children whose mean weight differs from its own by Δz. The
change from the mean of the cohort to the mean of all its children is exactly

    Δz̄ = Cov(w, z) / w̄ + E(w·Δz) / w̄,

selection plus transmission. Nothing learned is inherited, so transmission consists only of mutation. Its mean is zero,
except for clipping at the weight limit, and it is heavy-tailed, since mutations are Cauchy. Selection contains no
mutation, so it is the less noisy of the two.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def price(weight: NDArray[np.float64], parent: NDArray[np.int64], cohort: NDArray[np.bool_]) -> dict[str, Any]:
    """Price's equation for one weight.

    Args:
        weight: Weight of each agent, shape (n,).
        parent: Position of each agent's parent, −1 if it has none, shape (n,).
        cohort: Whether each agent belongs to the cohort of parents, shape (n,).

    Returns:
        parents, the number of agents in the cohort, with or without children; offspring, the number of their children;
        change, mean of the children minus mean of the cohort; selection, Cov(w, z) / w̄; transmission, E(w·Δz) / w̄;
        residual, the change minus these two, which is only rounding. NaN without children.
    """
    members = np.flatnonzero(cohort)
    children = np.flatnonzero((parent >= 0) & cohort[parent])
    heads = {"parents": len(members), "offspring": len(children)}
    if len(children) == 0:
        return heads | dict.fromkeys(("change", "selection", "transmission", "residual"), np.nan)
    count = np.bincount(parent[children], minlength=len(parent))[members].astype(np.float64)
    mean_count = len(children) / len(members)
    mean = weight[members].mean()
    change = float(weight[children].mean() - mean)
    selection = float(np.mean((count - mean_count) * (weight[members] - mean)) / mean_count)
    transmission = float(np.sum(weight[children] - weight[parent[children]]) / len(members) / mean_count)
    residual = change - selection - transmission
    return heads | {"change": change, "selection": selection, "transmission": transmission, "residual": residual}
