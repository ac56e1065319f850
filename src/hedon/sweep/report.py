"""The report of a sweep: figures, and one page of text with a table of every response."""

import re
from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path

import polars as pl
from matplotlib.figure import Figure

from hedon.figure.style import save_figure
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.sweep.error import SweepError
from hedon.sweep.figure import draw_curves, draw_map
from hedon.sweep.plan import SweepPlan
from hedon.sweep.response import points, responses

PAGE = "report.md"
MOST_CELLS = 400
"""Most cells of a map, and most settings of the page's table."""


def write_report(plan: SweepPlan, table: pl.DataFrame, folder: Path, only: Sequence[str] = ()) -> list[Path]:
    """Writes response curves for each factor, maps for each two that are crossed, and a page that shows them.

    Args:
        plan: of the sweep.
        table: of its worlds so far.
        folder: made if it is not there.
        only: columns of the table to show; by default the usual ones.

    Returns:
        The files written, the page first.

    Raises:
        SweepError: there is no world yet, or a column is not one.
        RecordError: the folder cannot be written.
    """
    if table.is_empty():
        raise SweepError("no batch of the sweep is done yet: there is nothing to report")
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
        files = [save_figure(figure, folder / f"{name}.png") for name, figure in figures.items()]
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
    asked = len(plan.settings) * len(plan.seeds)
    lines = [
        f"# Sweep {plan.name}",
        "",
        f"{table.height} of {asked} worlds ({len(plan.settings)} settings x {len(plan.seeds)} seeds) of "
        f"{plan.steps:,} steps; {int(table['extinct'].sum())} died out{_alone(table)}. Intervals are of 95 %, over "
        "worlds.",
        "",
    ]
    if plan.factors and len(plan.settings) <= MOST_CELLS:
        lines += _rows(plan.factors, table, shown)
    lines += [line for name in figures for line in (f"![{name}]({name}.png)", "")]
    return "\n".join(lines).rstrip() + "\n"


def _alone(table: pl.DataFrame) -> str:
    """In how many worlds each of several species died out while others live on."""
    gone = {name.removesuffix(".extinct"): table[name] for name in table.columns if name.endswith(".extinct")}
    counts = {species: int((column & ~table["extinct"]).sum()) for species, column in gone.items()}
    return "".join(f", {species} alone in {count}" for species, count in counts.items())


def _rows(factors: Sequence[str], table: pl.DataFrame, shown: Mapping[str, str]) -> list[str]:
    """A row per setting: its worlds, and the mean and interval of each response."""
    titles = [*factors, "worlds", *shown.values()]
    lines = ["| " + " | ".join(titles) + " |", "|" + "---:|" * len(titles)]
    columns = [points(table, list(factors), name) for name in shown]
    counts = table.group_by(*factors).len()
    for cells in zip(*columns, strict=True):
        same = zip(factors, cells[0].at, strict=True)
        worlds = counts.filter(*(pl.col(factor) == value for factor, value in same))["len"].sum()
        texts = [_interval(cell.mean.mean, cell.mean.low, cell.mean.high) for cell in cells]
        lines.append("| " + " | ".join([*map(str, cells[0].at), str(worlds), *texts]) + " |")
    return [*lines, ""]


def _interval(mean: float | None, low: float | None, high: float | None) -> str:
    if mean is None:
        return ""
    return f"{mean:.4g}" if low is None or high is None else f"{mean:.4g} ({low:.3g} … {high:.3g})"


def _slug(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")
