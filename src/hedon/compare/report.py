"""The report of a sweep: curves and maps of its measures, and one page with a table of them."""

import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.compare.error import CompareError
from hedon.compare.figure import draw_curves, draw_map
from hedon.compare.response import points, responses
from hedon.figure.style import save_figure
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.report.markdown import pipe_table
from hedon.report.table import cells
from hedon.statistic.interval import Interval
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.sweep.plan import SweepPlan
from hedon.text import count

PAGE = "report.md"
MOST_CELLS = 400
"""Most cells of a map, and most settings of the page's table."""


def write_report(plan: SweepPlan, table: pl.DataFrame, folder: Path, only: Sequence[str] = ()) -> list[Path]:
    """Writes response curves for each factor, maps for each two that are crossed, and a page that shows them.

    Returns:
        The files written, the page first.

    Raises:
        CompareError: there is no world yet, or a column is not one.
        RecordError: the folder cannot be written.
    """
    if table.is_empty():
        raise CompareError("no batch of the sweep is done yet: there is nothing to report")
    shown = responses(table, only, plan.factors)
    figures: dict[str, Figure] = {}
    varied = [factor for factor in plan.factors if table[factor].n_unique() > 1]
    for factor in varied:
        figures[f"curve-{_slug(factor)}"] = draw_curves(table, factor, shown, ranged=factor in plan.ranged)
    for pair in _crossed(table, varied):
        for name, title in shown.items():
            figures[f"map-{_slug(pair[0])}-{_slug(pair[1])}-{name.replace('.', '-')}"] = draw_map(
                table, pair, name, title
            )
    with one_writer(folder, "the report"):
        for stale in [*folder.glob("curve-*.svg"), *folder.glob("map-*.svg")]:
            if stale.stem not in figures:  # of a plan before
                stale.unlink()
        files = [save_figure(figure, folder / f"{name}.svg") for name, figure in figures.items()]
        page = _page(plan, table, shown, list(figures)).encode()
        write_atomically(folder / PAGE, lambda file: file.write(page))
    return [folder / PAGE, *files]


def _crossed(table: pl.DataFrame, factors: Sequence[str]) -> list[tuple[str, str]]:
    """Pairs of factors that have every combination of their values, few enough for a map."""
    pairs = []
    for first, second in combinations(factors, 2):
        cells = table[first].n_unique() * table[second].n_unique()
        if cells <= MOST_CELLS and table.select(first, second).unique().height == cells:
            pairs.append((first, second))
    return pairs


def _page(plan: SweepPlan, table: pl.DataFrame, shown: Mapping[str, str], figures: Sequence[str]) -> str:
    lines = [
        f"# Sweep {plan.name}",
        "",
        f"{table.height} of {count(plan.worlds, 'world')} ({count(len(plan.conditions), 'setting')} x "
        f"{count(len(plan.seeds), 'seed')}) of {count(plan.steps, 'step')}; {int(table['extinct'].sum())} died out"
        f"{_alone(table)}. Intervals are of 95 %, over worlds, from {FOR_INTERVAL} worlds on.",
        "",
    ]
    if plan.factors and len(plan.conditions) <= MOST_CELLS:
        lines += [pipe_table(*cells(settings_table(plan, table, shown)))]
    lines += [line for name in figures for line in (f"![{name}]({name}.svg)", "")]
    return "\n".join(lines).rstrip() + "\n"


def _alone(table: pl.DataFrame) -> str:
    """In how many worlds each of several species died out while others live on."""
    gone = {name.removesuffix(".extinct"): table[name] for name in table.columns if name.endswith(".extinct")}
    counts = {species: int((column & ~table["extinct"]).sum()) for species, column in gone.items()}
    return "".join(f", {species} alone in {count}" for species, count in counts.items())


def settings_table(
    plan: SweepPlan, table: pl.DataFrame, shown: Mapping[str, str] | None = None, most: int = MOST_CELLS
) -> ResultTable:
    """A row per setting: its worlds, and the mean and interval of each response."""
    if table.is_empty():
        return make_table("sweep", f"Sweep {plan.name}: no world yet", [])
    shown, factors = shown or responses(table, (), plan.factors), list(plan.factors)
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
