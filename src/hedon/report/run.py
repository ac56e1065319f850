"""Writes the report of some runs from their folders alone; it can be repeated at any time.

Each run gets its own `summary.json`. All runs together get figures, `analysis.json` with a CSV file per table, and one
page with both: `report.html`, which is self-contained, and `report.md`.
"""

import json
import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, count
from pathlib import Path
from typing import Any

from hedon.analysis.world.future import shared_pasts
from hedon.analysis.world.record import Conditions
from hedon.config.color import food_colors
from hedon.demography.forecast import setting_warnings
from hedon.error import ArgumentError
from hedon.figure.named import NamedFigure
from hedon.figure.style import FORMATS
from hedon.figure.world import draw_world, telling_agent
from hedon.measure.summary import plain, summarize
from hedon.record.atomic import write_atomically
from hedon.record.error import RecordError
from hedon.record.folder import FIGURES, SUMMARY
from hedon.record.lock import one_writer
from hedon.record.reader import Run
from hedon.record.snapshot import Snapshot, load_snapshot
from hedon.report.analysis import ANALYSIS, Analysis, analyze, write_analysis
from hedon.report.answer import Answer, drawn_file, replace_files
from hedon.report.condition import condition_figures
from hedon.report.figure import WORLD
from hedon.report.markdown import escape_markdown
from hedon.report.page import FigureFile, Page, PageSection, describe_worlds, versions
from hedon.report.topic import TOPICS, Tell, tell_nobody
from hedon.report.watch import how_to_watch
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.study.catalogue import reported_figures
from hedon.text import brief

EXPLANATION = (
    "Agents inherit the weights of their reward, with mutations, and learn what pays. Weights also change by chance: "
    "neutral genes, which are inherited alike and affect nothing, show how far."
)
NO_FIGURES = "none"
SETTING = "What the setting itself says, before any run:"


def write_report(
    *runs: Run, folder: Path | str | None = None, figures: str = "svg", tell: Tell = tell_nobody
) -> list[Path]:
    """Writes the report of some runs, replacing an earlier report in the same folder.

    If another process is writing a report to the same folder, this one waits. Damaged parts are left out and listed in
    the summary. The picture of a world requires `final.npz`.

    Args:
        runs: One run or more.
        folder: Where to write everything but the summaries; by default the folder of the run, or `report` for several.
        figures: Format of the figures: "svg", which the page always contains, or "pdf" or "png" in addition; "none" for
            no figures, which take most of the time.
        tell: Progress callback, called before each step.

    Returns:
        The paths of the files written: a `summary.json` per run, `report.html`, `report.md`, `analysis.json` (with its
        CSV files), `figures/*.svg`.

    Raises:
        ArgumentError: The format is unknown.
        RecordError: A folder cannot be written, or a `final.npz` is damaged; in the latter case all other files exist.
    """
    if figures not in (formats := (*FORMATS, NO_FIGURES)):
        raise ArgumentError(f"figures = {brief(repr(figures))}: must be one of {', '.join(formats)}")
    folder = Path(folder or (runs[0].path if len(runs) == 1 else "report"))
    faults: list[RecordError] = []
    with one_writer(folder, "the report"):
        # All figures together count as many steps as the topics.
        analysis = analyze(runs, tell=lambda done, total, step: tell(done, 2 * total, step))
        tell(len(TOPICS), 2 * len(TOPICS), "writing" if figures == NO_FIGURES else "drawing and writing")
        summaries = [_write_summary(run) for run in analysis.runs]
        figure_files: dict[str, list[FigureFile]] = {}
        for condition, named_figure in () if figures == NO_FIGURES else _figures(analysis, faults):
            used_paths = {figure.path for group in figure_files.values() for figure in group}
            figure_files.setdefault(condition, []).append(_as_file(named_figure, used_paths, figures))
        answers = write_analysis(analysis, folder / ANALYSIS)[0]
        pages = replace_files(folder, Answer("report", report_page(analysis, figure_files)))
    if faults:
        raise faults[0]
    return [*summaries, *pages[:2], answers, *pages[2:]]


def report_page(analysis: Analysis, figures: Mapping[str, Sequence[FigureFile]]) -> Page:
    """The report of some runs.

    Args:
        analysis: The results to show.
        figures: The figures of each condition; the first shows what evolved.
    """
    visible_tables = {name: table for name, table in analysis.tables.items() if table.shown}
    verdict = [visible_tables.pop("verdict")] if "verdict" in visible_tables else []
    evolution_sections, detail_sections = [], []
    for number, (name, worlds) in enumerate(analysis.conditions.items(), start=1):
        figure_files = figures.get(name, ())
        warnings = _lines(setting_warnings(worlds[0].config, worlds[0].species))
        setting_list = [SETTING, warnings] if warnings else []
        evolution_sections.append(
            PageSection(f"{name}: what evolved?", [_lines(analysis.answers.get(name, ())), *figure_files[:1]])
        )
        detail_sections.append(
            PageSection(name, [describe_worlds(worlds), *setting_list, *figure_files[1:]], f"condition-{number}")
        )
    return Page(
        " · ".join(analysis.conditions),
        f"Made by hedon from records of version {versions(analysis.runs)}. Intervals are 95 %, over worlds, and shown "
        f"from five worlds on.\n\n{EXPLANATION}",
        [
            *evolution_sections,
            *(PageSection(table.title, [table], "verdicts", "Verdicts") for table in verdict),
            *detail_sections,
            PageSection("Tables", list(visible_tables.values()), "tables"),
        ],
        _lines([*analysis.unfinished, *shared_pasts(analysis.runs), *narrow_intervals(analysis.conditions)]),
        analysis.conditions,
        analysis.runs,
    )


def narrow_intervals(conditions: Conditions) -> list[str]:
    """A caution for each condition in which some worlds died out, where t intervals are too narrow."""
    cautions = []
    for name, worlds in conditions.items():
        extinct_count = sum(world.extinct_step is not None for world in worlds)
        if 0 < extinct_count < len(worlds) and len(worlds) >= FOR_INTERVAL:
            cautions.append(
                f"{extinct_count} of {len(worlds)} worlds of {name} died out, so intervals of its numbers alive are "
                "too narrow: with one world in five at 0 they miss the mean in 24 % of cases with five worlds, "
                "in 11 % with ten."
            )
    return cautions


def _lines(sentences: Iterable[str]) -> tuple[str, ...]:
    """Sentences, escaped for Markdown."""
    return tuple(map(escape_markdown, sentences))


def run_summary(run: Run) -> dict[str, Any]:
    """The content of `summary.json`: the numbers of a run, and those published for its preset in a study's source."""
    manifest = run.manifest
    reported = reported_figures(manifest.preset) if manifest.modified is False else {}
    return summarize(run) | {"reported": plain(reported)}


def _write_summary(run: Run) -> Path:
    text = json.dumps(run_summary(run), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    write_atomically(run.path / SUMMARY, lambda file: file.write(text.encode()))
    return run.path / SUMMARY


def _figures(analysis: Analysis, faults: list[RecordError]) -> Iterator[tuple[str, NamedFigure]]:
    """Every figure with its condition: first what evolved, then what the worlds look like, then the rest."""
    several = len(analysis.conditions) > 1
    snapshots = list(_snapshots(analysis, faults))
    for condition, records in analysis.conditions.items():
        figures = condition_figures(records, analysis.tables)  # drawn one at a time
        yield condition, _with_prefix(condition, next(figures), several=several)
        for run, snapshot in (entry[1:] for entry in snapshots if entry[0] == condition):
            yield condition, _with_prefix(run.path.name, _world(run, snapshot), several=len(analysis.runs) > 1)
        for named_figure in figures:
            yield condition, _with_prefix(condition, named_figure, several=several)


def _snapshots(analysis: Analysis, faults: list[RecordError]) -> Iterator[tuple[str, Run, Snapshot]]:
    """The last state of one world of each run, with the run's condition; damaged states are noted and left out."""
    for run in analysis.runs:
        condition = _condition_of(run, analysis)
        try:
            snapshot = load_snapshot(run.path)
        except RecordError as fault:
            faults.append(fault)
            continue
        if snapshot is not None and condition is not None:
            yield condition, run, snapshot


def _world(run: Run, snapshot: Snapshot) -> NamedFigure:
    focus = telling_agent(snapshot)
    colors = food_colors(snapshot.food_kinds, run.manifest.food_colors)
    named = WORLD.drawn(draw_world(snapshot, colors, [] if focus is None else [focus]))
    if not run.manifest.frames:
        return named
    return replace(named, caption=f"{named.caption} {how_to_watch(run, snapshot.seed)}")


def _condition_of(run: Run, analysis: Analysis) -> str | None:
    """The condition that a run's worlds belong to; None if all of them are taken from another run."""
    matching = (c for c, worlds in analysis.conditions.items() for world in worlds if world.run == run.path.name)
    return next(matching, None)


def _with_prefix(prefix: str, named_figure: NamedFigure, *, several: bool) -> NamedFigure:
    """Makes the name unique if the report has several figures of this kind."""
    slug = re.sub(r"[^a-z0-9]+", "-", prefix.lower()).strip("-")
    return replace(named_figure, name=f"{slug}-{named_figure.name}") if several else named_figure


def _as_file(named_figure: NamedFigure, used_paths: Container[str], form: str) -> FigureFile:
    """A figure as a file; a number is added if its name is taken, since prefixes may differ only in punctuation."""
    names = (f"{FIGURES}/{named_figure.name}{end}.svg" for end in chain([""], (f"-{i}" for i in count(2))))
    return drawn_file(named_figure, next(name for name in names if name not in used_paths), form)
