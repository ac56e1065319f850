"""How do births and deaths depend on energy, and at which energies do agents live?"""

import math

import numpy as np
import polars as pl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from hedon.analysis.world.population import run_tail
from hedon.config.schema.species import SpeciesConfig
from hedon.demography.life import expected_lifetime, reproduction_number
from hedon.demography.schedule import birth_of, mean_hazard
from hedon.figure.style import BLUE, INK, ORANGE, new_figure, number_log_axis, step_unit, styled

_LINEAR_BELOW = 1.0  # energy up to which the axis is linear, so that it can include 0
_LINEAR_SCALE = (1.0 - 1.0 / 10.0) / math.log(10.0)
"""Length of the linear part in decades, so that the slope of the axis is continuous and curves have no kink."""


def draw_demography(species_config: SpeciesConfig, populations: list[pl.DataFrame]) -> Figure:
    """Draws R0 and mean lifetime at constant energy; shading shows the energies in the last tenth of the runs."""
    energy = _energies(species_config)
    lifetime = expected_lifetime(mean_hazard(species_config), energy)
    finite = lifetime[np.isfinite(lifetime)]
    unit, name = step_unit(float(finite.max(initial=0.0)))
    with styled():
        figure = new_figure(8.6, 3.2)
        left, right = figure.subplots(1, 2, sharex=True)
        handles: list[Artist] = [draw_reproduction(left, species_config)]
        right.plot(energy, np.where(np.isfinite(lifetime), lifetime / unit, np.nan), color=BLUE, linewidth=2.0)
        right.set_title(f"mean life [{name}]")
        _set_axes(right, energy)
        quartiles = _quartiles(populations)
        if quartiles is not None:
            for axes in (left, right):
                axes.axvspan(quartiles[0], quartiles[2], color=ORANGE, alpha=0.16, linewidth=0)
                axes.axvline(quartiles[1], color=ORANGE, linewidth=1.2, clip_on=False)
            handles.append(Patch(color=ORANGE, alpha=0.16, linewidth=0, label="half of the living"))
            handles.append(Line2D([], [], color=ORANGE, linewidth=1.2, label="their median"))
        figure.legend(handles=handles, loc="outside upper left", ncols=3)
    return figure


def draw_reproduction(axes: Axes, species_config: SpeciesConfig) -> Line2D:
    """Draws R0 at constant energy, and the line R0 = 1, at which a lineage keeps its size.

    Returns:
        The line R0 = 1, with its label, for the legend.
    """
    energy = _energies(species_config)
    r0 = reproduction_number(mean_hazard(species_config), birth_of(species_config), energy)
    axes.plot(energy, np.where(np.isfinite(r0), r0, np.nan), color=BLUE, linewidth=2.0)
    reference_line = axes.axhline(
        1.0, color=INK, linewidth=1.0, linestyle=(0, (4, 3)), label="R0 = 1: a lineage keeps its size"
    )
    axes.set_title("children tried in a life, R0")
    _set_axes(axes, energy)
    return reference_line


def _energies(species: SpeciesConfig) -> NDArray[np.float64]:
    return np.concatenate([np.linspace(0, 1, 40), np.geomspace(1, max(species.energy.capacity, 2.0), 160)[1:]])


def _set_axes(axes: Axes, energy: NDArray[np.float64]) -> None:
    axes.set_xscale("symlog", linthresh=_LINEAR_BELOW, linscale=_LINEAR_SCALE)
    axes.set_yscale("log")
    axes.set_xlim(0, energy[-1])
    axes.set_xlabel("energy, held constant")
    axes.set_xticks([t for t in (0, 1, 10, 100, 1000) if t <= energy[-1]])
    axes.xaxis.set_major_formatter("{x:g}")
    number_log_axis(axes.yaxis)


def _quartiles(populations: list[pl.DataFrame]) -> tuple[float, float, float] | None:
    """Quartiles of energy, averaged over the last tenth of the worlds."""
    names = ("energy_q25", "energy_median", "energy_q75")
    tails = [run_tail(rows).select(pl.col(*names).cast(pl.Float64).mean()) for rows in populations if rows.height]
    recorded = pl.concat(tails).drop_nulls() if tails else None
    if recorded is None or recorded.is_empty():
        return None
    low, median, high = recorded.mean().row(0)
    return low, median, high
