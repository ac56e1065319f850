"""The report of a sweep: curves and maps of its measures, and one page with a table of them."""

import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

import polars as pl

from hedon.analysis.result import ResultTable, make_table
from hedon.compare.error import CompareError
from hedon.compare.figure import draw_curves, draw_map
from hedon.compare.response import points, responses
from hedon.ensemble.plan import SweepPlan
from hedon.figure.named import NamedFigure
from hedon.report.answer import Answer, simple_answer
from hedon.statistic.interval import Interval
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.text import count

MOST_CELLS = 400
"""Largest number of cells in a map, and of conditions in the page's table."""


def sweep_answer(
    plan: SweepPlan, table: pl.DataFrame, only: Sequence[str] = (), titles: Mapping[str, str] | None = None
) -> Answer:
    """Response curves for each factor of a sweep, maps for each pair of crossed factors, and a table of all responses.

    Args:
        plan: Plan of the sweep.
        table: Table of its worlds so far.
        only: Columns of the table to show; by default the usual ones.
        titles: Titles of measures that its configs add, by name.

    Raises:
        CompareError: There is no world yet, or a column does not contain numbers.
    """
    if table.is_empty():
        raise CompareError("no batch of the sweep is done yet: there is nothing to report")
    shown = responses(table, only, plan.factors, titles)
    figures: list[NamedFigure] = []
    varied = [factor for factor in plan.factors if table[factor].n_unique() > 1]
    for factor in varied:
        drawn = draw_curves(table, factor, shown, ranged=factor in plan.ranged)
        figures.append(NamedFigure(f"curve-{_slug(factor)}", f"How does {factor} act?", drawn))
    for pair in _crossed(table, varied):
        for name, title in shown.items():
            stem = f"map-{_slug(pair[0])}-{_slug(pair[1])}-{name.replace('.', '-')}"
            question = f"{title}, by {pair[0]} and {pair[1]}"
            figures.append(NamedFigure(stem, question, draw_map(table, pair, name, title)))
    intro = (
        f"{table.height} of {count(plan.worlds, 'world')} ({count(len(plan.conditions), 'setting')} x "
        f"{count(len(plan.seeds), 'seed')}) of {count(plan.steps, 'step')}; {int(table['extinct'].sum())} died out"
        f"{_alone(table)}. Intervals are of 95 %, over worlds, from {FOR_INTERVAL} worlds on."
    )
    content = {"sweep": plan.name, "steps": plan.steps, "factors": list(plan.factors)}
    tables = [settings_table(plan, table, shown), _responses_table(plan, table, shown)]
    return simple_answer("report", f"Sweep {plan.name}", content, tables, intro, figures)


def _responses_table(plan: SweepPlan, table: pl.DataFrame, shown: Mapping[str, str]) -> ResultTable:
    """Every mean with its interval, a row per condition and measure, for the file."""
    factors = list(plan.factors)
    rows = [
        {**dict(zip(factors, point.at, strict=True)), "measure": name, **vars(point.mean)}
        for name in shown
        for point in points(table, factors, name)
    ]
    return make_table("response", "Means over worlds", rows, shown=False)


def _crossed(table: pl.DataFrame, factors: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of factors that have every combination of their values, few enough for a map."""
    pairs = []
    for first, second in combinations(factors, 2):
        cells = table[first].n_unique() * table[second].n_unique()
        if cells <= MOST_CELLS and table.select(first, second).unique().height == cells:
            pairs.append((first, second))
    return pairs


def _alone(table: pl.DataFrame) -> str:
    """The number of worlds in which each of several species died out while others survived."""
    gone = {name.removesuffix(".extinct"): table[name] for name in table.columns if name.endswith(".extinct")}
    counts = {species: int((column & ~table["extinct"]).sum()) for species, column in gone.items()}
    return "".join(f", {species} alone in {count}" for species, count in counts.items())


def settings_table(
    plan: SweepPlan,
    table: pl.DataFrame,
    shown: Mapping[str, str] | None = None,
    most: int = MOST_CELLS,
    titles: Mapping[str, str] | None = None,
) -> ResultTable:
    """A table with a row per condition: its worlds, and the mean and interval of each response.

    Args:
        plan: Plan of the sweep.
        table: Table of its worlds so far.
        shown: Columns to show, with their titles; None for the usual ones.
        most: Largest number of rows.
        titles: Titles of measures that its configs add, by name.
    """
    if table.is_empty():
        return make_table("sweep", f"Sweep {plan.name}: no world yet", [])
    shown, factors = shown or responses(table, (), plan.factors, titles), list(plan.factors)
    counts: dict[tuple[Any, ...], int] = {(): table.height}
    counts |= {tuple(at): rows.height for at, rows in table.group_by(factors)} if factors else {}
    rows: dict[tuple[Any, ...], dict[str, Any]] = {}
    for name, title in shown.items():
        for point in points(table, factors, name):
            row = rows.setdefault(point.at, {**dict(zip(factors, point.at, strict=True)), "worlds": counts[point.at]})
            row[title] = _interval(point.mean)
    note = f"Means over worlds, with intervals of 95 % from {FOR_INTERVAL} worlds on."
    note += f" The first {most} of {len(rows):,} settings; table.parquet has all." if len(rows) > most else ""
    return make_table("sweep", f"Sweep {plan.name}", list(rows.values())[:most], note)


def _interval(point: Interval) -> str:
    if point.mean is None:
        return ""
    known = point.worlds >= FOR_INTERVAL and point.low is not None and point.high is not None
    return f"{point.mean:.4g} ({point.low:.3g} … {point.high:.3g})" if known else f"{point.mean:.4g}"


def _slug(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")
