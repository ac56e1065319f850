"""A report as one page: verdicts, what was run, figures, tables, settings and manifests."""

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from hedon.analysis.analysis_table import cells, is_numeric, pipe_table
from hedon.analysis.analyze import Analysis
from hedon.analysis.forecast import forecast
from hedon.analysis.summary import plain
from hedon.analysis.topic.result import ResultTable
from hedon.analysis.world import WorldRecord
from hedon.config import dump_toml, load_config
from hedon.config.dump import diff
from hedon.config.load import PRESETS
from hedon.config.problem import format_value


@dataclass(frozen=True)
class FigureFile:
    """A figure of a report.

    Attributes:
        condition: that it shows.
        question: that it answers, its heading.
        path: of its PNG file, relative to the report.
        svg: the same as SVG.
    """

    condition: str
    question: str
    path: str
    svg: bytes

    @property
    def uri(self) -> str:
        """The SVG as a data URI."""
        return "data:image/svg+xml;base64," + base64.b64encode(self.svg).decode()


def html_page(analysis: Analysis, figures: Sequence[FigureFile]) -> str:
    """The report as HTML that needs no other file."""
    return _render("report.html.j2", analysis, figures)


def markdown_page(analysis: Analysis, figures: Sequence[FigureFile]) -> str:
    """The report as Markdown, with the figures as files beside it."""
    return _render("report.md.j2", analysis, figures)


def _render(template: str, analysis: Analysis, figures: Sequence[FigureFile]) -> str:
    environment = Environment(
        loader=PackageLoader("hedon.analysis", "template"),
        autoescape=template.endswith(".html.j2"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template(template).render(_context(analysis, figures))


def _context(analysis: Analysis, figures: Sequence[FigureFile]) -> dict[str, Any]:
    shown = {name: _table(table) for name, table in analysis.tables.items() if table.shown}
    conditions = [_condition(name, worlds, figures) for name, worlds in analysis.conditions.items()]
    return {
        "title": " · ".join(condition["name"] for condition in conditions),
        "verdict": shown.pop("verdict", None),
        "conditions": conditions,
        "tables": list(shown.values()),
        "runs": [
            {
                "path": run.path.name,
                "status": run.manifest.status,
                "damaged": [str(path.relative_to(run.path)) for path in run.damaged_parts()],
                "manifest": json.dumps(plain(asdict(run.manifest)), indent=2, ensure_ascii=False),
            }
            for run in analysis.runs
        ],
        "versions": sorted({run.manifest.hedon_version or "unknown" for run in analysis.runs}),
    }


def _condition(name: str, worlds: Sequence[WorldRecord], figures: Sequence[FigureFile]) -> dict[str, Any]:
    config = worlds[0].config
    changes: list[tuple[str, Any, Any]] = []
    if config.preset in PRESETS:
        changes = diff(load_config(config.preset, config.fidelity), config)
    return {
        "name": name,
        "worlds": len(worlds),
        "seeds": ", ".join(str(world.seed) for world in worlds),
        "steps": f"{max(world.last_step for world in worlds):,}",
        "agents": f"{sum(world.agents.height for world in worlds):,}",
        "extinct": [(world.seed, f"{world.extinct_step:,}") for world in worlds if world.extinct_step is not None],
        "warnings": forecast(config).warnings,
        "preset": f"{config.preset} ({config.fidelity})",
        "changes": [(path, _text(old), _text(new)) for path, old, new in changes],
        "toml": dump_toml(config),
        "figures": [figure for figure in figures if figure.condition == name],
    }


def _table(table: ResultTable) -> Mapping[str, Any]:
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
