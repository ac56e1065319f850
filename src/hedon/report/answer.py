"""Results ready to be written: one page as HTML and Markdown, a JSON file, and separate tables and figures."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from hedon.analysis.result import ResultTable
from hedon.figure.named import NamedFigure
from hedon.figure.style import FORMATS, svg_bytes
from hedon.measure.summary import plain
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.report.earlier import earlier_names
from hedon.report.page import FigureFile, Page, PageSection, html_page, markdown_page
from hedon.report.table import table_json

WORLDS, FACTORS, CAUTIONS = "world", "factors", "cautions"
"""In the JSON of an assay or a study: its table with a row per world, the columns that distinguish conditions, and
sentences about worlds that are not independent."""


@dataclass(frozen=True, eq=False)
class Answer:
    """Results about some worlds, as they are printed and written.

    Attributes:
        name: Stem of the names of its files.
        page: The page that is written as HTML and Markdown.
        content: Contents of the JSON file besides the tables; None to write no JSON file.
        tables: Tables for the JSON file and the terminal.
        files: Contents of further files, by path.
        lines: Lines before the tables on the terminal.
    """

    name: str
    page: Page
    content: Mapping[str, Any] | None = None
    tables: Sequence[ResultTable] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    lines: Sequence[str] = ()


def simple_answer(
    name: str,
    title: str,
    content: Mapping[str, Any],
    tables: Sequence[ResultTable],
    lead: str,
    figures: Sequence[NamedFigure],
    files: Mapping[str, str] | None = None,
) -> Answer:
    """The answer to one question: its figures, then a section for each visible table."""
    figure_files = [drawn_file(figure) for figure in figures]
    page = Page(
        title, lead, [PageSection("", figure_files), *(table_section(table) for table in tables if table.shown)]
    )
    return Answer(name, page, content, tables, files or {})


def table_section(table: ResultTable) -> PageSection:
    """A section that contains one table."""
    return PageSection(table.title, [table], table.name)


def drawn_file(named: NamedFigure, path: str = "", form: str = "svg") -> FigureFile:
    """A figure as an SVG file, at `path` or named after the figure, and also in the format `form`."""
    path, svg = path or f"{named.name}.svg", svg_bytes(named.figure)
    other_formats = {} if form == "svg" else {f"{path.removesuffix('svg')}{form}": FORMATS[form](named.figure)}
    return FigureFile(named.question, path, svg, named.caption, other_formats)


def write_answer(folder: Path, answer: Answer) -> list[Path]:
    """Writes the files of an answer, replacing those of an earlier one, and returns their paths, figures last.

    Raises:
        RecordError: A file cannot be written.
    """
    with one_writer(folder, "the report"):
        return replace_files(folder, answer)


def replace_files(folder: Path, answer: Answer) -> list[Path]:
    """Does the work of `write_answer`; no other process may be writing to the folder."""
    name, page = answer.name, answer.page
    blocks = [block for section in page.sections for block in section.blocks]
    figure_files = [block for block in blocks if isinstance(block, FigureFile)]
    figures = {block.path: block.svg for block in figure_files}
    files: dict[str, str | bytes] = {f"{name}.html": html_page(page), f"{name}.md": markdown_page(page), **answer.files}
    stale: set[str] = set()
    if answer.content is not None:
        summary = folder / f"{name}.json"
        figure_paths = {Path(path).stem: path for path in figures}
        table_contents = {each.name: table_json(each) for each in answer.tables}
        content = {**answer.content, "figures": list(figure_paths), "tables": table_contents}
        text = json.dumps(plain(content), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
        files = {summary.name: text, **files}
        stale = earlier_names(summary, "figures") - figure_paths.keys()
    subfolders = {str(Path(path).parent) for path in figures} or {"."}
    for each in (folder / subfolder / f"{stem}.svg" for subfolder in subfolders for stem in stale):
        each.unlink(missing_ok=True)
    figures |= {path: content for block in figure_files for path, content in block.others.items()}
    for path, text in {**files, **figures}.items():
        data = text.encode() if isinstance(text, str) else text
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        write_atomically(folder / path, lambda file, data=data: file.write(data))
    return [folder / path for path in (*files, *figures)]
