"""How did the worlds fare over time?"""

from collections.abc import Mapping, Sequence

import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.analysis.world.population import history
from hedon.figure.style import BLUE, INK, ORANGE, VERMILION, VIOLET, legend_above, new_figure, say_empty, styled
from hedon.figure.trace import draw_time_axis, draw_traces

_POINTS = 100  # few enough that noise does not hide the trend


def draw_population(population: pl.DataFrame, meals: Sequence[str], colors: Mapping[str, str]) -> Figure:
    """Six panels: agents alive, births and deaths, failed births, energy, meals, generation."""
    rows = history(population, meals, points=_POINTS)
    with styled():
        figure = new_figure(8.6, 4.9)
        panels = figure.subplots(2, 3, sharex=True)
        _draw(panels[0, 0], rows, "agents alive", {"alive": ("", INK)})
        births = {"births": ("births", BLUE), "deaths": ("deaths", VERMILION)}
        _draw(panels[0, 1], rows, "births and deaths per 1000 steps", births)
        failed = {
            "births_failed_full": ("world full", VIOLET),
            "births_failed_space": ("no free place", ORANGE),
        }
        _draw(panels[0, 2], rows, "failed births per 1000 steps", failed)
        _draw(panels[1, 0], rows, "mean energy of the living", {"energy_mean": ("", INK)})
        meal_styles = {f"eaten_{meal}": (meal if len(meals) > 1 else "", colors[meal]) for meal in meals}
        subject = "foods" if all(f"food_{meal}" in population.columns for meal in meals) else "meals"
        _draw(panels[1, 1], rows, f"{subject} eaten per 1000 steps of life", meal_styles)
        _draw(panels[1, 2], rows, "mean generation", {"generation_mean": ("", INK)})
        for axes in panels[1]:
            draw_time_axis(axes, rows)
    return figure


def _draw(axes: Axes, rows: pl.DataFrame, title: str, styles: Mapping[str, tuple[str, str]]) -> None:
    axes.set_title(title, fontsize=9)
    for column, (label, color) in styles.items():
        draw_traces(axes, rows, column, color, label or None, thin=len(styles) == 1)
    axes.set_ylim(bottom=0, top=None if _largest(rows, styles) > 0 else 1)
    if any(label for label, _ in styles.values()):
        legend_above(axes)
    if rows.is_empty():
        say_empty(axes, "nothing recorded yet")


def _largest(rows: pl.DataFrame, columns: Mapping[str, object]) -> float:
    return max((float(rows[column].drop_nulls().to_numpy().max(initial=0.0)) for column in columns), default=0.0)
