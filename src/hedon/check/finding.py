"""The results of a check: faults, notes, and data that are still usable."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import polars as pl

SHOWN = 3
"""Largest number of rows that a finding lists."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One fault.

    Attributes:
        where: A table, or the path of a file within the run's folder.
        what: Description of the fault.
    """

    where: str
    what: str


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The results of a check of one run.

    Attributes:
        findings: The faults; empty if there are none.
        notes: Remarks that are not faults, such as what was not checked, and why.
        usable: Data that are still usable.
    """

    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    usable: tuple[str, ...]


def break_rules(rows: pl.DataFrame, table: str, keys: Sequence[str], rules: Mapping[str, pl.Expr]) -> Iterator[Finding]:
    """Yields one finding for each rule that some rows break.

    Args:
        rows: The rows to check.
        table: Name of the table, for the findings.
        keys: Columns that identify a row.
        rules: Descriptions of faults, each with an expression that is true for the faulty rows.
    """
    for what, is_broken in rules.items():
        broken = rows.filter(is_broken)
        if broken.height:
            yield Finding(table, f"{_name_rows(broken, keys)}: {what}")


def _name_rows(rows: pl.DataFrame, keys: Sequence[str]) -> str:
    """The keys of the first rows, and the number of further rows."""
    words = [key.removesuffix("_id") for key in keys]
    names = [
        " ".join(f"{word} {value}" for word, value in zip(words, row, strict=True))
        for row in rows.select(keys).head(SHOWN).iter_rows()
    ]
    remainder = f" and {rows.height - SHOWN:,} more" if rows.height > SHOWN else ""
    return "; ".join(names) + remainder
