"""The table of observed levels, `levels.csv`, and the page of the documentation that shows it."""

import csv
from pathlib import Path

from calibrations.calibration import Calibration, Level, holds

HERE = Path(__file__).parent
LEVELS = HERE / "levels.csv"
PAGE = HERE.parent / "docs" / "calibration.md"
HEADER = ("number", "design", "kind", "nominal", "observed", "error", "answered", "simulations")

INTRODUCTION = """# How often hedon's numbers are wrong

hedon prints p values, confidence intervals and verdicts. This page lists how often each of them is wrong. We measured
this by simulation: we passed data with no effect, or with a known effect, to the function that prints each number.

Every test run repeats some of the simulations and fails if a number leaves its level. To regenerate this page, run
`python -m calibrations --write`.

- **False alarms**: how often a test rejects when there is no effect. **Missed**: how often an interval leaves out the
  true value. Both should be close to the nominal rate, or below it.
- **Found**: how often a known effect is detected, which should be at least the nominal rate. **Bias**: the mean error,
  as a share of the true value or scale.
- **Answered**: the share of simulated data sets for which the number is given. With too few worlds, it is withheld.
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
