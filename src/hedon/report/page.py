"""A report as one page: answers in words, verdicts, what was run, figures, tables, settings and manifests."""

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markdown_it import MarkdownIt
from markupsafe import Markup

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import Conditions, WorldRecord
from hedon.config import dump_toml
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.demography.forecast import setting_warnings
from hedon.figure.named import NamedFigure
from hedon.figure.style import svg_bytes
from hedon.measure.summary import plain
from hedon.record.atomic import write_atomically
from hedon.record.reader import Run
from hedon.report.analysis import Analysis
from hedon.report.markdown import escape_markdown, pipe_table
from hedon.report.table import cells, is_numeric
from hedon.statistic.minimum import FOR_INTERVAL


class Markdown(str):
    """Text that is Markdown already: it is not escaped again."""


@dataclass(frozen=True)
class FigureFile:
    """A figure of a report.

    Attributes:
        condition: that it shows.
        question: that it answers, its heading.
        path: of its SVG file, relative to the report.
        svg: the content of the file.
        caption: how to read it; may be empty.
    """

    condition: str
    question: str
    path: str
    svg: bytes
    caption: str = ""

    @property
    def uri(self) -> str:
        """The SVG as a data URI."""
        return "data:image/svg+xml;base64," + base64.b64encode(self.svg).decode()


def write_figure(folder: Path, condition: str, named: NamedFigure, path: str) -> FigureFile:
    """Writes the file of a figure that a page shows."""
    svg = svg_bytes(named.figure)
    write_atomically(folder / path, lambda file: file.write(svg))
    return FigureFile(condition, named.question, path, svg, named.caption)


def report_pages(analysis: Analysis, figures: Sequence[FigureFile]) -> tuple[str, str]:
    """The report as HTML that needs no other file, and as Markdown, with the figures as files beside it."""
    context = _context(analysis, figures)
    return render("report.html.j2", context), render("report.md.j2", context)


def render(template: str, context: Mapping[str, Any]) -> str:
    """A page from a template; what it prints is escaped unless marked as `verbatim` or `prose`."""
    is_html = template.endswith(".html.j2")
    environment = Environment(
        loader=PackageLoader("hedon.report", "template"),
        autoescape=is_html,
        finalize=None if is_html else _markdown,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["verbatim"] = Markdown
    environment.filters["prose"] = _html_prose if is_html else Markdown
    return environment.get_template(template).render(context)


def _html_prose(text: str) -> Markup:
    """Markdown that a study's author wrote, as HTML; HTML within it stays text."""
    return Markup(MarkdownIt("commonmark", {"html": False}).renderInline(text))


def _markdown(value: Any) -> str:
    return value if isinstance(value, Markdown) else escape_markdown(str(value))


def _context(analysis: Analysis, figures: Sequence[FigureFile]) -> dict[str, Any]:
    shown = {name: table_context(table) for name, table in analysis.tables.items() if table.shown}
    conditions = []
    for name, worlds in analysis.conditions.items():
        drawn = [figure for figure in figures if figure.condition == name]
        conditions.append(
            condition_context(name, worlds)
            | {
                "answers": analysis.answers.get(name, []),
                "warnings": setting_warnings(worlds[0].config, worlds[0].species),
                "picture": drawn[:1],
                "figures": drawn[1:],
            }
        )
    return {
        "title": " · ".join(condition["name"] for condition in conditions),
        "cautions": [*analysis.unfinished, *narrow_intervals(analysis.conditions)],
        "verdict": shown.pop("verdict", None),
        "conditions": conditions,
        "tables": list(shown.values()),
        **runs_context(analysis.runs),
    }


def narrow_intervals(conditions: Conditions) -> list[str]:
    """A sentence for each condition of which some worlds died out: so far from normal values, t is too narrow."""
    told = []
    for name, worlds in conditions.items():
        gone = sum(world.extinct_step is not None for world in worlds)
        if 0 < gone < len(worlds) and len(worlds) >= FOR_INTERVAL:
            told.append(
                f"{gone} of {len(worlds)} worlds of {name} died out, so intervals of its numbers alive are too narrow: "
                "with one world in five at 0 they miss the mean in 24 % of cases with five worlds, in 11 % with ten."
            )
    return told


def runs_context(runs: Sequence[Run]) -> dict[str, Any]:
    """What a page says of the runs behind it: their manifests, and the versions that made them."""
    return {
        "runs": [
            {
                "path": run.path.name,
                "status": run.manifest.status,
                "damaged": [str(path.relative_to(run.path)) for path in run.damaged_parts()],
                "manifest": json.dumps(plain(asdict(run.manifest)), indent=2, ensure_ascii=False),
            }
            for run in runs
        ],
        "versions": sorted({run.manifest.hedon_version or "unknown" for run in runs}),
    }


def condition_context(name: str, worlds: Sequence[WorldRecord]) -> dict[str, Any]:
    """What a page says of some worlds of one setting, and of the setting."""
    config = worlds[0].config
    return {
        "name": name,
        "worlds": len(worlds),
        "seeds": ", ".join(str(world.seed) for world in worlds),
        "steps": f"{max(world.last_step for world in worlds):,}",
        "agents": f"{sum(world.agents.height for world in worlds):,}",
        "extinct": [(world.seed, f"{world.extinct_step:,}") for world in worlds if world.extinct_step is not None],
        "preset": f"{config.preset} ({config.fidelity})",
        "changes": [(path, _text(old), _text(new)) for path, old, new in changed_settings(config)],
        "toml": dump_toml(config),
    }


def table_context(table: ResultTable) -> Mapping[str, Any]:
    """What a page needs of a table."""
    headers, rows = cells(table)
    return {
        "name": table.name,
        "title": table.title,
        "note": table.note,
        "headers": headers,
        "rows": rows,
        "numeric": [is_numeric(rows, i) for i in range(len(headers))],
        "markdown": pipe_table(headers, rows),
    }


def _text(value: Any) -> str:
    return "(absent)" if value is None else format_value(value)
