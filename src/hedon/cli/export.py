"""`hedon export`: the records of a run as files for other tools."""

from pathlib import Path
from typing import Annotated, Literal, cast

import typer

from hedon.error import HedonError

TABLES = ("csv", "parquet", "arrow")
TREES = ("alife", "newick", "png")
OF_A_WORLD = ("phylogeny", "indices")
POINTS = 50


class ExportArgumentError(HedonError):
    """Arguments of `hedon export` that do not go together."""


def export(
    what: Annotated[
        Literal["agents", "population", "frames", "phylogeny", "indices"],
        typer.Argument(help="A table of all worlds; or of one its pedigree, or indices of the pedigree's shape."),
    ],
    run: Annotated[Path, typer.Argument(help="Folder of the run; it is only read.")],
    file_format: Annotated[
        Literal["csv", "parquet", "arrow", "alife", "newick", "png"] | None,
        typer.Option(
            "--format",
            help="Of a table: csv (default), parquet or arrow. Of a phylogeny: alife (default), the ALife data "
            "standard with all agents and their genes; newick, a tree of the living; or png, a picture of it.",
        ),
    ] = None,
    world: Annotated[int | None, typer.Option(metavar="SEED", help="Whose pedigree, by the world's seed.")] = None,
    species: Annotated[str | None, typer.Option(help="Only the pedigree of this species.")] = None,
    color: Annotated[
        str | None, typer.Option(metavar="GENE", help="What colors the picture; by default the first gene.")
    ] = None,
    points: Annotated[int, typer.Option(help="How many times indices are taken at.", min=1, max=10_000)] = POINTS,
    out: Annotated[
        Path | None, typer.Option(help="The new file; by default RUN-WHAT with the format's ending, here.")
    ] = None,
) -> None:
    """Write the records of a run as one file for other tools.

    \b
    Examples:
      hedon export agents runs/baseline-corrected-s1
      hedon export population runs/baseline-corrected-s1 --format parquet --out population.parquet
      hedon export phylogeny runs/baseline-corrected-s1 --format newick
      hedon export phylogeny runs/baseline-corrected-s1 --format png --color w_action
      hedon export indices runs/baseline-corrected-s1 --points 100
    """
    from hedon.cli.display.step import StepDisplay
    from hedon.export.indices import index_table
    from hedon.export.phylogeny import (
        TWO_PARENTS,
        alife_table,
        has_two_parents,
        last_step,
        newick,
        pedigree,
        picture,
    )
    from hedon.export.table import TableFormat, table_of, write_new, write_table
    from hedon.record.reader import open_run

    formats = TREES if what == "phylogeny" else TABLES
    chosen = file_format or formats[0]
    if chosen not in formats:
        raise ExportArgumentError(f"--format {chosen}: of {what} there is " + ", ".join(formats))
    if color is not None and chosen != "png":
        raise ExportArgumentError("--color is of a picture: export phylogeny --format png")
    if what not in OF_A_WORLD and (world is not None or species is not None):
        raise ExportArgumentError(f"--world and --species choose a pedigree: {what} has all worlds and species")
    opened = open_run(run)
    ending = {"alife": "csv", "newick": "nwk"}.get(chosen, chosen)
    target = out or Path(f"{run.resolve().name}-{what}.{ending}")
    with StepDisplay("exporting") as tell:
        tell(0, 2, f"reading {what}")
        if what not in OF_A_WORLD:
            table = table_of(opened, what)
            tell(1, 2, f"writing {target}")
            write_table(table, cast(TableFormat, chosen), target)
        else:
            agents = pedigree(opened, world, species)
            now = last_step(opened, agents)
            tell(1, 2, f"writing {target}")
            if what == "indices":
                write_table(index_table(agents, now, points).lazy(), cast(TableFormat, chosen), target)
            elif chosen == "alife":
                if has_two_parents(agents):
                    typer.echo(f"hedon: note: {TWO_PARENTS}", err=True)
                write_table(alife_table(agents, opened.weight_names).lazy(), "csv", target)
            else:
                content = picture(agents, now, opened.weight_names, color) if chosen == "png" else newick(agents, now)
                write_new(target, lambda file: file.write(content))
    typer.echo(f"wrote {target}")
