"""The display of a run in a notebook: a small table, and a plot of the number of agents alive."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import polars as pl

from hedon.record.manifest import Manifest
from hedon.text import count

WIDTH, HEIGHT, EDGE = 460, 110, 16
"""Size of the figure, and its margin for labels [px]."""
COLORS = ("#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#5e4fa2", "#6b7884")
"""Colors of the worlds, in turn: Okabe & Ito (2008)."""
OPEN = 2**31 - 1
"""Largest number of steps of a run, used for worlds that a program drives, whose length is not known in advance."""
DASHES = ("", "6 3", "2 3", "6 3 2 3")
"""Dash patterns of the species of a world, in turn."""


def status_line(manifest: Manifest) -> str:
    """A line that describes a run and its progress."""
    name = manifest.name or manifest.preset or "run"
    worlds = count(len(manifest.seeds), "world")
    done = max(manifest.steps_done, default=0)
    fidelity = f" ({manifest.fidelity})" if manifest.fidelity else ""
    end = f" of {manifest.steps_asked:,}" if manifest.steps_asked < OPEN else ""
    return f"{name}{fidelity}, {worlds}, {manifest.status} at step {done:,}{end}"


def run_html(title: str, manifest: Manifest, population: pl.DataFrame) -> str:
    """An HTML table with a row per world and species, and a figure of the numbers alive.

    Args:
        title: Title, as plain text.
        manifest: Manifest of the run.
        population: Rows of the table `population`.
    """
    several = manifest.columns.several
    named = "<th>species</th>" if several else ""
    head = f"<tr><th>seed</th>{named}<th>steps</th><th>alive</th><th>births</th><th>deaths</th></tr>"
    worlds = [
        _Course(seed, index, name if several else "", population.filter(_rows_of(seed, name, several=several)))
        for index, seed in enumerate(manifest.seeds)
        for name in manifest.species
    ]
    rows = "".join(map(_row, worlds))
    return (
        f"<div><strong>{escape(title)}</strong><br>{escape(status_line(manifest))}"
        f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>{_figure(worlds)}</div>"
    )


@dataclass(frozen=True)
class _Course:
    """The rows of one species of a world; the name of the species is empty if there is only one."""

    seed: int
    index: int
    species: str
    rows: pl.DataFrame


def _rows_of(seed: int, species: str, *, several: bool) -> pl.Expr:
    here = pl.col("seed") == seed
    return here & (pl.col("species") == species) if several else here


def _row(course: _Course) -> str:
    rows, named = course.rows, [escape(course.species)] if course.species else []
    last = rows.filter(pl.col("step") == pl.col("step").max())
    step = last["step"][0] if last.height else 0
    numbers = (course.seed, *named, step, last["alive"].sum(), rows["births"].sum(), rows["deaths"].sum())
    return "<tr>" + "".join(f"<td>{number}</td>" for number in numbers) + "</tr>"


def _figure(courses: Sequence[_Course]) -> str:
    """An SVG of the numbers alive over time, with a line per world and species; empty if nothing is recorded."""
    last = max((int(each.rows["step"].to_numpy().max(initial=0)) for each in courses), default=0)
    most = max((int(each.rows["alive"].to_numpy().max(initial=0)) for each in courses), default=0)
    if not last or not most:
        return ""
    names = list(dict.fromkeys(each.species for each in courses))
    lines = []
    for each in courses:
        rows = each.rows.sort("step")
        x = EDGE + rows["step"].to_numpy() / last * (WIDTH - 2 * EDGE)
        y = HEIGHT - EDGE - rows["alive"].to_numpy() / most * (HEIGHT - 2 * EDGE)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        dashes = DASHES[names.index(each.species) % len(DASHES)]
        dashed = f' stroke-dasharray="{dashes}"' if dashes else ""
        title = f"<title>{escape(each.species)}, seed {each.seed}</title>" if each.species else ""
        color = COLORS[each.index % len(COLORS)]
        line = f'<polyline points="{points}" fill="none" stroke="{color}"{dashed}'
        lines.append(f"{line}>{title}</polyline>" if title else f"{line}/>")
    dashing = zip(names, ("solid", "dashed", "dotted", "dash-dotted"), strict=False)
    legend = ", ".join(f"{escape(name)} {how}" for name, how in dashing if name)
    base = f'<line x1="{EDGE}" x2="{WIDTH - EDGE}" y1="{HEIGHT - EDGE}" y2="{HEIGHT - EDGE}" stroke="#c9d1d8"/>'
    words = (
        f'<text x="{EDGE}" y="{EDGE - 5}">alive, up to {most:,}{f" ({legend})" if legend else ""}</text>'
        f'<text x="{WIDTH - EDGE}" y="{HEIGHT - 3}" text-anchor="end">step {last:,}</text>'
    )
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" '
        f'aria-label="agents alive over time" font-size="10" font-family="sans-serif" fill="#6b7884">'
        f"{base}{''.join(lines)}{words}</svg>"
    )
