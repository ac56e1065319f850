"""A page: sections of text, lists, figures and tables, and the settings and runs behind them, as HTML and Markdown."""

import base64
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markdown_it import MarkdownIt
from markupsafe import Markup

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import Conditions, WorldRecord
from hedon.config import dump_toml
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.measure.summary import plain
from hedon.record.reader import Run
from hedon.report.markdown import escape_markdown, pipe_table
from hedon.report.table import cells, is_numeric
from hedon.text import count


@dataclass(frozen=True)
class FigureFile:
    """A figure of a page.

    Attributes:
        question: The question that it answers, used as its heading.
        path: Path of its SVG file, relative to the page.
        svg: Content of the SVG file.
        caption: How to read the figure; may be empty.
        others: Contents of the figure's files in other formats, by path.
    """

    question: str
    path: str
    svg: bytes
    caption: str = ""
    others: Mapping[str, bytes] = field(default_factory=dict)

    @property
    def uri(self) -> str:
        """The SVG as a data URI."""
        return "data:image/svg+xml;base64," + base64.b64encode(self.svg).decode()


@dataclass(frozen=True)
class Folded:
    """A table that the HTML page shows on request.

    Attributes:
        table: The table.
    """

    table: ResultTable


Block = str | tuple[str, ...] | FigureFile | ResultTable | Folded
"""A paragraph in Markdown, a list of them, a figure, or a table."""


@dataclass(frozen=True)
class PageSection:
    """A part of a page.

    Attributes:
        title: Heading; empty for none.
        blocks: Its content, in order.
        anchor: Target of the link from the page's table of contents; empty to leave the section out of it.
        link: Text of that link; the heading if empty.
    """

    title: str
    blocks: Sequence[Block]
    anchor: str = ""
    link: str = ""


@dataclass(frozen=True)
class Page:
    """The content of a page, independent of its format.

    Attributes:
        title: Heading of the page.
        lead: Opening lines, in Markdown.
        sections: Sections, in order.
        cautions: Sentences placed before all numbers, in Markdown.
        conditions: Worlds whose settings are listed at the end, by condition.
        runs: Runs whose manifests are summarized at the end.
    """

    title: str
    lead: str
    sections: Sequence[PageSection]
    cautions: Sequence[str] = ()
    conditions: Conditions = field(default_factory=dict)
    runs: Sequence[Run] = ()


class _Markdown(str):
    """Text that is already Markdown, so it is not escaped again."""


def html_page(page: Page) -> str:
    """A page as self-contained HTML."""
    return _render("page.html.j2", page)


def markdown_page(page: Page) -> str:
    """A page as Markdown that links to its figures as separate files."""
    return _render("page.md.j2", page)


def _render(template: str, page: Page) -> str:
    """Fills a template with a page; values are escaped unless marked as `verbatim` or `prose`."""
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
    environment.filters["verbatim"] = _Markdown
    environment.filters["prose"] = _inline_html if is_html else _prose
    environment.filters["text"] = _block_html if is_html else _prose
    environment.filters["minus"] = with_minus
    context = {
        "page": page,
        "sections": [{"of": section, "blocks": list(map(_block, section.blocks))} for section in page.sections],
        "conditions": [_condition(name, worlds) for name, worlds in page.conditions.items()],
        "runs": list(map(_run, page.runs)),
    }
    return environment.get_template(template).render(context)


_COMMONMARK = MarkdownIt("commonmark", {"html": False})
"""Renders Markdown; HTML within it stays text."""


_HYPHEN = re.compile(r"`[^`]*`|(?<![\w=.-])-(?=\.?\d)")
"""Code, or the hyphen of a negative number except in a setting such as "x=-1", which readers may copy."""


def with_minus(text: str) -> str:
    """The text with a minus sign, in place of a hyphen, before each negative number outside of code."""
    return _HYPHEN.sub(lambda found: "\N{MINUS SIGN}" if found[0] == "-" else found[0], text)


def _inline_html(text: str) -> Markup:
    return Markup(_COMMONMARK.renderInline(with_minus(text)))


def _block_html(text: str) -> Markup:
    return Markup(_COMMONMARK.render(with_minus(text)))


def _prose(text: str) -> _Markdown:
    return _Markdown(with_minus(text))


def _markdown(value: Any) -> str:
    return value if isinstance(value, _Markdown) else escape_markdown(str(value))


def _block(block: Block) -> tuple[str, Any]:
    """The kind of a block and the value that the template renders."""
    if isinstance(block, str):
        return "text", block
    if isinstance(block, tuple):
        return "list", block
    if isinstance(block, FigureFile):
        return "figure", block
    return ("folded", _table(block.table)) if isinstance(block, Folded) else ("table", _table(block))


def _table(table: ResultTable) -> Mapping[str, Any]:
    headers, rows = cells(table)
    shown = [[with_minus(cell) for cell in row] for row in rows]
    return {
        "title": table.title,
        "note": with_minus(table.note),
        "headers": headers,
        "rows": shown,
        "numeric": [is_numeric(rows, i) for i in range(len(headers))],
        "markdown": pipe_table(headers, shown),
    }


def describe_worlds(worlds: Sequence[WorldRecord]) -> str:
    """A paragraph on the worlds of one condition: how many there are, how long they are, and which died out."""
    seeds = ", ".join(str(world.seed) for world in worlds)
    extinct = [
        f"seed {world.seed} at step {world.extinct_step:,}" for world in worlds if world.extinct_step is not None
    ]
    return (
        f"{count(len(worlds), 'world')} (seed{'' if len(worlds) == 1 else 's'} {seeds}), up to "
        f"{max(world.last_step for world in worlds):,} steps, {sum(world.agents.height for world in worlds):,} agents. "
        + (f"Died out: {', '.join(extinct)}." if extinct else "No world died out.")
    )


def _condition(name: str, worlds: Sequence[WorldRecord]) -> dict[str, Any]:
    config = worlds[0].config
    return {
        "name": name,
        "worlds": describe_worlds(worlds),
        "preset": f"{config.preset} ({config.fidelity})",
        "changes": [
            (path, with_minus(_value(old)), with_minus(_value(new))) for path, old, new in changed_settings(config)
        ],
        "toml": dump_toml(config),
    }


def _run(run: Run) -> dict[str, Any]:
    return {
        "path": run.path.name,
        "status": run.manifest.status,
        "damaged": [str(path.relative_to(run.path)) for path in run.damaged_parts()],
        "manifest": json.dumps(plain(asdict(run.manifest)), indent=2, ensure_ascii=False),
    }


def versions(runs: Sequence[Run]) -> str:
    """The versions of hedon that made some runs."""
    return ", ".join(sorted({run.manifest.hedon_version or "unknown" for run in runs}))


def _value(value: Any) -> str:
    return "(absent)" if value is None else format_value(value)
