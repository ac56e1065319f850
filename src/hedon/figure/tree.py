"""How do the living descend from the founders, and how did a weight change on the way?"""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hedon.analysis.descent.genealogy import ALIVE, Genealogy, ancestry
from hedon.config.title import weight_title
from hedon.figure.style import (
    BLUE,
    ORANGE,
    PALE,
    SKY,
    VERMILION,
    draw_message,
    new_figure,
    step_unit,
    styled,
)

MOST = 300
"""Largest number of tips drawn; if there are more, this many are chosen, evenly by birth."""
_COLORS = LinearSegmentedColormap.from_list("weight", [BLUE, SKY, PALE, ORANGE, VERMILION])
"""Gray in the middle, so that lines of weights near 0 are visible on white."""
_SHARE = 0.98  # of the agents within the range of colors; the few beyond it have the color of its end


def draw_tree(tree: Genealogy, weight: NDArray[np.float64], name: str, now: int) -> Figure:
    """Draws the pedigree of the living, colored by a weight.

    Each agent is a line that starts at its birth. The line of a tip ends at the last step; that of an ancestor ends
    at the last birth of a child that leads to a tip.

    Args:
        tree: Pedigree of one world.
        weight: Weight of each agent, shape (agents,).
        name: Genome column of the weight, for labels.
        now: The last step.
    """
    alive = np.flatnonzero(tree.alive)
    if not len(alive):
        return draw_message("nobody lives at the end")
    tips = alive[np.unique(np.linspace(0, len(alive) - 1, min(len(alive), MOST)).round().astype(int))]
    members = np.flatnonzero(ancestry(tree, tips))
    heights, line_ends = _layout(tree, members, tips, now)
    reach = max(float(np.quantile(np.abs(weight[members]), _SHARE)), 1e-6)
    unit, unit_name = step_unit(now)
    with styled():
        figure = new_figure(8.6, min(2.0 + 0.02 * len(tips), 7.0))
        axes = figure.subplots()
        life_lines = [[(tree.birth[i] / unit, heights[i]), (line_ends[i] / unit, heights[i])] for i in members]
        heirs = [i for i in members if tree.parent[i] >= 0]
        births = [[(tree.birth[i] / unit, heights[i]), (tree.birth[i] / unit, heights[tree.parent[i]])] for i in heirs]
        for lines, owners, width in ((births, heirs, 0.5), (life_lines, members, 1.0)):
            collection = LineCollection(lines, cmap=_COLORS, linewidths=width)
            collection.set_array(weight[owners])
            collection.set_clim(-reach, reach)
            axes.add_collection(collection)
        axes.set_xlim(0, now / unit)
        axes.set_ylim(-1, len(tips))
        axes.set_yticks([])
        axes.grid(visible=False)
        axes.set_xlabel(f"time [{unit_name}]")
        tip_count = f"{len(tips)} of {len(alive)}" if len(tips) < len(alive) else f"all {len(alive)}"
        axes.set_title(f"{tip_count} who live, and their ancestors")
        figure.colorbar(collection, ax=axes, label=weight_title(name), extend="both", shrink=0.8)
    return figure


def _layout(
    tree: Genealogy, members: NDArray[np.int64], tips: NDArray[np.int64], now: int
) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """The height of each member's line and the step at which it ends, each (agents,)."""
    young: dict[int, list[int]] = {}
    line_ends = np.where(tree.death == ALIVE, now, tree.birth)
    for i in members.tolist():
        if (parent := int(tree.parent[i])) >= 0:
            young.setdefault(parent, []).append(i)
            line_ends[parent] = max(line_ends[parent], tree.birth[i])
    is_tip = np.zeros(tree.size, bool)
    is_tip[tips] = True
    line_ends[members] = np.where(is_tip[members], now, line_ends[members])
    heights = np.full(tree.size, np.nan)
    height = 0
    for root in [i for i in members.tolist() if tree.parent[i] < 0]:
        stack = [root]
        while stack:  # from the bottom up: the latest child is drawn nearest to its parent
            agent = stack.pop()
            if is_tip[agent]:
                heights[agent] = height
                height += 1
            stack += young.get(agent, [])
    for i in members[::-1].tolist():  # children are listed after their parents
        if not is_tip[i]:
            heights[i] = min(heights[child] for child in young[i])  # its line ends where that of its last child starts
    return heights, line_ends
