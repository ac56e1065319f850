"""Surviving descent: coalescence, lines of the survivors, and the weights along them."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import Genealogy, ancestry, common_ancestor, families, founder, living_at


def coalescence(tree: Genealogy, step: int) -> dict[str, Any]:
    """Common descent of the agents alive after a step.

    Args:
        tree: The pedigree.
        step: Step after which the living agents are taken [step].

    Returns:
        step; alive, agents alive; families, founders that are alive or have living descendants; largest, the share of
        the living in the largest family; ancestor_birth, birth of the most recent common ancestor [step]; depth, time
        since then [step]. The last two are NaN while several families are left, as the time exceeds the run, and all
        three if no agent is alive.
    """
    alive = living_at(tree, step)
    ancestor = common_ancestor(tree, alive)
    birth = np.nan if ancestor is None else float(tree.birth[ancestor])
    return {
        "step": step,
        "alive": len(alive),
        "families": int(families(tree, np.array([step]))[0]),
        "largest": float(np.bincount(founder(tree)[alive]).max() / len(alive)) if len(alive) else np.nan,
        "ancestor_birth": birth,
        "depth": step - birth,
    }


def survivors(tree: Genealogy) -> NDArray[np.int64]:
    """Positions of the agents alive at the end of the records, (n,), or of the one born last if none is."""
    alive = np.flatnonzero(tree.alive)
    return alive if len(alive) or not tree.size else np.array([int(np.argmax(tree.birth))])


def lines_through_time(
    tree: Genealogy, agents: pl.DataFrame, names: Sequence[str], steps: NDArray[np.int64]
) -> pl.DataFrame:
    """The lines of descent of the survivors through time, with all agents alive at the same times.

    An agent carries a line from its birth until its last child with a surviving line is born; a survivor carries it on.

    Args:
        tree: The pedigree.
        agents: Table `agents` of the same world, by agent_id.
        names: Genome columns.
        steps: Times, ascending [step], (times,).

    Returns:
        By step and weight: step, weight, lines (number of lines that lead to survivors), alive, line_mean (mean weight
        over the lines), living_mean (mean over all alive). Means over no agents are null.
    """
    living = survivors(tree)
    is_ancestor = ancestry(tree, living)
    line_end = np.full(tree.size, -1, np.int64)
    line_end[living] = tree.death[living]
    descendants = np.flatnonzero(is_ancestor & (tree.parent >= 0))
    np.maximum.at(line_end, tree.parent[descendants], tree.birth[descendants])
    carriers = np.flatnonzero(is_ancestor)
    lines = _sums(tree.birth[carriers], line_end[carriers], None, steps)
    alive = _sums(tree.birth, tree.death, None, steps)
    rows = []
    for name in names:
        weight = agents[name].to_numpy().astype(np.float64)
        line_sum = _sums(tree.birth[carriers], line_end[carriers], weight[carriers], steps)
        living_sum = _sums(tree.birth, tree.death, weight, steps)
        with np.errstate(divide="ignore", invalid="ignore"):
            columns = {"step": steps, "lines": lines.astype(np.int64), "alive": alive.astype(np.int64)}
            columns |= {"line_mean": line_sum / lines, "living_mean": living_sum / alive}
        rows.append(pl.DataFrame(columns, nan_to_null=True).with_columns(weight=pl.lit(name)))
    order = ("step", "weight", "lines", "alive", "line_mean", "living_mean")
    return pl.concat(rows).select(order)


def _sums(
    begin: NDArray[np.int64], end: NDArray[np.int64], value: NDArray[np.float64] | None, steps: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Sums values, or counts, over the agents with begin <= step < end, for each step."""
    total = np.zeros(len(steps))
    for edge, sign in ((begin, 1.0), (end, -1.0)):
        order = np.argsort(edge, kind="stable")
        running = np.concatenate([[0.0], np.cumsum(np.ones(len(edge)) if value is None else value[order])])
        total += sign * running[np.searchsorted(edge[order], steps, side="right")]
    return total
