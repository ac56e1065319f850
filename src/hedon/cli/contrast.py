"""`hedon contrast`: do two conditions of a sweep differ?"""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.console import make_console

Only = Annotated[
    str | None, typer.Option(metavar="COLUMN,…", help="Columns to look at; by default the usual ones of a report.")
]


def contrast(
    place: Annotated[str, typer.Argument(metavar="SWEEP", help="Where the sweep lives: a folder, or a URL.")],
    by: Annotated[str, typer.Option(metavar="FACTOR", help="The factor that tells the conditions apart.")],
    between: Annotated[
        str | None, typer.Option(metavar="A,B", help="Two of its values; needed where it has more.")
    ] = None,
    only: Only = None,
    paired: Annotated[bool, typer.Option("--paired/--unpaired", help="Compare in pairs where seeds are equal.")] = True,
    out: Annotated[Path | None, typer.Option(help="Folder of the answer; by default SWEEP/contrast.")] = None,
) -> None:
    """Say in what two conditions of a sweep differ: by how much, how sure, and with what chance by luck alone.

    Worlds are the units, in pairs where their seeds are equal. Prints the difference of each measure with its interval,
    the size of the effect, and a permutation test that is corrected for the number of measures. Also while the sweep
    runs. docs/guide/contrast.md explains it.

    \b
    Examples:
      hedon contrast sweeps/cost --by energy.basic_cost --between 0.0005,0.002
      hedon contrast sweeps/two --by preset --only alive_mean,w_action_mean
    """
    from hedon.cli.display.analysis import analysis_group
    from hedon.jobs.store import Store
    from hedon.report.answer import write_answer
    from hedon.sweep.collect import collect
    from hedon.sweep.contrast import contrast_answer
    from hedon.sweep.plan import load_plan

    store = Store(place)
    plan = load_plan(store)
    found = contrast_answer(plan, collect(plan, store), by, between, columns(only), paired=paired)
    files = write_answer(out or (store.folder or Path("sweeps") / plan.name) / "contrast", found)
    console = make_console()
    console.print(analysis_group({table.name: table for table in found.tables}))
    console.print(f"wrote {', '.join(map(str, files))}", soft_wrap=True)


def columns(text: str | None) -> list[str]:
    """Names from a text with commas between them; none for None."""
    return [name.strip() for name in text.split(",")] if text else []
