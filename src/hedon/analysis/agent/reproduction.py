"""How many children agents have in their lives, and how unequally.

Only dead agents have had all their children, and a short record over-represents early deaths. The measures are
therefore computed for birth cohorts, each with the share of it that has died.
"""

from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.agent.cohort import complete_share

_MANY = 10  # agents with at least this many children are counted together


def reproduction(cohort: pl.DataFrame) -> dict[str, Any]:
    """Children of the agents of one cohort, including agents still alive.

    Returns:
        agents, in the cohort; complete, the share of them that has died; mean, children per agent, the realized net
        reproduction; variance of the number of children, with n − 1; opportunity, variance over squared mean: the
        opportunity for selection, an upper limit of the change of any trait by selection, in squared standard
        deviations (Crow 1958); childless, the share without children; top_tenth, the share of all children that belongs
        to the tenth of the agents with the most children; with_0, with_1, …, with_9 and with_10_or_more, agents by
        number of children. None for undefined values.
    """
    children = cohort["children"].to_numpy().astype(np.float64)
    has_agents, count = len(children) > 0, len(children)
    mean = float(children.mean()) if has_agents else None
    variance = float(children.var(ddof=1)) if count > 1 else None
    top_sum = np.sort(children)[::-1][: max(round(count / 10), 1)].sum()
    child_counts = np.bincount(np.minimum(children.astype(np.int64), _MANY), minlength=_MANY + 1).tolist()
    return {
        "agents": count,
        "complete": complete_share(cohort),
        "mean": mean,
        "variance": variance,
        "opportunity": variance / mean**2 if variance is not None and mean else None,
        "childless": float((children == 0).mean()) if has_agents else None,
        "top_tenth": float(top_sum / children.sum()) if mean else None,
        **{f"with_{i}{'_or_more' if i == _MANY else ''}": number for i, number in enumerate(child_counts)},
    }
