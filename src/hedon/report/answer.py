"""Writes what one question found: a JSON summary, a page, figures."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable
from hedon.figure.style import save_figure
from hedon.measure.summary import plain
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.report.earlier import earlier_names
from hedon.report.markdown import pipe_table
from hedon.report.table import cells

WORLDS, FACTORS = "world", "factors"
"""In the JSON of an assay or a study: its table with a row per world, and the columns that distinguish conditions."""


@dataclass(frozen=True, eq=False)
class Answer:
    """What one question found, as it is printed and written.

    Attributes:
        name: The stem of its files.
        title: Of the page.
        content: What the summary contains besides the tables.
        tables: For the terminal, the summary and the page.
        intro: First lines of the page, in Markdown.
        figures: By the stems of their files.
        files: Further files, by name.
    """

    name: str
    title: str
    content: Mapping[str, Any]
    tables: Sequence[ResultTable]
    intro: str
    figures: Mapping[str, Figure]
    files: Mapping[str, str] = field(default_factory=dict)


def write_answer(folder: Path, answer: Answer) -> list[Path]:
    """Writes the files of an answer, replacing an earlier one, and returns their paths, figures last.

    Raises:
        RecordError: A file cannot be written.
    """
    name, tables = answer.name, answer.tables
    shown = {each.name: {"title": each.title, "note": each.note, "rows": each.rows.to_dicts()} for each in tables}
    content = {**answer.content, "figures": list(answer.figures), "tables": shown}
    summary = json.dumps(plain(content), indent=1, ensure_ascii=False, allow_nan=False)
    lines = [f"# {answer.title}", "", answer.intro, ""]
    lines += [line for stem in answer.figures for line in (f"![{answer.title}: {stem}]({stem}.svg)", "")]
    for each in (table for table in tables if table.shown):
        lines += [f"## {each.title}", "", pipe_table(*cells(each)), "", *([each.note, ""] if each.note else [])]
    files = {f"{name}.json": summary + "\n", f"{name}.md": "\n".join(lines).rstrip() + "\n", **answer.files}
    with one_writer(folder, "the answer"):
        for stale in earlier_names(folder / f"{name}.json", "figures") - answer.figures.keys():
            (folder / f"{stale}.svg").unlink(missing_ok=True)
        for each, text in files.items():
            write_atomically(folder / each, lambda file, text=text: file.write(text.encode()))
        drawn = [save_figure(figure, folder / f"{stem}.svg") for stem, figure in answer.figures.items()]
        return [*(folder / each for each in files), *drawn]
