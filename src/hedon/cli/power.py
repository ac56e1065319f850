"""`hedon power`: how many worlds are needed to see an effect?"""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.console import make_console
from hedon.cli.contrast import Only, columns
from hedon.error import HedonError
from hedon.text import brief


class PowerError(HedonError):
    """Arguments of `hedon power` that cannot be used."""


def power(
    source: Annotated[
        str | None,
        typer.Argument(
            metavar="PILOT", help="Worlds to learn from: a sweep, the folder of an assay, or a table (.csv, .parquet)."
        ),
    ] = None,
    effect: Annotated[
        str | None, typer.Option(metavar="SIZE,…", help="Effects to see, in units of the measure, as in -0.02,-0.01.")
    ] = None,
    only: Only = None,
    by: Annotated[
        str | None, typer.Option(metavar="COLUMN", help="What tells two conditions of the pilot apart, for pairs.")
    ] = None,
    between: Annotated[
        str | None, typer.Option(metavar="A,B", help="Which two values of --by, where it has more than two.")
    ] = None,
    against: Annotated[
        str | None, typer.Option(metavar="PILOT", help="Another condition's worlds, in pairs by their seeds.")
    ] = None,
    sd: Annotated[
        float | None, typer.Option(help="Instead of a pilot: the standard deviation between worlds, or of pairs.")
    ] = None,
    chance: Annotated[float, typer.Option("--power", help="Chance to see the effect.", min=0.06, max=0.999)] = 0.8,
    level: Annotated[float, typer.Option(help="Of the test.", min=0.0001, max=0.5)] = 0.05,
    out: Annotated[Path | None, typer.Option(help="Folder of the answer; by default none is written.")] = None,
) -> None:
    """Say how many worlds are needed to see an effect, from how much the worlds of a pilot differ.

    Without --effect it says which effects some numbers of worlds would see. docs/guide/contrast.md explains it.

    \b
    Examples:
      hedon power sweeps/pilot --by preset --only w_action_mean --effect 0.1,0.2
      hedon power assays/landscape-predator --against assays/landscape-prey-alone --effect -0.015
      hedon power --sd 0.048 --effect -0.02
    """
    from hedon.cli.display.analysis import analysis_group
    from hedon.report.answer import write_answer
    from hedon.sweep.power import ALONE, APART, PilotSpread, power_answer, read_pilot, spreads

    sizes = _numbers(effect)
    if between is not None and by is None:
        raise PowerError("--between: names two values of a column: give it as --by COLUMN")
    if chance <= level:
        raise PowerError(f"--power {chance:g}: must be above --level = {level:g}")
    if (source is None) == (sd is None):
        raise PowerError("give either a PILOT, such as the folder of a sweep, or --sd")
    if source is None:
        if not sd or sd < 0 or by or against or only:
            raise PowerError("--sd: must be above 0, and needs no --by, --against or --only")
        found = [PilotSpread("measure", design, sd, sd, sd, 0) for design in (ALONE, APART)]
    else:
        other = None if against is None else read_pilot(against, columns(only))
        found = spreads(read_pilot(source, columns(only)), by, other, between)
    answer = power_answer(found, sizes, chance, level, source or "")
    console = make_console()
    console.print(analysis_group({table.name: table for table in answer.tables}))
    if out is not None:
        console.print(f"wrote {', '.join(map(str, write_answer(out, answer)))}", soft_wrap=True)


def _numbers(text: str | None) -> list[float]:
    try:
        found = [float(part) for part in columns(text)]
    except ValueError:
        found = [0.0]
    if not all(0 < abs(each) < float("inf") for each in found):
        raise PowerError(f"--effect {brief(text or '')}: must be numbers other than 0, as in -0.02,-0.01")
    return found
