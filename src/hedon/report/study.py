"""Makes what was asked of a reproduction, and writes it: figures, tables, and one page that holds all of it."""

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from hedon.analysis.table import ResultTable, table
from hedon.analysis.topic.world import regime
from hedon.analysis.world.record import WorldRecord, by_condition
from hedon.figure.named import NamedFigure
from hedon.figure.style import save_figure, svg_bytes
from hedon.record.atomic import write_atomically
from hedon.record.error import RecordError
from hedon.record.folder import FIGURES
from hedon.record.lock import one_writer
from hedon.report.page import FigureFile
from hedon.report.study_page import Made, html_page, markdown_page
from hedon.report.summary import plain
from hedon.study.gather import Gathered
from hedon.study.item import Item, Material
from hedon.study.verdict_table import verdict

TABLES = "tables"
"""Folder of the tables within that of a reproduction."""
HTML, MARKDOWN, JSON = "reproduction.html", "reproduction.md", "reproduction.json"


def write_items(gathered: Gathered, folder: Path) -> tuple[Path, list[Made]]:
    """Makes every item of a request and writes it into a folder, over what is there.

    Args:
        gathered: The worlds of a request, by item.
        folder: Is made if it is missing.

    Returns:
        The page in HTML, and the items.

    Raises:
        RecordError: the folder cannot be written.
    """
    try:
        with one_writer(folder):
            made = _write_items(gathered, folder)
    except OSError as error:
        raise RecordError(f"cannot write the reproduction into {folder}: {error}") from error
    return folder / HTML, made


def _write_items(gathered: Gathered, folder: Path) -> list[Made]:
    for name in (FIGURES, TABLES):
        (folder / name).mkdir(exist_ok=True)
    made = [_make(item, gathered, folder) for item in gathered.request.items]
    conditions = by_condition(gathered.demanded())
    overall = [found for found in (*verdict(conditions), *regime(conditions)) if not found.rows.is_empty()]
    everything = [*overall, *(found for one in made for found in one.tables)]
    for found in everything:
        buffer = io.BytesIO()
        found.rows.write_csv(buffer)
        _write(folder / TABLES / f"{found.name}.csv", buffer.getvalue())
    content = json.dumps(_json(gathered, made, everything), indent=1, ensure_ascii=False, allow_nan=False) + "\n"
    _write(folder / JSON, content.encode())
    _write(folder / MARKDOWN, markdown_page(gathered, made, overall).encode())
    _write(folder / HTML, html_page(gathered, made, overall).encode())
    return made


def _write(path: Path, content: bytes) -> None:
    write_atomically(path, lambda file: file.write(content))


def _make(item: Item, gathered: Gathered, folder: Path) -> Made:
    material = gathered.material(item)
    parts: list[FigureFile | ResultTable] = []
    for part in item.make(material):
        if isinstance(part, NamedFigure):
            path = save_figure(part.figure, folder / FIGURES / f"{part.name}.png").relative_to(folder)
            parts.append(FigureFile(item.title, part.question, path.as_posix(), svg_bytes(part.figure), part.caption))
        else:
            parts.append(part)
    return Made(item, _worlds_table(item, material, gathered), tuple(parts))


def _worlds_table(item: Item, material: Material, gathered: Gathered) -> ResultTable | None:
    """What an item was made of, beside what was asked for; None for one that needs no world, or only its picture."""
    if not item.arms or item.pictures:
        return None
    scale = gathered.request.scale(item)
    rows = [_worlds_row(arm.label, material.worlds.get(arm.label, ()), len(scale.seeds)) for arm in item.arms]
    count = len(scale.seeds)
    note = f"Asked for: {count} world{'s' if count > 1 else ''} of {scale.steps:,} steps"
    if item.kind in ("figure", "table"):
        note += f"; the paper has {len(item.scale.seeds)} of {item.scale.steps:,}"
    return table(f"{item.name}-worlds", "Made of", rows, note + ".")


def _worlds_row(label: str, worlds: Sequence[WorldRecord], asked: int) -> Mapping[str, Any]:
    return {
        "setting": label,
        "worlds": f"{len(worlds)} of {asked}",
        "steps_of_the_shortest": min((w.last_step for w in worlds if w.extinct_step is None), default=None),
        "died_out": sum(world.extinct_step is not None for world in worlds),
        "agents": sum(world.agents.height for world in worlds),
    }


def _json(gathered: Gathered, made: Sequence[Made], tables: Sequence[ResultTable]) -> dict[str, Any]:
    request = gathered.request
    return plain(
        {
            "fidelity": request.fidelity,
            "items": [
                {
                    "name": one.item.name,
                    "title": one.item.title,
                    "kind": one.item.kind,
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
            "tables": {
                found.name: {"title": found.title, "note": found.note, "rows": found.rows.to_dicts()}
                for found in tables
            },
        }
    )
