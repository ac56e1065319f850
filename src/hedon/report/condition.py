"""All figures of one condition, in the order of a report."""

from collections.abc import Iterator, Mapping, Sequence

import polars as pl

from hedon.analysis.gene.band import drift_bands, drift_genes
from hedon.analysis.gene.weight import last_living
from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord
from hedon.config.color import meal_colors, weight_colors
from hedon.config.title import weight_titles
from hedon.figure.demography import draw_demography
from hedon.figure.history import HistoryRow, draw_histories
from hedon.figure.lineage import draw_lineages
from hedon.figure.named import NamedFigure
from hedon.figure.population import draw_population
from hedon.figure.regime import draw_regimes
from hedon.figure.selection import draw_selection
from hedon.figure.survival import draw_survival
from hedon.figure.weight import draw_weights
from hedon.report import figure


def condition_figures(worlds: Sequence[WorldRecord], tables: Mapping[str, ResultTable]) -> Iterator[NamedFigure]:
    """Draws the figures of a condition, one at a time."""
    first_world = worlds[0]
    condition_tables = {name: _of_condition(table.rows, first_world.condition) for name, table in tables.items()}
    colors = meal_colors(first_world.config, first_world.prey)
    titles = weight_titles(first_world.reward_names, first_world.neutral_names)
    tints = weight_colors(titles, colors)
    living = [last_living(world.agents, world.population) for world in worlds]
    agents = pl.concat([rows.with_columns(world=_index(i)) for i, rows in enumerate(living)])
    population = pl.concat([world.population.with_columns(world=_index(i)) for i, world in enumerate(worlds)])

    def rows(name: str) -> pl.DataFrame:
        return condition_tables.get(name, pl.DataFrame())

    meals, neutral = (*first_world.food_kinds, *first_world.prey), first_world.neutral_names
    history_row = HistoryRow(population, drift=drift_bands(worlds))
    yield figure.HISTORY.drawn(draw_histories([history_row], first_world.reward_names, neutral, colors))
    yield figure.WEIGHTS.drawn(draw_weights(agents, first_world.reward_names, drift_genes(worlds, living)))
    yield figure.POPULATION.drawn(draw_population(population, meals, colors))
    yield figure.REGIME.drawn(draw_regimes(rows("regime_time")))
    yield figure.SURVIVAL.drawn(draw_survival(rows("survival"), rows("lifetime_world")))
    selection = draw_selection(rows("selection_window"), rows("selection_world"), titles, tints)
    yield figure.SELECTION.drawn(selection)
    yield figure.LINEAGE.drawn(draw_lineages(rows("lineage"), titles, tints))
    demography = draw_demography(first_world.species_config, [world.population for world in worlds])
    yield figure.DEMOGRAPHY.drawn(demography)


def _of_condition(rows: pl.DataFrame, condition: str) -> pl.DataFrame:
    return rows.filter(pl.col("condition") == condition) if "condition" in rows.columns else rows


def _index(i: int) -> pl.Expr:
    return pl.lit(i, pl.Int32)
