"""Builds the requested items of studies and writes them as figures, tables and one page that contains them all."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.topic.world import regime
from hedon.analysis.world.record import WorldRecord, by_condition
from hedon.error import failure
from hedon.figure.named import NamedFigure
from hedon.measure.world_measure import world_row
from hedon.record.folder import FIGURES
from hedon.report.answer import FACTORS, WORLDS, Answer, drawn_file, table_section, write_answer
from hedon.report.markdown import escape_markdown
from hedon.report.page import FigureFile, Folded, Page, PageSection, versions
from hedon.report.table import table_csv
from hedon.study.catalogue import StudyError
from hedon.study.gather import Gathered
from hedon.study.item import Item, ItemInputs
from hedon.study.study import Study
from hedon.study.verdict import FAILED, verdict_table, verdicts
from hedon.text import count

NAME = "study"
"""The stem of the page and of the JSON file."""
TABLES = "tables"
"""Folder of the tables, next to the page."""
NOTHING = "Nothing to show yet: no world is there."
CONDITION = "condition"
"""Column of the table of worlds that contains a condition's label."""


def write_studies(studies: Sequence[Study], gathered: Gathered, folder: Path) -> Path:
    """Builds every item of some studies and writes it to a folder, replacing existing files.

    If an item or the measure of a claim fails, as those from another package may, the page shows the error, and
    everything else is written.

    Returns:
        The path of the HTML page.

    Raises:
        RecordError: The folder cannot be written.
        StudyError: An item or a claim failed; everything else has been written.
    """
    inputs = {item.name: gathered.inputs(item) for study in studies for item in study.items}
    built_items = {item.name: _make(item, inputs[item.name], gathered) for study in studies for item in study.items}
    claims = [claim for study in studies for claim in study.claims]
    conditions = by_condition(gathered.demanded())
    judged = verdicts(gathered.demanded(), claims)
    overall = [table for table in (verdict_table(judged), *regime(conditions)) if not table.rows.is_empty()]
    tables = [
        *overall,
        *(table for built_item in built_items.values() for table in built_item.tables),
        _every_world(inputs),
    ]
    files = {f"{TABLES}/{table.name}.csv": table_csv(table) for table in tables}
    page = Page(
        " · ".join(study.title for study in studies),
        _lead(gathered),
        [
            *(table_section(table) for table in overall if table.shown),
            *(section for study in studies for section in _sections(study, built_items)),
        ],
        [f"Left out: {escape_markdown(fault)}" for fault in gathered.faults],
        conditions,
        gathered.runs,
    )
    write_answer(folder, Answer(NAME, page, _json(gathered, built_items.values()), tables, files))
    path = folder / f"{NAME}.html"
    failures = [f"{name}: {item.failure}" for name, item in built_items.items() if item.failure]
    failures += [f"{row.claim}: {row.reason}" for row in judged if row.reason.startswith(FAILED)]
    if failures:
        raise StudyError(f"{'; '.join(failures)} (everything else is in {path})")
    return path


@dataclass(frozen=True)
class BuiltItem:
    """An item of a study with its results.

    Attributes:
        item: The item.
        worlds: The worlds that it was built from, one row per condition.
        parts: Its figures and tables, in order; if it failed, those made before.
        failure: Why it failed; empty if it did not.
    """

    item: Item
    worlds: ResultTable | None
    parts: tuple[FigureFile | ResultTable, ...]
    failure: str = ""

    @property
    def tables(self) -> list[ResultTable]:
        """Its tables."""
        return [part for part in self.parts if isinstance(part, ResultTable)]

    def section(self) -> PageSection:
        """Its part of the page."""
        visible_parts = [
            part for part in self.parts if isinstance(part, FigureFile) or (part.shown and part.rows.height)
        ]
        folded = [] if self.worlds is None else [Folded(self.worlds)]
        failure = [f"Failed: {escape_markdown(self.failure)}"] if self.failure else []
        shown = visible_parts or ([] if failure else [NOTHING])
        return PageSection(self.item.title, [self.item.says, *failure, *shown, *folded], self.item.name, self.item.name)


def _lead(gathered: Gathered) -> str:
    version_note = f", from records of version {versions(gathered.runs)}" if gathered.runs else ""
    return (
        f"With fidelity {gathered.request.fidelity}, unless an item says otherwise{version_note}. Intervals are "
        "95 %, over worlds, and shown from five worlds on unless a table says otherwise."
    )


def _sections(study: Study, built_items: Mapping[str, BuiltItem]) -> list[PageSection]:
    expected = [f"Expected: {study.expectation}"] if study.expectation else []
    return [
        PageSection(study.title, [study.question, *expected]),
        *(built_items[item.name].section() for item in study.items),
    ]


def _make(item: Item, inputs: ItemInputs, gathered: Gathered) -> BuiltItem:
    parts = list[FigureFile | ResultTable]()
    reason = ""
    try:
        for part in item.make(inputs):
            parts.append(drawn_file(part, f"{FIGURES}/{part.name}.svg") if isinstance(part, NamedFigure) else part)
    except Exception as error:  # an item of another package may raise anything
        reason = failure(error)
    return BuiltItem(item, _worlds_table(item, inputs, gathered), tuple(parts), reason)


def _worlds_table(item: Item, inputs: ItemInputs, gathered: Gathered) -> ResultTable | None:
    """The worlds available for an item and those requested; None if it needs no world, or only a picture of one."""
    if not item.conditions or item.pictures:
        return None
    scale = gathered.request.scale(item)
    rows = [
        _worlds_row(condition.label, inputs.worlds.get(condition.label, ()), len(scale.seeds))
        for condition in item.conditions
    ]
    note = f"Asked for: {count(len(scale.seeds), 'world')} of {scale.steps:,} steps"
    note += f"; the study has {len(item.scale.seeds)} of {item.scale.steps:,}"
    return make_table(f"{item.name}-worlds", "Made of", rows, note + ".")


def _worlds_row(label: str, worlds: Sequence[WorldRecord], requested: int) -> Mapping[str, Any]:
    return {
        "setting": label,
        "worlds": f"{len(worlds)} of {requested}",
        "steps_of_the_shortest": min((w.last_step for w in worlds if w.extinct_step is None), default=None),
        "died_out": sum(world.extinct_step is not None for world in worlds),
        "agents": sum(world.agents.height for world in worlds),
    }


def _every_world(inputs: Mapping[str, ItemInputs]) -> ResultTable:
    """Every world of every condition, once, for `hedon compare` and `hedon power`.

    A label that stands for different worlds in different items is prefixed with the item's name.
    """
    worlds_by_label: dict[str, list[WorldRecord]] = {}
    for item, item_inputs in inputs.items():
        for label, worlds in item_inputs.worlds.items():
            is_same = _alike(worlds_by_label.get(label, worlds), worlds)
            worlds_by_label[label if is_same else f"{item}: {label}"] = list(worlds)
    rows = [
        {CONDITION: label, "steps": world.end_step, **world_row([world])}
        for label, worlds in worlds_by_label.items()
        for world in worlds
    ]
    return make_table(WORLDS, "Each world by itself", rows, shown=False)


def _alike(worlds: Sequence[WorldRecord], others: Sequence[WorldRecord]) -> bool:
    """Whether two items use the same worlds, cut at the same step."""
    return [(w.condition, w.seed, w.end_step) for w in worlds] == [(w.condition, w.seed, w.end_step) for w in others]


def _json(gathered: Gathered, built_items: Iterable[BuiltItem]) -> dict[str, Any]:
    request = gathered.request
    return {
        "fidelity": request.fidelity,
        "items": [
            {
                "name": built_item.item.name,
                "title": built_item.item.title,
                "asked": asdict(request.scale(built_item.item)),
                "scale": asdict(built_item.item.scale),
                "worlds": built_item.worlds.rows.to_dicts() if built_item.worlds is not None else [],
                "figures": [part.path for part in built_item.parts if isinstance(part, FigureFile)],
                "tables": [table.name for table in built_item.tables],
                "failure": built_item.failure,
            }
            for built_item in built_items
        ],
        "runs": [{"folder": run.path.name, "manifest": asdict(run.manifest)} for run in gathered.runs],
        "unreadable": list(gathered.faults),
        FACTORS: [CONDITION],
    }
