"""The command: `python -m calibrations`, from a checkout."""

import sys
from concurrent.futures import ProcessPoolExecutor
from typing import Annotated

import typer

from calibrations.calibration import Level, holds, observe
from calibrations.page import PAGE, page, read_levels, write_levels
from calibrations.registry import all_calibrations


def _observe(key: str, simulations: int) -> Level:
    return observe(all_calibrations()[key], simulations)


def calibrate(
    parts: Annotated[
        list[str] | None, typer.Argument(metavar="[TEXT]...", help="Only numbers that contain one of these texts.")
    ] = None,
    simulations: Annotated[int, typer.Option(help="Data sets to draw for each number.", min=2)] = 1000,
    write: Annotated[
        bool, typer.Option("--write", help="Write calibrations/levels.csv and docs/calibration.md.")
    ] = False,
    workers: Annotated[int | None, typer.Option(help="Processes; by default one per processor.", min=1)] = None,
) -> None:
    """Observe how often p values, intervals and verdicts are wrong. Exit code 1 if one leaves its level."""
    entries, levels = all_calibrations(), read_levels()
    chosen = [key for key in entries if not parts or any(part in key for part in parts)]
    if not chosen:
        raise typer.BadParameter(f"no number contains {' or '.join(map(repr, parts or ()))}")
    sound = True
    with ProcessPoolExecutor(workers) as pool:
        for key, level in zip(chosen, pool.map(_observe, chosen, [simulations] * len(chosen)), strict=True):
            entry, levels[key] = entries[key], level
            verdict = "holds" if holds(entry, level) else "DOES NOT HOLD"
            sound &= verdict == "holds"
            print(
                f"{entry.number} ({entry.design}): {entry.kind} {level.observed:.4f} ± {level.error:.4f}, nominal "
                f"{entry.nominal:g}, {level.answered} of {level.simulations} answered: {verdict}",
                flush=True,
            )
    if write:
        write_levels(entries, levels)
        PAGE.write_text(page(entries, read_levels()), encoding="utf-8")
    sys.exit(not sound)


if __name__ == "__main__":
    typer.run(calibrate)
