"""In which regime was each world, and when?"""

import polars as pl
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from hedon.analysis.world.regime import BETWEEN, EXTINCT, FOOD, IDLE, REGIMES, ROOM
from hedon.figure.style import GREEN, INK, ORANGE, PALE, VIOLET, draw_message, new_figure, step_unit, styled

REGIME_COLORS = {ROOM: ORANGE, FOOD: GREEN, IDLE: VIOLET, BETWEEN: PALE, EXTINCT: INK}
_NAMED_WORLDS = 24  # most rows that leave room for their seeds


def draw_regimes(regimes: pl.DataFrame) -> Figure:
    """Draws the regime of each world over time, as a row of colors."""
    seeds = regimes["seed"].unique(maintain_order=True).to_list() if regimes.height else []
    if not seeds:
        return draw_message("nothing recorded yet")
    with styled():
        figure = new_figure(8.6, 1.15 + 0.24 * min(len(seeds), 40))
        axes = figure.subplots()
        axes.grid(visible=False)
        unit, name = step_unit(float(regimes["step"].to_numpy().max()))
        for row, seed in enumerate(seeds):
            world_regimes = regimes.filter(pl.col("seed") == seed)
            # Adjacent intervals in the same regime become one bar, since seams between bars would be visible.
            parts = world_regimes.group_by(pl.col("regime").rle_id().alias("part"), maintain_order=True)
            merged = parts.agg(pl.col("regime").first(), pl.col("step").max(), pl.col("steps").sum())
            spans = [
                ((step - steps) / unit, steps / unit) for step, steps in merged.select("step", "steps").iter_rows()
            ]
            colors = [REGIME_COLORS[regime] for regime in merged["regime"]]
            axes.broken_barh(spans, (row - 0.4, 0.8), facecolors=colors, linewidth=0)
        axes.set_ylim(len(seeds) - 0.4, -0.6)
        axes.set_xlim(0, float(regimes["step"].to_numpy().max()) / unit)
        axes.set_yticks(range(len(seeds)) if len(seeds) <= _NAMED_WORLDS else [])
        axes.set_yticklabels([f"seed {seed}" for seed in seeds] if len(seeds) <= _NAMED_WORLDS else [])
        for side in ("left", "bottom"):
            axes.spines[side].set_visible(False)
        axes.set_xlabel(f"time [{name}]")
        present_regimes = set(regimes["regime"].to_list())
        handles = [Patch(color=REGIME_COLORS[r], label=r) for r in REGIMES if r in present_regimes]
        figure.legend(handles=handles, loc="outside upper left", ncols=len(handles), columnspacing=1.4)
    return figure
