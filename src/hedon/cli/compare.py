"""`hedon compare`: compares two conditions."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console
from hedon.text import printable

if TYPE_CHECKING:
    from hedon.compare.source import WorldTable

Only = Annotated[
    str | None, typer.Option(metavar="COLUMN,…", help="Measures to compare, as columns; by default the usual ones.")
]
Between = Annotated[str | None, typer.Option(metavar="A,B", help="Two values of --by; needed if it has more than two.")]


def compare(
    source: Annotated[
        str, typer.Argument(metavar="SOURCE", help="A run, a folder of runs, a sweep, an assay, a study, or a table.")
    ],
    other: Annotated[str | None, typer.Argument(metavar="OTHER", help="A second source, to compare with.")] = None,
    by: Annotated[
        str | None, typer.Option(metavar="FACTOR", help="The factor that distinguishes the conditions within SOURCE.")
    ] = None,
    between: Between = None,
    only: Only = None,
    paired: Annotated[bool, typer.Option("--paired/--unpaired", help="Compare in pairs if seeds are equal.")] = True,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the answer; by default SOURCE/compare, or compare/SOURCE-OTHER for two sources."),
    ] = None,
) -> None:
    """Compare two conditions: how much they differ, how certain that is, and how likely by chance.

    Worlds are the units, in pairs if their seeds are equal. Prints at which step worlds are compared and which
    settings differ, then the difference of each measure with its interval, the effect size, and a permutation test
    that is corrected for the number of measures. Runs and sweeps can still be in progress. An earlier comparison of
    the same sources is replaced. docs/guide/compare.md explains it.

    \b
    Examples:
      hedon compare runs/cheap runs/costly
      hedon compare sweeps/cost --by energy.basic_cost --between 0.0005,0.002
      hedon compare studies/fear --between "prey,less food"
    """
    from hedon.cli.display.analysis import analysis_group
    from hedon.compare.contrast import compare_answer
    from hedon.report.answer import write_answer

    worlds = read_sources(source, other)
    folder = out or _folder(source, other)
    _require_same_sources(folder, worlds.name)
    found = compare_answer(worlds, by, between, columns(only), paired=paired)
    files = write_answer(folder, found)
    console = make_console()
    for line in found.lines:
        console.print(printable(line), soft_wrap=True)
    console.print()
    console.print(analysis_group({table.name: table for table in found.tables}))
    console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)


def read_sources(source: str, other: str | None) -> "WorldTable":
    """Worlds of one source, or of two with the factor "source". A slash at the end of a folder's name is ignored."""
    from hedon.compare.source import read_both, read_table

    source = source.rstrip("/") or source
    return read_table(source) if other is None else read_both((source, other.rstrip("/") or other))


def columns(text: str | None) -> list[str]:
    """Splits a text at its commas; empty for None."""
    return [name.strip() for name in text.split(",")] if text else []


def _folder(source: str, other: str | None) -> Path:
    """Default output folder: in a single source; for two, a file or a URL, one named after them in `compare`."""
    folder = Path(source)
    if other is None and "://" not in source and folder.is_dir():
        return folder / "compare"
    return Path("compare") / "-".join(map(_name, filter(None, (source, other))))


def _name(source: str) -> str:
    """The last part of a source's path or URL, without the suffix of a file."""
    path = Path(source).absolute()
    return path.stem if path.is_file() else path.name


def _require_same_sources(folder: Path, source: str) -> None:
    """Refuses a folder with a comparison of other sources; one of the same sources is replaced."""
    from hedon.compare.error import CompareError

    try:
        earlier = json.loads((folder / "compare.json").read_text(encoding="utf-8"))["source"]
    except (OSError, ValueError, KeyError, TypeError):
        return
    if earlier != source:
        raise CompareError(
            f"{folder} already holds a comparison of {earlier}: choose another folder with --out, or remove it first"
        )
