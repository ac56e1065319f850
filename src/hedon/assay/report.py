"""Writes what an assay found: a JSON summary, a page, a figure."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable
from hedon.assay.resample import Estimate
from hedon.assay.sample import Sample
from hedon.config.dump import digest
from hedon.figure.style import save_figure
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.report.markdown import pipe_table
from hedon.report.summary import plain
from hedon.report.table import cells


@dataclass(frozen=True, eq=False)
class Answer:
    """What an assay found, as it is printed and written.

    Attributes:
        kind: of the assay; names the files.
        samples: the worlds that it was read from.
        content: what the summary holds besides its head and the tables.
        tables: for the terminal, the summary and the page.
        intro: first lines of the page, in Markdown.
        figure: its picture.
        files: further files, by name.
    """

    kind: str
    samples: Sequence[Sample]
    content: Mapping[str, Any]
    tables: Sequence[ResultTable]
    intro: str
    figure: Figure
    files: Mapping[str, str] = field(default_factory=dict)


def write_assay(folder: Path, answer: Answer) -> list[Path]:
    """Writes the files of an assay over what is there, and returns their paths.

    Args:
        folder: of the assay.
        answer: what it found.

    Raises:
        RecordError: A file cannot be written.
    """
    kind, tables, config = answer.kind, answer.tables, answer.samples[0].need.config
    head = {
        "assay": kind,
        "condition": config.name,
        "fidelity": config.fidelity,
        "config_digest": digest(config),
        "runs": [
            {
                "folder": run.path.name,
                "config_digest": run.manifest.config_digest,
                "seeds": run.manifest.seeds,
                "steps": max(run.manifest.steps_done, default=0),
                "extinct_steps": run.manifest.extinct_steps,
                "world_digests": run.manifest.world_digests,
                "hedon_version": run.manifest.hedon_version,
            }
            for sample in answer.samples
            for run in sample.runs
        ],
    }
    shown = {each.name: {"title": each.title, "note": each.note, "rows": each.rows.to_dicts()} for each in tables}
    summary = json.dumps(
        plain({**head, **answer.content, "tables": shown}), indent=1, ensure_ascii=False, allow_nan=False
    )
    title = f"{kind.capitalize()}: {config.name} ({config.fidelity})"
    lines = [f"# {title}", "", answer.intro, "", f"![{title}]({kind}.png)", ""]
    for each in (table for table in tables if table.shown):
        lines += [f"## {each.title}", "", pipe_table(*cells(each)), "", *([each.note, ""] if each.note else [])]
    files = {f"{kind}.json": summary + "\n", f"{kind}.md": "\n".join(lines).rstrip() + "\n", **answer.files}
    with one_writer(folder, "the assay"):
        for name, text in files.items():
            write_atomically(folder / name, lambda file, text=text: file.write(text.encode()))
        return [*(folder / name for name in files), save_figure(answer.figure, folder / f"{kind}.png")]


def world_line(samples: Sequence[Sample]) -> str:
    """How many worlds there were, how long they lived, and which died out."""
    return " ".join(sample.describe() for sample in samples)


def estimate_row(labels: Mapping[str, Any], estimate: Estimate) -> dict[str, Any]:
    """A row with a value and its interval.

    Args:
        labels: the first columns.
        estimate: value, low and high.
    """
    return {**labels, "value": estimate.value, "low": estimate.low, "high": estimate.high}
