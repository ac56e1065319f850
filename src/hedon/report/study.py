"""Builds the requested items of studies and writes them as figures, tables and one page that contains them all."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.topic.world import regime
from hedon.analysis.world.record import WorldRecord, by_condition
from hedon.figure.named import NamedFigure
from hedon.measure.world_measure import world_row
from hedon.record.folder import FIGURES
from hedon.report.answer import FACTORS, WORLDS, Answer, drawn_file, table_section, write_answer
from hedon.report.markdown import escape_markdown
from hedon.report.page import FigureFile, Folded, Page, PageSection, versions
from hedon.report.table import table_csv
from hedon.study.gather import Gathered
from hedon.study.item import Item, ItemInputs
from hedon.study.study import Study
from hedon.study.verdict_table import verdict
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

    Returns:
        The path of the HTML page.

    Raises:
        RecordError: The folder cannot be written.
    """
    inputs = {item.name: gathered.inputs(item) for study in studies for item in study.items}
    made = {item.name: _make(item, inputs[item.name], gathered) for study in studies for item in study.items}
    claims = [claim for study in studies for claim in study.claims]
    conditions = by_condition(gathered.demanded())
    overall = [found for found in (*verdict(conditions, claims), *regime(conditions)) if not found.rows.is_empty()]
    tables = [*overall, *(found for one in made.values() for found in one.tables), _every_world(inputs)]
    files = {f"{TABLES}/{found.name}.csv": table_csv(found) for found in tables}
    page = Page(
        " · ".join(study.title for study in studies),
        _lead(gathered),
        [
            *(table_section(found) for found in overall if found.shown),
            *(section for study in studies for section in _sections(study, made)),
        ],
        [f"Left out: {escape_markdown(fault)}" for fault in gathered.faults],
        conditions,
        gathered.runs,
    )
    write_answer(folder, Answer(NAME, page, _json(gathered, made.values()), tables, files))
    return folder / f"{NAME}.html"


@dataclass(frozen=True)
class BuiltItem:
    """An item of a study with its results.

    Attributes:
        item: The item.
        worlds: The worlds that it was built from, one row per condition.
        parts: Its figures and tables, in order.
    """

    item: Item
    worlds: ResultTable | None
    parts: tuple[FigureFile | ResultTable, ...]

    @property
    def tables(self) -> list[ResultTable]:
        """Its tables."""
        return [part for part in self.parts if isinstance(part, ResultTable)]

    def section(self) -> PageSection:
        """Its part of the page."""
        shown = [part for part in self.parts if isinstance(part, FigureFile) or (part.shown and part.rows.height)]
        folded = [] if self.worlds is None else [Folded(self.worlds)]
        return PageSection(
            self.item.title, [self.item.says, *(shown or [NOTHING]), *folded], self.item.name, self.item.name
        )


def _lead(gathered: Gathered) -> str:
    made = f", from records of version {versions(gathered.runs)}" if gathered.runs else ""
    return (
        f"With fidelity {gathered.request.fidelity}, unless an item says otherwise{made}. Intervals are 95 %, over "
        "worlds, and shown from five worlds on unless a table says otherwise."
    )


def _sections(study: Study, made: Mapping[str, BuiltItem]) -> list[PageSection]:
    expected = [f"Expected: {study.expectation}"] if study.expectation else []
    return [PageSection(study.title, [study.question, *expected]), *(made[item.name].section() for item in study.items)]


def _make(item: Item, inputs: ItemInputs, gathered: Gathered) -> BuiltItem:
    parts = (
        drawn_file(part, f"{FIGURES}/{part.name}.svg") if isinstance(part, NamedFigure) else part
        for part in item.make(inputs)
    )
    return BuiltItem(item, _worlds_table(item, inputs, gathered), tuple(parts))


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


def _worlds_row(label: str, worlds: Sequence[WorldRecord], asked: int) -> Mapping[str, Any]:
    return {
        "setting": label,
        "worlds": f"{len(worlds)} of {asked}",
        "steps_of_the_shortest": min((w.last_step for w in worlds if w.extinct_step is None), default=None),
        "died_out": sum(world.extinct_step is not None for world in worlds),
        "agents": sum(world.agents.height for world in worlds),
    }


def _every_world(inputs: Mapping[str, ItemInputs]) -> ResultTable:
    """Every world of every condition, once, for `hedon compare` and `hedon power`.

    A label that stands for different worlds in different items is prefixed with the item's name.
    """
    found: dict[str, list[WorldRecord]] = {}
    for item, own in inputs.items():
        for label, worlds in own.worlds.items():
            same = _alike(found.get(label, worlds), worlds)
            found[label if same else f"{item}: {label}"] = list(worlds)
    rows = [
        {CONDITION: label, "steps": world.end_step, **world_row([world])}
        for label, worlds in found.items()
        for world in worlds
    ]
    return make_table(WORLDS, "Each world by itself", rows, shown=False)


def _alike(worlds: Sequence[WorldRecord], others: Sequence[WorldRecord]) -> bool:
    """Whether two items use the same worlds, cut at the same step."""
    return [(w.condition, w.seed, w.end_step) for w in worlds] == [(w.condition, w.seed, w.end_step) for w in others]


def _json(gathered: Gathered, made: Iterable[BuiltItem]) -> dict[str, Any]:
    request = gathered.request
    return {
        "fidelity": request.fidelity,
        "items": [
            {
                "name": one.item.name,
                "title": one.item.title,
                "asked": asdict(request.scale(one.item)),
                "scale": asdict(one.item.scale),
                "worlds": one.worlds.rows.to_dicts() if one.worlds is not None else [],
                "figures": [part.path for part in one.parts if isinstance(part, FigureFile)],
                "tables": [found.name for found in one.tables],
            }
            for one in made
        ],
        "runs": [{"folder": run.path.name, "manifest": asdict(run.manifest)} for run in gathered.runs],
        "unreadable": list(gathered.faults),
        FACTORS: [CONDITION],
    }
