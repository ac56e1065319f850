"""The table of observed levels, `levels.csv`, and the page of the documentation that shows it."""

import csv
from pathlib import Path

from calibrations.calibration import Calibration, Level, holds

HERE = Path(__file__).parent
LEVELS = HERE / "levels.csv"
PAGE = HERE.parent / "docs" / "calibration.md"
HEADER = ("number", "design", "kind", "nominal", "observed", "error", "answered", "simulations")

INTRODUCTION = """# How often hedon's numbers are wrong

This page lists how often the p values, confidence intervals and verdicts that hedon prints are wrong. We measured this
by passing simulated data with no effect, or with a known effect, to the functions that users call. Numbers that are
known to be off are listed at the end.

Every test run repeats some of the simulations and fails if an error rate is too far from its nominal rate. To
regenerate this page, run `python -m calibrations --write`.

- **False alarms**: how often a test reports an effect when there is none. **Missed**: how often an interval does not
  contain the true value. Both should be close to the nominal rate, or below it.
- **Found**: how often a known effect is detected, which should be at least the nominal rate. **Bias**: the mean error,
  as a share of the true value or scale.
- **Observed**: the result of the simulations ± its standard error.
- **Answered**: the share of simulated data sets for which hedon gives the number. With too few worlds, it gives none.
"""


def read_levels() -> dict[str, Level]:
    """The committed levels by the key of their calibration; empty without a file."""
    if not LEVELS.exists():
        return {}
    with LEVELS.open(encoding="utf-8", newline="") as file:
        return {
            f"{row['number']} | {row['design']}": Level(
                int(row["simulations"]), int(row["answered"]), float(row["observed"]), float(row["error"])
            )
            for row in csv.DictReader(file)
        }


def write_levels(calibrations: dict[str, Calibration], levels: dict[str, Level]) -> None:
    """Writes the levels of all calibrations that have one, in their order.

    Args:
        calibrations: All of them, by key.
        levels: Observed levels, by key.
    """
    with LEVELS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        for key, entry in calibrations.items():
            if (level := levels.get(key)) is not None:
                counts = (f"{level.observed:.4f}", f"{level.error:.4f}", level.answered, level.simulations)
                writer.writerow((entry.number, entry.design, entry.kind, entry.nominal, *counts))


def page(calibrations: dict[str, Calibration], levels: dict[str, Level]) -> str:
    """The page in Markdown.

    Args:
        calibrations: All of them, by key.
        levels: Observed levels, by key.
    """
    rows = ["| number | simulated data | | nominal | observed | answered |", "|---|---|---|---:|---:|---:|"]
    for key, entry in calibrations.items():
        if (level := levels.get(key)) is not None:
            observed = f"{100 * level.observed:.1f} % ± {100 * level.error:.1f}"
            if not holds(entry, level):
                observed = f"**{observed}**"
            answered = f"{100 * level.answered / level.simulations:.0f} % of {level.simulations:,}"
            cells = (entry.number, entry.design, entry.kind, f"{100 * entry.nominal:g} %", observed, answered)
            rows.append(f"| {' | '.join(cells)} |")
    notes = [f"- **{entry.number}** ({entry.design}): {entry.note}" for entry in calibrations.values() if entry.note]
    known = ["", "## Known to be off", "", *notes] if notes else []
    return "\n".join([INTRODUCTION, *rows, *known, ""])
