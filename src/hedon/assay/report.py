"""The parts of a report that all assays share."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.sample import Sample
from hedon.config.dump import digest
from hedon.figure.named import NamedFigure
from hedon.report.answer import WORLDS, Answer, simple_answer


def assay_answer(
    kind: str,
    samples: Sequence[Sample],
    content: Mapping[str, Any],
    tables: Sequence[ResultTable],
    intro: str,
    figure: NamedFigure,
    files: Mapping[str, str] | None = None,
) -> Answer:
    """The answer of an assay, with a description of its worlds.

    Args:
        kind: Kind of assay.
        samples: Its worlds.
        content: Contents of the JSON file besides the tables.
        tables: Tables of the results.
        intro: Opening sentence.
        figure: Figure of the results.
        files: Contents of further files, by path.
    """
    config = samples[0].demand.config
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
            for sample in samples
            for run in sample.runs
        ],
    }
    title = f"{kind.capitalize()}: {config.name} ({config.fidelity})"
    return simple_answer(kind, title, {**head, **content}, tables, intro, [figure], files)


def world_table(rows: Sequence[Mapping[str, Any]]) -> ResultTable:
    """A table of the results of each world, for `hedon compare` and `hedon power`."""
    return make_table(WORLDS, "Each world by itself", rows, shown=False)


def world_line(samples: Sequence[Sample]) -> str:
    """A sentence on how many worlds there were, how long they lived, and which died out."""
    return " ".join(sample.describe() for sample in samples)


def finite_row(row: Mapping[str, Any]) -> dict[str, Any]:
    """A copy of a row with None in place of non-finite numbers."""
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in row.items()
    }
