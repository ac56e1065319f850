"""`hedon power`: computes how many worlds are needed to detect an effect."""

from pathlib import Path
from typing import Annotated

import typer

from hedon.cli.compare import Between, Only, columns, read_sources
from hedon.cli.console import make_console
from hedon.error import HedonError
from hedon.text import brief


class PowerError(HedonError):
    """Invalid arguments of `hedon power`."""


def power(
    source: Annotated[
        str | None,
        typer.Argument(
            metavar="PILOT", help="Worlds that show the variation: runs, a sweep, an assay, a study, or a table."
        ),
    ] = None,
    other: Annotated[
        str | None, typer.Argument(metavar="OTHER", help="A second condition, in pairs with the first by seed.")
    ] = None,
    effect: Annotated[
        str | None,
        typer.Option(metavar="SIZE,…", help="Effects to detect, in units of the measure, as in -0.02,-0.01."),
    ] = None,
    only: Only = None,
    by: Annotated[
        str | None, typer.Option(metavar="FACTOR", help="The factor that distinguishes two conditions, for pairs.")
    ] = None,
    between: Between = None,
    sd: Annotated[
        float | None, typer.Option(help="Instead of a pilot: the standard deviation between worlds, or of pairs.")
    ] = None,
    chance: Annotated[
        float, typer.Option("--power", help="Probability of detecting the effect.", min=0.06, max=0.999)
    ] = 0.8,
    level: Annotated[float, typer.Option(help="Significance level of the test.", min=0.0001, max=0.5)] = 0.05,
    out: Annotated[Path | None, typer.Option(help="Folder of the answer; by default none is written.")] = None,
) -> None:
    """Compute how many worlds are needed to detect an effect, from the variation among the worlds of a pilot.

    Without --effect it lists the effects that various numbers of worlds can detect. docs/guide/compare.md explains it.

    \b
    Examples:
      hedon power sweeps/pilot --by preset --only w_action_mean --effect 0.1,0.2
      hedon power assays/landscape-predator assays/landscape-prey-alone --effect -0.015
      hedon power --sd 0.048 --effect -0.02
    """
    from hedon.cli.display.analysis import analysis_group
    from hedon.compare.power import ALONE, APART, PilotSpread, power_answer, spreads
    from hedon.compare.source import SOURCE
    from hedon.report.answer import write_answer

    sizes = _numbers(effect)
    if between is not None and by is None:
        raise PowerError("--between: names two values of a factor: give it as --by FACTOR")
    if chance <= level:
        raise PowerError(f"--power {chance:g}: must be above --level = {level:g}")
    if (source is None) == (sd is None):
        raise PowerError("give either a PILOT, such as the folder of a sweep, or --sd")
    if source is None:
        if not sd or sd < 0 or by or only:
            raise PowerError("--sd: must be above 0, and needs no --by or --only")
        found, name = [PilotSpread("measure", design, sd, sd, sd, 0) for design in (ALONE, APART)], ""
        cautions: tuple[str, ...] = ()
    else:
        pilot = read_sources(source, other)
        found, name = spreads(pilot, by or (SOURCE if other else None), between, columns(only)), pilot.name
        cautions = pilot.cautions
    answer = power_answer(found, sizes, chance, level, name, cautions)
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
