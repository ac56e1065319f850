"""Makes what was asked of some studies, and writes it: figures, tables, and one page that holds all of it."""

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.topic.world import regime
from hedon.analysis.world.record import WorldRecord, by_condition
from hedon.figure.named import NamedFigure
from hedon.measure.catalogue import world_row
from hedon.measure.summary import plain
from hedon.record.atomic import write_atomically
from hedon.record.folder import FIGURES
from hedon.record.lock import one_writer
from hedon.report.answer import FACTORS, WORLDS
from hedon.report.page import FigureFile, write_figure
from hedon.report.study_page import HTML, BuiltItem, study_pages
from hedon.study.gather import Gathered
from hedon.study.item import Item, ItemInputs
from hedon.study.study import Study
from hedon.study.verdict_table import verdict
from hedon.text import count

TABLES = "tables"
"""Folder of the tables beside the page."""
JSON = "study.json"
CONDITION = "condition"
"""The column of a condition's label in the table of worlds."""


def write_studies(studies: Sequence[Study], gathered: Gathered, folder: Path) -> tuple[Path, list[BuiltItem]]:
    """Makes every item of some studies and writes it into a folder, over what is there.

    Returns:
        The page in HTML, and the items.

    Raises:
        RecordError: the folder cannot be written.
    """
    with one_writer(folder, "the studies"):
        return folder / HTML, _write(studies, gathered, folder)


def _write(studies: Sequence[Study], gathered: Gathered, folder: Path) -> list[BuiltItem]:
    for name in (FIGURES, TABLES):
        (folder / name).mkdir(exist_ok=True)
    inputs = {item.name: gathered.inputs(item) for study in studies for item in study.items}
    made = [_make(item, inputs[item.name], gathered, folder) for study in studies for item in study.items]
    claims = [claim for study in studies for claim in study.claims]
    conditions = by_condition(gathered.demanded())
    overall = [found for found in (*verdict(conditions, claims), *regime(conditions)) if not found.rows.is_empty()]
    everything = [*overall, *(found for one in made for found in one.tables), _every_world(made, inputs)]
    for found in everything:
        buffer = io.BytesIO()
        found.rows.write_csv(buffer)
        _write_file(folder / TABLES / f"{found.name}.csv", buffer.getvalue())
    content = json.dumps(_json(gathered, made, everything), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    _write_file(folder / JSON, content.encode())
    for name, page in study_pages(studies, gathered, made, overall).items():
        _write_file(folder / name, page.encode())
    return made


def _write_file(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))


def _make(item: Item, inputs: ItemInputs, gathered: Gathered, folder: Path) -> BuiltItem:
    parts: list[FigureFile | ResultTable] = []
    for part in item.make(inputs):
        if isinstance(part, NamedFigure):
            parts.append(write_figure(folder, item.title, part, f"{FIGURES}/{part.name}.svg"))
        else:
            parts.append(part)
    return BuiltItem(item, _worlds_table(item, inputs, gathered), tuple(parts))


def _worlds_table(item: Item, inputs: ItemInputs, gathered: Gathered) -> ResultTable | None:
    """What an item was made of, beside what was wanted; None for one that needs no world, or only its picture."""
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


def _every_world(made: Sequence[BuiltItem], inputs: Mapping[str, ItemInputs]) -> ResultTable:
    """Every world of every condition once, for `hedon compare` and `hedon power`.

    A label that means one thing in one item and another thing in another item is preceded by the item's name.
    """
    found: dict[str, list[WorldRecord]] = {}
    for one in made:
        for label, worlds in inputs[one.item.name].worlds.items():
            same = _alike(found.get(label, worlds), worlds)
            found[label if same else f"{one.item.name}: {label}"] = list(worlds)
    rows = [
        {CONDITION: label, "steps": world.end_step, **world_row([world])}
        for label, worlds in found.items()
        for world in worlds
    ]
    return make_table(WORLDS, "Each world by itself", rows, shown=False)


def _alike(worlds: Sequence[WorldRecord], others: Sequence[WorldRecord]) -> bool:
    """Whether two items mean the same worlds, cut at the same step."""
    return [(w.condition, w.seed, w.end_step) for w in worlds] == [(w.condition, w.seed, w.end_step) for w in others]


def _json(gathered: Gathered, made: Sequence[BuiltItem], tables: Sequence[ResultTable]) -> dict[str, Any]:
    request = gathered.request
    return plain(
        {
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
            "tables": {
                found.name: {"title": found.title, "note": found.note, "rows": found.rows.to_dicts()}
                for found in tables
            },
        }
    )
