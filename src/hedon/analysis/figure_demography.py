"""What do the laws of birth and death make of energy, and at which energies do agents live?"""

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from hedon.analysis.demography import expected_lifetime, reproduction_number
from hedon.analysis.population import run_tail
from hedon.analysis.style import BLUE, INK, MUTED, ORANGE, new_figure, step_unit, styled
from hedon.config import Config

_LINEAR_BELOW = 1.0  # energy up to which the axis is linear, so that it holds 0


def draw_demography(config: Config, populations: list[pl.DataFrame]) -> Figure:
    """R0 and mean life at constant energy; shaded, where the living were in the last tenth of the runs.

    Args:
        config: the settings.
        populations: tables `population` of the worlds; none where there was no run.
    """
    energy = _energies(config)
    lifetime = expected_lifetime(config.hazard, energy)
    finite = lifetime[np.isfinite(lifetime)]
    unit, name = step_unit(float(finite.max(initial=0.0)))
    with styled():
        figure = new_figure(8.6, 3.0)
        left, right = figure.subplots(1, 2, sharex=True)
        draw_reproduction(left, config)
        right.plot(energy, np.where(np.isfinite(lifetime), lifetime / unit, np.nan), color=BLUE, linewidth=2.0)
        right.set_title(f"mean life [{name}]")
        _set_axes(right, energy)
        quartiles = _quartiles(populations)
        if quartiles is not None:
            for axes in (left, right):
                axes.axvspan(quartiles[0], quartiles[2], color=ORANGE, alpha=0.16, linewidth=0)
                axes.axvline(quartiles[1], color=ORANGE, linewidth=1.2)
            right.annotate(
                "half of the living",
                (quartiles[1], 0.92),
                xycoords=("data", "axes fraction"),
                xytext=(5, 0),
                textcoords="offset points",
                color=MUTED,
                fontsize=8,
            )
    return figure


def draw_reproduction(axes: Axes, config: Config) -> None:
    """Draws R0 at constant energy, and the line R0 = 1 at which a lineage keeps its size.

    Args:
        axes: to draw on.
        config: the settings.
    """
    energy = _energies(config)
    r0 = reproduction_number(config.hazard, config.birth, energy)
    axes.plot(energy, np.where(np.isfinite(r0), r0, np.nan), color=BLUE, linewidth=2.0)
    axes.axhline(1.0, color=INK, linewidth=1.0, linestyle=(0, (4, 3)))
    axes.annotate(
        "a lineage keeps its size",
        (1.0, 1.0),
        xycoords=("axes fraction", "data"),
        xytext=(-2, 4),
        textcoords="offset points",
        ha="right",
        color=MUTED,
        fontsize=8,
    )
    axes.set_title("children tried in a life, R0")
    _set_axes(axes, energy)


def _energies(config: Config) -> NDArray[np.float64]:
    return np.concatenate([np.linspace(0, 1, 40), np.geomspace(1, max(config.energy.capacity, 2.0), 160)[1:]])


def _set_axes(axes: Axes, energy: NDArray[np.float64]) -> None:
    axes.set_xscale("symlog", linthresh=_LINEAR_BELOW)
    axes.set_yscale("log")
    axes.set_xlim(0, energy[-1])
    axes.set_xlabel("energy, held constant")
    axes.set_xticks([t for t in (0, 1, 10, 100, 1000) if t <= energy[-1]])
    axes.xaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_major_formatter("{x:g}")


def _quartiles(populations: list[pl.DataFrame]) -> tuple[float, float, float] | None:
    """Quartiles of energy, means over the last tenth of the worlds."""
    names = ("energy_q25", "energy_median", "energy_q75")
    tails = [run_tail(rows).select(pl.col(*names).cast(pl.Float64).mean()) for rows in populations if rows.height]
    known = pl.concat(tails).drop_nulls() if tails else None
    if known is None or known.is_empty():
        return None
    low, median, high = known.mean().row(0)
    return low, median, high
