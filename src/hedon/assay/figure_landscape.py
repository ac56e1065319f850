"""The figure of a landscape assay: relative fitness over two genes, with its optimum and the ends of evolved runs."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from hedon.assay.end import End, on_surface
from hedon.assay.landscape import Landscape, MeasureSurface
from hedon.config.title import weight_title
from hedon.figure.style import INK, MUTED, VERMILION, head, new_figure, styled
from hedon.text import p_phrase

_TITLES = {
    "descendants": "living descendants",
    "offspring": "children",
    "food": "food per step",
    "lifespan": "lifespan",
}


def draw_landscape(landscape: Landscape, ends: Sequence[End]) -> Figure:
    """Draws a panel per measure: the smooth surface, its optimum with intervals, and the ends of evolved runs."""
    with styled():
        figure = new_figure(9.0, 8.0)
        axes = figure.subplots(2, 2, squeeze=False).ravel()
        for panel, surface in zip(axes, landscape.surfaces.values(), strict=False):
            _draw(figure, panel, landscape, surface, ends)
        for panel in axes[len(landscape.surfaces) :]:
            panel.axis("off")
        axes[0].legend(loc="upper left", bbox_to_anchor=(0.0, -0.16), ncols=2)
    return figure


def _draw(figure: Figure, axes: Axes, landscape: Landscape, surface: MeasureSurface, ends: Sequence[End]) -> None:
    smooth = surface.smooth
    x, y = smooth.axes
    low, high = float(smooth.value.min()), float(smooth.value.max())
    high = max(high, low + 1e-9)  # a flat surface has no levels
    norm = Normalize(low, high)
    axes.contourf(x, y, smooth.value.T, levels=np.linspace(low, high, 15), cmap="viridis")
    lines = axes.contour(x, y, smooth.value.T, levels=7, colors="white", linewidths=0.6)
    axes.clabel(lines, fontsize=7, fmt="%.2f")
    figure.colorbar(ScalarMappable(norm, "viridis"), ax=axes, label="relative fitness")
    best = [estimate.value for estimate in smooth.optimum]
    bars = [
        np.nan_to_num([[max(optimum.value - optimum.low, 0.0)], [max(optimum.high - optimum.value, 0.0)]])
        for optimum in smooth.optimum
    ]
    axes.errorbar(*best, xerr=bars[0], yerr=bars[1], fmt="*", color=VERMILION, ms=13, mec="white", label="optimum")
    surface_ends = on_surface(ends, landscape.genes)
    for is_reported, marker, label in ((True, "D", "ends that studies report"), (False, "o", "ends of runs")):
        points = [
            (a, b)
            for end, (a, b) in surface_ends
            if end.reported == is_reported and x[0] <= a <= x[-1] and y[0] <= b <= y[-1]
        ]
        if points:
            axes.scatter(
                *zip(*points, strict=True), s=26, marker=marker, color="white", edgecolor=INK, zorder=3, label=label
            )
    axes.plot(0, 0, "+", color=INK, ms=9, label="start of evolution")
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(y[0], y[-1])
    axes.grid(visible=False)
    axes.set_xlabel(weight_title(landscape.genes[0]), color=MUTED)
    axes.set_ylabel(weight_title(landscape.genes[1]), color=MUTED)
    head(axes, _TITLES[surface.measure], f"chance of such a surface without effects: {p_phrase(surface.flat_p)}")
