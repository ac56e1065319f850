"""How a run shows itself in a notebook: a small table, and how many lived over time."""

from collections.abc import Sequence
from html import escape

import polars as pl

from hedon.record.manifest import Manifest

WIDTH, HEIGHT, EDGE = 460, 110, 16
"""Of the figure, and what its edge takes for labels [px]."""
COLORS = ("#0072b2", "#d55e00", "#009e73", "#e69f00", "#cc79a7", "#56b4e9", "#5e4fa2", "#6b7884")
"""Of the worlds, in turn: Okabe & Ito (2008)."""


def status_line(manifest: Manifest) -> str:
    """What a run is and how far it has come, in one line."""
    name = manifest.name or manifest.preset or "run"
    worlds = f"{len(manifest.seeds)} world{'s' if len(manifest.seeds) != 1 else ''}"
    done = max(manifest.steps_done, default=0)
    fidelity = f" ({manifest.fidelity})" if manifest.fidelity else ""
    return f"{name}{fidelity}, {worlds}, {manifest.status} at step {done:,} of {manifest.steps_asked:,}"


def run_html(title: str, manifest: Manifest, population: pl.DataFrame) -> str:
    """A table with a row per world, and a figure of the numbers alive.

    Args:
        title: stands above; any text, which is escaped.
        manifest: of the run.
        population: table `population`.
    """
    head = "<tr><th>seed</th><th>steps</th><th>alive</th><th>births</th><th>deaths</th></tr>"
    worlds = [population.filter(pl.col("seed") == seed) for seed in manifest.seeds]
    rows = "".join(_row(seed, rows) for seed, rows in zip(manifest.seeds, worlds, strict=True))
    return (
        f"<div><strong>{escape(title)}</strong><br>{escape(status_line(manifest))}"
        f"<table><thead>{head}</thead><tbody>{rows}</tbody></table>{_figure(worlds)}</div>"
    )


def _row(seed: int, rows: pl.DataFrame) -> str:
    last = rows.filter(pl.col("step") == pl.col("step").max())
    step = last["step"][0] if last.height else 0
    numbers = (seed, step, last["alive"].sum(), rows["births"].sum(), rows["deaths"].sum())
    return "<tr>" + "".join(f"<td>{number}</td>" for number in numbers) + "</tr>"


def _figure(worlds: Sequence[pl.DataFrame]) -> str:
    """Numbers alive over time as an SVG, a line per world; empty where nothing is recorded."""
    courses = [rows.group_by("step").agg(pl.col("alive").sum()).sort("step") for rows in worlds]
    last = max((int(course["step"][-1]) for course in courses if course.height), default=0)
    most = max((int(course["alive"].to_numpy().max()) for course in courses if course.height), default=0)
    if not last or not most:
        return ""
    lines = []
    for i, course in enumerate(courses):
        x = EDGE + course["step"].to_numpy() / last * (WIDTH - 2 * EDGE)
        y = HEIGHT - EDGE - course["alive"].to_numpy() / most * (HEIGHT - 2 * EDGE)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        lines.append(f'<polyline points="{points}" fill="none" stroke="{COLORS[i % len(COLORS)]}"/>')
    base = f'<line x1="{EDGE}" x2="{WIDTH - EDGE}" y1="{HEIGHT - EDGE}" y2="{HEIGHT - EDGE}" stroke="#c9d1d8"/>'
    words = (
        f'<text x="{EDGE}" y="{EDGE - 5}">alive, up to {most:,}</text>'
        f'<text x="{WIDTH - EDGE}" y="{HEIGHT - 3}" text-anchor="end">step {last:,}</text>'
    )
    return (
        f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" '
        f'aria-label="agents alive over time" font-size="10" font-family="sans-serif" fill="#6b7884">'
        f"{base}{''.join(lines)}{words}</svg>"
    )
