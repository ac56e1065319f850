"""How do predators and prey live together: how many are there, what do they die of, and how close are they?"""

from collections.abc import Mapping

import polars as pl
from matplotlib.figure import Figure

from hedon.config.color import NEUTRAL_COLOR
from hedon.figure.style import (
    BLUE,
    INK,
    MUTED,
    SEED_COLORS,
    VERMILION,
    legend_above,
    new_figure,
    say_empty,
    seed_color,
    step_unit,
    styled,
)
from hedon.figure.trace import draw_time_axis, draw_traces, last_step

SMOOTH = 9
"""Number of neighboring frames that are averaged, so that the noise of single frames does not hide the trend."""
CAUSE_COLORS = {"age_energy": MUTED, "starved": BLUE, "eaten": VERMILION}
CAUSE_WORDS = {"age_energy": "by age and energy", "starved": "starved", "eaten": "eaten"}


def draw_numbers(histories: Mapping[str, pl.DataFrame]) -> Figure:
    """Draws the numbers alive over time, and one number against the other, with a line per world.

    Args:
        histories: Histories of two species by name, with the columns world, bin, step and alive.
    """
    (first_name, first_history), (second_name, second_history) = histories.items()
    combined = pl.concat([first_history, second_history])
    with styled():
        figure = new_figure(8.6, 3.4)
        time_axes, phase_axes = figure.subplots(1, 2, width_ratios=(1.5, 1.0))
        for (name, rows), color in zip(histories.items(), SEED_COLORS, strict=False):
            draw_traces(time_axes, rows, "alive", color, name, end=last_step(combined))
        time_axes.set_title("alive")
        time_axes.set_ylim(bottom=0)
        draw_time_axis(time_axes, combined)
        legend_above(time_axes)
        joined = first_history.join(second_history, on=["world", "bin"], suffix="_other").sort("world", "bin")
        for index, world in enumerate(joined.partition_by("world")):
            x, y = world["alive"].to_numpy(), world["alive_other"].to_numpy()
            phase_axes.plot(x, y, color=seed_color(index), linewidth=0.9, alpha=0.7)
            phase_axes.plot(x[-1:], y[-1:], "o", color=seed_color(index), markersize=4)
        phase_axes.set_title("one against the other")
        phase_axes.set_xlabel(f"{first_name} alive")
        phase_axes.set_ylabel(f"{second_name} alive")
        phase_axes.set_xlim(left=0)
        phase_axes.set_ylim(bottom=0)
        if joined.is_empty():
            say_empty(phase_axes, "nothing recorded yet")
    return figure


def draw_causes(rates: Mapping[str, pl.DataFrame]) -> Figure:
    """Draws the rate of each cause of death over time, with a panel per species.

    Args:
        rates: Death rates of each species by name, from `hedon.analysis.world.population.death_rates`.
    """
    with styled():
        figure = new_figure(4.3 * len(rates), 3.2)
        for axes, (name, rows) in zip(figure.subplots(1, len(rates), squeeze=False)[0], rates.items(), strict=True):
            for cause, color in CAUSE_COLORS.items():
                if rows[cause].fill_null(0).sum() > 0:
                    draw_traces(axes, rows, cause, color, CAUSE_WORDS[cause], thin=False)
            axes.set_title(name)
            axes.set_ylabel("deaths per 10,000 steps of life")
            axes.set_ylim(bottom=0)
            draw_time_axis(axes, rows)
            if axes.has_data():
                legend_above(axes)
            else:
                say_empty(axes, "no deaths yet")
    return figure


def draw_company(worlds: Mapping[int, pl.DataFrame], species: str, hunter: str) -> Figure:
    """Draws group sizes and distances to the nearest hunter over time, with the values expected by chance.

    Args:
        worlds: Company of each world by seed, from `hedon.analysis.world.group.company`.
        species: Name of the species whose groups are drawn.
        hunter: Name of the species that eats it.
    """
    panels = {
        "group": f"group of {species} in which one of them is",
        "distance": f"distance to the nearest {hunter} [u]",
    }
    unit, name = step_unit(max((last_step(rows) for rows in worlds.values()), default=0.0))
    with styled():
        figure = new_figure(8.6, 3.2)
        for axes, (column, title) in zip(figure.subplots(1, 2), panels.items(), strict=True):
            for index, rows in enumerate(worlds.values()):
                x = rows["step"].to_numpy() / unit
                label = {"found": "found", "chance": "placed by chance"} if index == 0 else {}
                for key, what, color in (
                    ("chance", f"{column}_chance", NEUTRAL_COLOR),
                    ("found", column, INK if len(worlds) == 1 else seed_color(index)),
                ):
                    y = rows[what].rolling_mean(SMOOTH, min_samples=1, center=True)
                    axes.plot(x, y, color=color, linewidth=1.2, alpha=0.8, label=label.get(key))
            axes.set_title(title, fontsize=9)
            axes.set_xlabel(f"time [{name}]")
            axes.set_ylim(bottom=0)
            legend_above(axes)
            if all(rows.is_empty() for rows in worlds.values()):
                say_empty(axes, "no positions were recorded")
    return figure
