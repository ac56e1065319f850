"""Shows why two runs differ: settings, versions, and the first window and quantity in which their worlds diverge."""

from pathlib import Path
from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from hedon.check.difference import Parting

SHOWN = 6
"""Maximum number of quantities printed per world."""


def show_difference(a: Path, b: Path) -> bool:
    """Compares two runs, with worlds of the same seed matched, as far as both have records.

    Returns:
        Whether settings and records agree; versions and machines are listed but not compared.

    Raises:
        RecordError: A folder holds no run or a damaged one.
    """
    from hedon.check.difference import changed_line, compare_runs
    from hedon.text import printable

    found = compare_runs(a, b)
    for title, rows in (("settings", found.settings), ("made by", found.made_by)):
        typer.echo(f"{title}: {'the same' if not rows else ''}".rstrip())
        for name, before, after in rows:
            typer.echo(printable(f"  {changed_line(name, before, after)}"))
    typer.echo("worlds:")
    for each in found.partings:
        typer.echo(f"  seed {each.seed}: {_parting(each, ends_differ=each.seed in found.ends)}")
    if found.lonely:
        typer.echo(f"  only one of them has seed {', '.join(map(str, found.lonely))}")
    return found.same


def _parting(each: "Parting", *, ends_differ: bool) -> str:
    from hedon.check.difference import changed_value

    if each.step is None:
        end = ", but their states at the end differ" if ends_differ else ""
        if each.since and each.until <= each.since:
            return f"no step in common: one has records up to {each.until:,}, the other from {each.since:,} on{end}"
        return f"equal {f'from step {each.since:,} ' if each.since else ''}up to step {each.until:,}{end}"
    whose = f" of {each.species}" if each.species else ""
    where = f"in the window that ends at step {each.step:,}"
    if each.agent is not None:
        where = f"at agent {each.agent}, born at step {each.step:,}; all windows are equal"
    pairs = {name: tuple(map(changed_value, values)) for name, values in each.values.items()}
    shown = [f"{name} {before} -> {after}" for name, (before, after) in pairs.items()]
    more = f", and {len(shown) - SHOWN} more" if len(shown) > SHOWN else ""
    return f"part {where}{whose}: {', '.join(shown[:SHOWN])}{more}"
