"""`hedon export`: writes the records of a run as one file for other tools."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

if TYPE_CHECKING:
    import polars as pl

    from hedon.record.reader import Run

app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Write the records of a run as one file for other tools. docs/guide/export.md shows each.",
)
POINTS = 50
TableFormat = Literal["csv", "parquet", "arrow"]
TreeFormat = Literal["alife", "newick", "trees", "png"]

Source = Annotated[Path, typer.Argument(metavar="RUN", help="Folder of the run; it is only read.")]
Out = Annotated[Path | None, typer.Option(help="The new file; by default RUN-WHAT with the format's ending, here.")]
Format = Annotated[TableFormat, typer.Option("--format", help="Format of the file.")]
World = Annotated[
    int | None,
    typer.Option(metavar="SEED", help="Seed of the world; needed if the run has several."),
]
Species = Annotated[str | None, typer.Option(help="Only the pedigree of this species.")]


@app.command()
def agents(run: Source, file_format: Format = "csv", out: Out = None) -> None:
    """One row per agent: parent, birth, death, food, energy, children, genome.

    \b
    Example:
      hedon export agents runs/baseline-corrected-s1
    """
    _write_table("agents", run, file_format, out)


@app.command()
def population(run: Source, file_format: Format = "csv", out: Out = None) -> None:
    """One row per world and window of learning: numbers alive, births, deaths, weights, energy.

    \b
    Example:
      hedon export population runs/baseline-corrected-s1 --format parquet --out population.parquet
    """
    _write_table("population", run, file_format, out)


@app.command()
def frames(run: Source, file_format: Format = "csv", out: Out = None) -> None:
    """One row per agent or food in each frame: its position. Needs a run made with --frames.

    \b
    Example:
      hedon export frames runs/seen --format arrow
    """
    _write_table("frames", run, file_format, out)


@app.command()
def phylogeny(
    run: Source,
    file_format: Annotated[
        TreeFormat,
        typer.Option(
            "--format",
            help="alife, the ALife data standard with all agents and their genes; newick, a tree of the living; "
            "trees, a tree sequence for tskit; or png, a picture.",
        ),
    ] = "alife",
    world: World = None,
    species: Species = None,
    color: Annotated[
        str | None, typer.Option(metavar="GENE", help="Gene that colors the picture; by default the first.")
    ] = None,
    out: Out = None,
) -> None:
    """The pedigree of one world.

    \b
    Examples:
      hedon export phylogeny runs/baseline-corrected-s1 --format newick
      hedon export phylogeny runs/baseline-corrected-s1 --format trees
      hedon export phylogeny runs/baseline-corrected-s1 --format png --color w_action
    """
    from hedon.error import ArgumentError
    from hedon.export.phylogeny import TWO_PARENTS, alife_table, has_two_parents, newick, picture
    from hedon.export.table import write_new, write_table

    if color is not None and file_format != "png":
        raise ArgumentError("--color is of a picture: export phylogeny --format png")

    def write(opened: "Run", found: "pl.DataFrame", now: int, target: Path) -> None:
        if file_format == "alife":
            if has_two_parents(found):
                typer.echo(f"hedon: note: {TWO_PARENTS}", err=True)
            write_table(alife_table(found, opened.weight_names).lazy(), "csv", target)
            return
        genes = opened.weight_names
        if file_format == "trees":
            from hedon.export.tree_sequence import tree_sequence

            sequence = tree_sequence(found, genes, now)
            write_new(target, sequence.dump)
            return
        content = picture(found, now, genes, color) if file_format == "png" else newick(found, now)
        write_new(target, lambda file: file.write(content))

    ending = {"alife": "csv", "newick": "nwk"}.get(file_format, file_format)
    _write_pedigree("phylogeny", run, world, species, out or _default(run, "phylogeny", ending), write)


@app.command()
def indices(
    run: Source,
    file_format: Format = "csv",
    world: World = None,
    species: Species = None,
    points: Annotated[
        int, typer.Option(help="Number of times at which they are computed.", min=1, max=10_000)
    ] = POINTS,
    out: Out = None,
) -> None:
    """Indices of the pedigree's shape over time; needs the optional packages hedon[phylogeny].

    \b
    Example:
      hedon export indices runs/baseline-corrected-s1 --points 100
    """
    from hedon.export.indices import index_table
    from hedon.export.table import write_table

    def write(opened: "Run", found: "pl.DataFrame", now: int, target: Path) -> None:
        write_table(index_table(found, now, points).lazy(), file_format, target)

    _write_pedigree("indices", run, world, species, out or _default(run, "indices", file_format), write)


@app.command()
def dataset(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN…", help="Folders of runs.")],
    out: Annotated[Path | None, typer.Option(help="The new folder; by default dataset.")] = None,
    title: Annotated[str | None, typer.Option(help="Title of the card; by default the runs' names.")] = None,
    license_name: Annotated[
        str, typer.Option("--license", metavar="SPDX", help="License of the dataset, such as cc0-1.0.")
    ] = "cc-by-4.0",
    frames: Annotated[bool, typer.Option("--frames", help="Include the positions of all bodies.")] = False,
) -> None:
    """Runs as a dataset to publish: Parquet tables, configs, a card with every column, and checksums.

    \b
    Example:
      hedon export dataset runs/baseline-corrected-s1 --out baseline --license cc0-1.0
    """
    from hedon.export.dataset import write_dataset
    from hedon.record.reader import open_run

    made = write_dataset([open_run(path) for path in runs], out or Path("dataset"), title, license_name, frames=frames)
    typer.echo(f"wrote {made[0]} and {len(made) - 1} further files")


@app.command()
def video(
    run: Annotated[Path, typer.Argument(metavar="RUN", help="Folder of a run that was made with --frames.")],
    out: Annotated[Path, typer.Argument(metavar="OUT", help="The new file: .mp4 or .gif.")],
    first: Annotated[int | None, typer.Option("--from", metavar="STEP", help="Where to begin.", min=0)] = None,
    last: Annotated[int | None, typer.Option("--to", metavar="STEP", help="Where to end.", min=0)] = None,
    speed: Annotated[int, typer.Option(metavar="STEPS", help="Steps from one picture to the next.", min=1)] = 8,
    follow: Annotated[
        int | None, typer.Option(metavar="AGENT", help="Keep this agent in the middle, by default for all of its life.")
    ] = None,
    world: Annotated[
        int | None, typer.Option(metavar="SEED", help="Which world, by its seed; by default the first.")
    ] = None,
    width: Annotated[int, typer.Option(help="Width of the picture [pixel].", min=160, max=3840)] = 960,
    rate: Annotated[int, typer.Option(help="Pictures per second.", min=1, max=60)] = 25,
) -> None:
    """A video of a run.

    Agents are drawn as in the figure of the world: the darker, the more energy. Motion between frames is interpolated.
    Needs ffmpeg, which comes with the optional packages hedon[video].

    \b
    Examples:
      hedon run baseline --frames 64 --out runs/seen
      hedon export video runs/seen seen.mp4
      hedon export video runs/seen start.gif --to 2048 --speed 16 --width 480
      hedon export video runs/seen life.mp4 --follow 120 --speed 4
    """
    from hedon.cli.console import make_console
    from hedon.cli.display.film import FilmDisplay
    from hedon.video.make import choose_range, make_video
    from hedon.video.moment import open_footage

    footage = open_footage(run, world)
    shown = choose_range(footage, first, last, speed, follow)
    console = make_console()
    with FilmDisplay(console, rate) as display:
        make_video(footage, shown, out, width, rate, display.update)
    console.print(f"wrote {out}: {shown.pictures:,} pictures, {out.stat().st_size / 1e6:.1f} MB")


def _default(run: Path, what: str, ending: str) -> Path:
    return Path(f"{run.resolve().name}-{what}.{ending}")


def _write_table(
    what: Literal["agents", "population", "frames"], run: Path, kind: TableFormat, out: Path | None
) -> None:
    from hedon.cli.display.step import StepDisplay
    from hedon.export.table import table_of, write_table
    from hedon.record.reader import open_run

    opened, target = open_run(run), out or _default(run, what, kind)
    with StepDisplay("exporting") as tell:
        tell(0, 2, f"reading {what}")
        table = table_of(opened, what)
        tell(1, 2, f"writing {target}")
        write_table(table, kind, target)
    typer.echo(f"wrote {target}")


def _write_pedigree(
    what: str,
    run: Path,
    world: int | None,
    species: str | None,
    target: Path,
    write: "Callable[[Run, pl.DataFrame, int, Path], None]",
) -> None:
    """Writes data derived from a pedigree: `write` gets the run, its agents, the last step and the file."""
    from hedon.cli.display.step import StepDisplay
    from hedon.export.phylogeny import last_step, pedigree
    from hedon.record.reader import open_run

    opened = open_run(run)
    with StepDisplay("exporting") as tell:
        tell(0, 2, f"reading {what}")
        found = pedigree(opened, world, species)
        tell(1, 2, f"writing {target}")
        write(opened, found, last_step(opened, found), target)
    typer.echo(f"wrote {target}")
