"""What are the laws of death and birth?"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.config.schema.life import HazardConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.demography.life import birth_rate, expected_lifetime, hazard, reproduction_number, survival
from hedon.demography.schedule import birth_of
from hedon.figure.demography import draw_reproduction
from hedon.figure.style import (
    BLUE,
    GREEN,
    INK,
    MUTED,
    ORANGE,
    PINK,
    SKY,
    VERMILION,
    VIOLET,
    new_figure,
    step_unit,
    styled,
)

ENERGIES = {0.0: VERMILION, 5.0: ORANGE, 10.0: GREEN, 20.0: SKY, 40.0: BLUE}
"""Energies for which curves are drawn, with their colors."""
AGES = {0.0: PINK, 500_000.0: VIOLET, 1_000_000.0: MUTED, 1_500_000.0: INK}
"""Ages for which curves are drawn [step], with their colors."""
_MOST_ENERGY = 60.0  # the curves are flat beyond it
_OLDEST = 2_000_000.0  # nearly all agents are dead by then, whatever their energy [step]
_YOUNGEST = 100.0  # start of the logarithmic axis of ages [step]
_POINTS = 241


def draw_hazard(config: HazardConfig) -> Figure:
    """Draws the chance of death by energy and by age, and survival at constant energy with the mean lifetime."""
    with styled():
        figure = new_figure(8.6, 5.6)
        panels = figure.subplot_mosaic([["energy", "age"], ["survival", "survival"]], height_ratios=(1.2, 1.0))
        panels["age"].sharey(panels["energy"])
        _draw_hazard_by_energy(panels["energy"], config)
        _draw_hazard_by_age(panels["age"], config)
        _draw_survival(panels["survival"], config)
    return figure


def draw_birth(species_config: SpeciesConfig) -> Figure:
    """Draws the chance of a birth by energy, and the births attempted in a life at constant energy."""
    energy = np.linspace(0, min(_MOST_ENERGY, species_config.energy.capacity), _POINTS)
    none = float(reproduction_number(species_config.hazard, birth_of(species_config), 0.0))
    with styled():
        figure = new_figure(8.6, 3.2)
        chance, children = figure.subplots(1, 2)
        chance.plot(energy, 1e3 * birth_rate(birth_of(species_config), energy), color=BLUE, linewidth=2.0)
        chance.set(xlim=(0, energy[-1]), ylim=(0, 1.1e3 * species_config.birth.kappa), xlabel="energy")
        chance.set_title("chance of trying a birth [1/1000 steps]")
        reference_line = draw_reproduction(children, species_config)
        figure.legend(handles=[reference_line], loc="outside lower right")
        children.plot(0, none, marker="o", markersize=6, color=VERMILION, clip_on=False, zorder=5)
        children.annotate(
            f"without energy {none:.2f}",
            (0, none),
            xytext=(10, 44),
            textcoords="offset points",
            color=VERMILION,
            fontsize=8,
            arrowprops={"arrowstyle": "-", "color": VERMILION, "linewidth": 0.8},
        )
    return figure


def _draw_hazard_by_energy(axes: Axes, config: HazardConfig) -> None:
    energy = np.linspace(0, _MOST_ENERGY, _POINTS)
    for age, color in AGES.items():
        axes.plot(energy, hazard(config, age, energy), color=color, linewidth=2.0, label=f"{age:,.0f}")
    axes.set(yscale="log", xlim=(0, _MOST_ENERGY), xlabel="energy", ylabel="chance of death [1/step]")
    axes.set_title("hazard by energy")
    axes.legend(title="age [step]", loc="lower left", title_fontsize=8)


def _draw_hazard_by_age(axes: Axes, config: HazardConfig) -> None:
    age = np.linspace(0, _OLDEST, _POINTS)
    unit, name = step_unit(_OLDEST)
    for energy, color in ENERGIES.items():
        axes.plot(age / unit, hazard(config, age, energy), color=color, linewidth=2.0, label=f"{energy:g}")
    axes.set(xlim=(0, _OLDEST / unit), xlabel=f"age [{name}]")
    axes.tick_params(labelleft=False)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_title("hazard by age")
    axes.legend(title="energy", loc="lower right", title_fontsize=8)


def _draw_survival(axes: Axes, config: HazardConfig) -> None:
    age = np.geomspace(_YOUNGEST, _OLDEST, _POINTS)
    for energy, color in ENERGIES.items():
        mean = float(expected_lifetime(config, energy))
        label = f"energy {energy:g}: {mean:,.0f}"
        axes.plot(age, survival(config, age, energy), color=color, linewidth=2.0, label=label)
    axes.set(xscale="log", xlim=(_YOUNGEST, _OLDEST), ylim=(0, 1.02), xlabel="age [step]", ylabel="share that lives on")
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.set_title("survival at constant energy")
    axes.legend(title="mean life [step]", loc="lower left", title_fontsize=8)
