"""All figures of one condition, by name and in the order in which a report shows them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.figure_demography import draw_demography
from hedon.analysis.figure_history import draw_history
from hedon.analysis.figure_lineage import draw_lineages
from hedon.analysis.figure_population import draw_population
from hedon.analysis.figure_regime import draw_regimes
from hedon.analysis.figure_selection import draw_selection
from hedon.analysis.figure_survival import draw_survival
from hedon.analysis.figure_weights import draw_weights
from hedon.analysis.style import food_colors, weight_colors, weight_titles
from hedon.analysis.topic.result import ResultTable
from hedon.analysis.world import WorldRecord


@dataclass(frozen=True)
class NamedFigure:
    """A figure.

    Attributes:
        name: names its file.
        question: that it answers, its heading.
        figure: itself.
        caption: how to read it; may be empty.
    """

    name: str
    question: str
    figure: Figure
    caption: str = ""


def condition_figures(worlds: Sequence[WorldRecord], tables: Mapping[str, ResultTable]) -> Iterator[NamedFigure]:
    """Draws them one after the other.

    Args:
        worlds: of one condition.
        tables: of an analysis of all topics, by name; rows of other conditions are left out.
    """
    first = worlds[0]
    mine = {name: _of_condition(table.rows, first.condition) for name, table in tables.items()}
    colors = food_colors(first.food_kinds, [food.color for food in first.config.food.values()])
    titles = weight_titles(first.reward_names, first.neutral_names)
    tints = weight_colors(titles, colors)
    agents = pl.concat([world.agents.with_columns(world=_index(i)) for i, world in enumerate(worlds)])
    population = pl.concat([world.population.with_columns(world=_index(i)) for i, world in enumerate(worlds)])

    def rows(name: str) -> pl.DataFrame:
        return mine.get(name, pl.DataFrame())

    kinds, neutral = first.food_kinds, first.neutral_names
    yield NamedFigure("weights", "Which rewards evolved?", draw_weights(agents, kinds, neutral))
    yield NamedFigure("history", "When did they evolve?", draw_history(population, kinds, neutral, colors))
    yield NamedFigure("population", "How do the worlds fare?", draw_population(population, kinds, colors))
    yield NamedFigure("regime", "What limits them?", draw_regimes(rows("regime_time")))
    yield NamedFigure("survival", "How long do agents live?", draw_survival(rows("survival"), rows("lifetime_world")))
    yield NamedFigure(
        "selection",
        "Which weights are selected?",
        draw_selection(rows("selection_window"), rows("selection_world"), titles, tints),
    )
    yield NamedFigure("lineage", "Whose descendants are left?", draw_lineages(rows("lineage"), titles, tints))
    yield NamedFigure(
        "demography",
        "What is energy worth?",
        draw_demography(first.config, [world.population for world in worlds]),
    )


def _of_condition(rows: pl.DataFrame, condition: str) -> pl.DataFrame:
    return rows.filter(pl.col("condition") == condition) if "condition" in rows.columns else rows


def _index(i: int) -> pl.Expr:
    return pl.lit(i, pl.Int32)
