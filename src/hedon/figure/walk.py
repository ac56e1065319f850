"""Where do mutations alone carry weights that are not under selection?"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.special import voigt_profile

from hedon.analysis.descent.walk import MutationLaw, lineages
from hedon.figure.style import INK, MUTED, PALE, new_figure, seed_color, styled
from hedon.figure.trace import draw_zero_line

LENGTHS = (100, 1000)
"""Numbers of mutations after which weights are shown, as in the paper."""
_LINES = 10_000  # lines of descent in each histogram
_TABLES = 1000  # worlds that they are spread over, if noise is tabulated
_EXAMPLES = 8  # lines drawn
_PER_TABLE = 2  # lines drawn per world, if noise is tabulated
_BINS = 40
_CORNER = 0.1  # of the limit: how far a corner reaches along both axes

Genes = NDArray[np.float32]
Floats = NDArray[np.float64]


def draw_walks(law: MutationLaw, births: int, rng: np.random.Generator) -> Figure:
    """Draws a row per number of mutations: examples of lines of descent, and the weights at their ends.

    Shaded: half and 95 % of all lines. If each birth draws its own noise, the dashed curve at the right shows what the
    same noise would do without a limit, in closed form: Cauchy noise added to the founders' normal distribution.

    Args:
        law: Distributions of founders' genes and of mutations.
        births: Births per window; used only for tabulated noise.
        rng: Source of random numbers.
    """
    genes, examples, colors = _sample(law, births, rng)
    with styled():
        figure = new_figure(8.6, 5.6)
        panels = figure.subplots(len(LENGTHS), 2, sharey=True, width_ratios=(3, 1))
        for (walk, share), length in zip(panels, LENGTHS, strict=True):
            _draw_lines(walk, genes[: length + 1], examples[: length + 1], colors)
            _draw_share(share, genes[length], law, length)
            walk.set_ylim(-1.03 * law.limit, 1.03 * law.limit)
        color_note = ", two of a color from one world and its table" if law.tabulated else ""
        panels[0][0].set_title(f"{_EXAMPLES} lines of descent{color_note}")
        panels[-1][1].set_xlabel("lines per bin [%]")
        handles = [*panels[0][0].get_legend_handles_labels()[0], *panels[0][1].get_legend_handles_labels()[0]]
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), handlelength=1.8)
    return figure


def draw_walk_ends(law: MutationLaw, births: int, rng: np.random.Generator) -> Figure:
    """Draws a panel per number of mutations: two weights of each line, one against the other, as in the paper.

    Large mutations carry weights to their limit, so points gather along the edges and, if both weights reach it, in
    the four corners. Each corner is labeled with its share of the lines.

    Args:
        law: Distributions of founders' genes and of mutations.
        births: Births per window; used only for tabulated noise.
        rng: Source of random numbers.
    """
    worlds = _TABLES if law.tabulated else _LINES
    genes = lineages(law, LENGTHS[-1], worlds, _LINES // worlds, rng, births, genes=2)
    with styled():
        figure = new_figure(8.6, 4.4)
        for axes, length in zip(figure.subplots(1, len(LENGTHS)), LENGTHS, strict=True):
            _draw_ends(axes, genes[length].reshape(-1, 2), law)
            axes.set_title(f"after {length:,} mutations")
    return figure


def unlimited_share(law: MutationLaw, length: int, edges: Floats) -> Floats:
    """The share of lines that would end in each bin without clipping, from the density at the center of the bin.

    Returns:
        Shares, shape (bins,).
    """
    middle = 0.5 * (edges[1:] + edges[:-1])
    return voigt_profile(middle - law.mean, law.sd, length * law.scale) * np.diff(edges)


def _draw_ends(axes: Axes, ends: Genes, law: MutationLaw) -> None:
    x, y = ends.T
    reach = 1.06 * law.limit
    for draw in (axes.axhline, axes.axvline):
        draw(0, color=PALE, linewidth=1.0, zorder=0.5)
    axes.scatter(x, y, s=4.0, color=MUTED, linewidths=0, alpha=0.3, rasterized=True, clip_on=False)
    corner = (1.0 - _CORNER) * law.limit
    for x_sign in (-1, 1):
        for y_sign in (-1, 1):
            share = 100 * float(np.mean((x_sign * x >= corner) & (y_sign * y >= corner)))
            axes.annotate(
                f"{share:.1f} %",
                (x_sign * corner, y_sign * corner),
                xytext=(-12 * x_sign, -12 * y_sign),
                textcoords="offset points",
                ha="center",
                va="center",
                fontsize=8,
                color=INK,
                bbox={"boxstyle": "round,pad=0.2", "color": "white", "alpha": 0.8},
            )
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="one weight", ylabel="another weight")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")


def _sample(law: MutationLaw, births: int, rng: np.random.Generator) -> tuple[Genes, Genes, list[str]]:
    """All lines, shape (mutations + 1, lines), the lines to draw, and their colors."""
    worlds, per_world = (_TABLES, _PER_TABLE) if law.tabulated else (_LINES, 1)
    genes = lineages(law, LENGTHS[-1], worlds, _LINES // worlds, rng, births)
    examples = genes[:, :: worlds * per_world // _EXAMPLES, :per_world].reshape(len(genes), -1)
    return genes.reshape(len(genes), -1), examples, [seed_color(i // per_world) for i in range(_EXAMPLES)]


def _draw_lines(axes: Axes, genes: Genes, examples: Genes, colors: list[str]) -> None:
    number = np.arange(len(genes))
    outer_low, low, high, outer_high = np.quantile(genes, (0.025, 0.25, 0.75, 0.975), axis=1)
    draw_zero_line(axes)
    axes.fill_between(number, outer_low, outer_high, color=MUTED, alpha=0.12, linewidth=0, label="95 % of all lines")
    axes.fill_between(number, low, high, color=MUTED, alpha=0.22, linewidth=0, label="half of all lines")
    for example, color in zip(examples.T, colors, strict=True):
        axes.plot(number, example, color=color, linewidth=1.1)
    axes.set(xlim=(0, number[-1]), xlabel="mutations", ylabel="weight")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_major_formatter("{x:,.0f}")


def _draw_share(axes: Axes, ends: Genes, law: MutationLaw, length: int) -> None:
    edges = np.linspace(-law.limit, law.limit, _BINS + 1)
    share = 100 * np.histogram(ends, edges)[0] / len(ends)
    axes.stairs(share, edges, orientation="horizontal", fill=True, color=MUTED, alpha=0.45)
    if not law.tabulated:
        middle = 0.5 * (edges[1:] + edges[:-1])
        unlimited = 100 * unlimited_share(law, length, edges)
        axes.plot(
            unlimited, middle, color=INK, linewidth=1.2, linestyle=(0, (4, 3)), label="without the limit (closed form)"
        )
    axes.set_xlim(left=0)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_title(f"after {length:,}")
