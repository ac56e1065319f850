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
    progress = max(manifest.steps_done, default=0)
    fidelity = f" ({manifest.fidelity})" if manifest.fidelity else ""
    end = f" of {manifest.steps_asked:,}" if manifest.steps_asked < OPEN else ""
    return f"{name}{fidelity}, {worlds}, {manifest.status} at step {progress:,}{end}"


def run_html(title: str, manifest: Manifest, population: pl.DataFrame) -> str:
    """An HTML table with a row per world and species, and a figure of the numbers alive.

    Args:
        title: Title, as plain text.
        manifest: Manifest of the run.
        population: Rows of the table `population`.
    """
    several = manifest.columns.several
    species_header = "<th>species</th>" if several else ""
    header = f"<tr><th>seed</th>{species_header}<th>steps</th><th>alive</th><th>births</th><th>deaths</th></tr>"
    worlds = [
        _Course(seed, index, name if several else "", population.filter(_rows_of(seed, name, several=several)))
        for index, seed in enumerate(manifest.seeds)
        for name in manifest.species
    ]
    rows = "".join(map(_row, worlds))
    return (
        f"<div><strong>{escape(title)}</strong><br>{escape(status_line(manifest))}"
        f"<table><thead>{header}</thead><tbody>{rows}</tbody></table>{_figure(worlds)}</div>"
    )


@dataclass(frozen=True)
class _Course:
    """The rows of one species of a world; the name of the species is empty if there is only one."""

    seed: int
    index: int
    species: str
    rows: pl.DataFrame


def _rows_of(seed: int, species: str, *, several: bool) -> pl.Expr:
    in_world = pl.col("seed") == seed
    return in_world & (pl.col("species") == species) if several else in_world


def _row(course: _Course) -> str:
    rows, species_cells = course.rows, [escape(course.species)] if course.species else []
    last_rows = rows.filter(pl.col("step") == pl.col("step").max())
    step = last_rows["step"][0] if last_rows.height else 0
    numbers = (course.seed, *species_cells, step, last_rows["alive"].sum(), rows["births"].sum(), rows["deaths"].sum())
    return "<tr>" + "".join(f"<td>{number}</td>" for number in numbers) + "</tr>"


def _figure(courses: Sequence[_Course]) -> str:
    """An SVG of the numbers alive over time, with a line per world and species; empty if nothing is recorded."""
    last_step = max((int(course.rows["step"].to_numpy().max(initial=0)) for course in courses), default=0)
    most_alive = max((int(course.rows["alive"].to_numpy().max(initial=0)) for course in courses), default=0)
    if not last_step or not most_alive:
        return ""
    names = list(dict.fromkeys(course.species for course in courses))
    lines = []
    for course in courses:
        rows = course.rows.sort("step")
        x = EDGE + rows["step"].to_numpy() / last_step * (WIDTH - 2 * EDGE)
        y = HEIGHT - EDGE - rows["alive"].to_numpy() / most_alive * (HEIGHT - 2 * EDGE)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        dashes = DASHES[names.index(course.species) % len(DASHES)]
        dash_attribute = f' stroke-dasharray="{dashes}"' if dashes else ""
        title = f"<title>{escape(course.species)}, seed {course.seed}</title>" if course.species else ""
        color = COLORS[course.index % len(COLORS)]
        line = f'<polyline points="{points}" fill="none" stroke="{color}"{dash_attribute}'
        lines.append(f"{line}>{title}</polyline>" if title else f"{line}/>")
    name_styles = zip(names, ("solid", "dashed", "dotted", "dash-dotted"), strict=False)
    legend = ", ".join(f"{escape(name)} {style}" for name, style in name_styles if name)
    base = f'<line x1="{EDGE}" x2="{WIDTH - EDGE}" y1="{HEIGHT - EDGE}" y2="{HEIGHT - EDGE}" stroke="#c9d1d8"/>'
    captions = (
        f'<text x="{EDGE}" y="{EDGE - 5}">alive, up to {most_alive:,}{f" ({legend})" if legend else ""}</text>'
        f'<text x="{WIDTH - EDGE}" y="{HEIGHT - 3}" text-anchor="end">step {last_step:,}</text>'
    )
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" '
        f'aria-label="agents alive over time" font-size="10" font-family="sans-serif" fill="#6b7884">'
        f"{base}{''.join(lines)}{captions}</svg>"
    )
