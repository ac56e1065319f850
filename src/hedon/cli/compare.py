"""`hedon compare`: compares two conditions."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from hedon.cli.console import make_console

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
        Path | None, typer.Option(help="Folder of the answer; by default SOURCE/compare, or compare for two sources.")
    ] = None,
) -> None:
    """Compare two conditions: how much they differ, how certain that is, and how likely by chance.

    Worlds are the units, in pairs if their seeds are equal. Prints the difference of each measure with its interval,
    the effect size, and a permutation test that is corrected for the number of measures. Runs are compared at their
    common length; a sweep can still be running. docs/guide/compare.md explains it.

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
    found = compare_answer(worlds, by, between, columns(only), paired=paired)
    files = write_answer(out or _folder(source, other), found)
    console = make_console()
    console.print(analysis_group({table.name: table for table in found.tables}))
    console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)


def read_sources(source: str, other: str | None) -> "WorldTable":
    """Worlds of one source, or of two with the factor "source"."""
    from hedon.compare.source import read_both, read_table

    return read_table(source) if other is None else read_both((source, other))


def columns(text: str | None) -> list[str]:
    """Splits a text at its commas; empty for None."""
    return [name.strip() for name in text.split(",")] if text else []


def _folder(source: str, other: str | None) -> Path:
    """Default output folder: next to the worlds of a single source; the current folder for two, a file or a URL."""
    folder = Path(source)
    return folder / "compare" if other is None and "://" not in source and folder.is_dir() else Path("compare")
