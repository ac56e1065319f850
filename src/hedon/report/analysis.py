"""Computes all topics for some runs and writes the results: `analysis.json` and one CSV file per table."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from hedon.analysis.result import ResultTable
from hedon.analysis.world.record import WorldRecord, by_condition, read_worlds
from hedon.error import ArgumentError
from hedon.measure.summary import plain
from hedon.record.atomic import write_atomically
from hedon.record.lock import one_writer
from hedon.record.reader import Run
from hedon.report.earlier import earlier_names
from hedon.report.moment import unfinished
from hedon.report.table import table_csv, table_json
from hedon.report.topic import TOPICS, Tell, require_topics, run_topics, tell_nobody
from hedon.report.words import answers
from hedon.text import brief

ANALYSIS = "analysis"
"""Folder of the results within the folder of a single run."""
_JSON = "analysis.json"


@dataclass(frozen=True)
class Analysis:
    """The analysis of some runs.

    Attributes:
        runs: The runs, as they were read.
        conditions: Their worlds, by condition.
        tables: The tables by name, in the order of the topics.
        answers: Conclusions in words, by condition; empty without the topic drift.
        unfinished: For each unfinished run, a sentence on which steps its numbers cover.
    """

    runs: tuple[Run, ...]
    conditions: Mapping[str, Sequence[WorldRecord]]
    tables: Mapping[str, ResultTable]
    answers: Mapping[str, Sequence[str]]
    unfinished: Sequence[str] = ()


def analyze(runs: Sequence[Run], topics: Sequence[str] = tuple(TOPICS), tell: Tell = tell_nobody) -> Analysis:
    """Computes some topics for all runs together; runs with equal configs form one condition.

    Args:
        runs: Runs of one or more conditions.
        topics: Keys of `TOPICS`, in the order in which their tables are wanted.
        tell: Progress callback, called before each step.

    Raises:
        RecordError, ConfigError: A run cannot be read.
        TopicError: A topic is unknown.
        ArgumentError: `runs` contains something other than the runs that `open_run` returns.
    """
    require_topics(topics)
    if not isinstance(runs, Iterable) or not all(isinstance(run, Run) for run in runs):
        raise ArgumentError(f"runs: must be a list of runs, as open_run gives them, not {brief(repr(runs))}")
    tell(0, len(topics), "reading the records")
    runs = [run.load() for run in runs]
    conditions = by_condition(read_worlds(runs))
    several = len(conditions) > 1
    tables = {table.name: replace(table, several=several) for table in run_topics(conditions, topics, tell)}
    answer_lines = answers(conditions, tables, runs) if "drift" in topics else {}
    return Analysis(tuple(runs), conditions, tables, answer_lines, unfinished(runs, conditions))


def write_analysis(analysis: Analysis, folder: Path) -> list[Path]:
    """Writes `analysis.json` and one CSV file per table to a folder, replacing those of an earlier analysis.

    Tables of an earlier analysis that this one lacks are removed, since they may come from other records.

    Returns:
        The paths of the files written.

    Raises:
        RecordError: The folder cannot be written.
    """
    # Not indented: the file contains every number, and indenting takes ten times as long.
    text = json.dumps(_analysis_json(analysis), ensure_ascii=False, allow_nan=False) + "\n"
    contents = {_JSON: text.encode()}
    for name, table in analysis.tables.items():
        contents[f"{name}.csv"] = table_csv(table).encode()
    with one_writer(folder, "the analysis"):
        for name in earlier_names(folder / _JSON, "tables") - analysis.tables.keys():
            (folder / f"{name}.csv").unlink(missing_ok=True)
        for name, content in contents.items():
            write_atomically(folder / name, lambda file, content=content: file.write(content))
    return [folder / name for name in contents]


def _analysis_json(analysis: Analysis) -> dict[str, Any]:
    """The content of `analysis.json`: runs with their manifests, worlds, conclusions, and tables with their rows."""
    worlds = [
        {
            "condition": world.condition,
            "run": world.run,
            "seed": world.seed,
            "last_step": world.last_step,
            "extinct_step": world.extinct_step,
            "agents": world.agents.height,
        }
        for group in analysis.conditions.values()
        for world in group
    ]
    return plain(
        {
            "runs": [{"path": str(run.path), "manifest": asdict(run.manifest)} for run in analysis.runs],
            "unfinished": analysis.unfinished,
            "worlds": worlds,
            "answers": analysis.answers,
            "tables": {name: table_json(table) for name, table in analysis.tables.items()},
        }
    )
