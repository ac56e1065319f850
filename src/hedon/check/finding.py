"""The results of a check: what is wrong, notes, what can still be used."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import polars as pl

SHOWN = 3
"""Most rows that a finding names."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong.

    Attributes:
        where: A file, by its path within the run's folder, or a table.
        what: What is wrong with it.
    """

    where: str
    what: str


@dataclass(frozen=True, slots=True)
class CheckResult:
    """The results of a check of one run.

    Attributes:
        findings: What is wrong; empty if nothing is.
        notes: What the user should know but is not wrong, such as what was not checked, and why.
        usable: What can still be used.
    """

    findings: tuple[Finding, ...]
    notes: tuple[str, ...]
    usable: tuple[str, ...]


def break_rules(rows: pl.DataFrame, table: str, keys: Sequence[str], rules: Mapping[str, pl.Expr]) -> Iterator[Finding]:
    """One finding for each rule that some rows break."""
    for what, wrong in rules.items():
        found = rows.filter(wrong)
        if found.height:
            yield Finding(table, f"{_name_rows(found, keys)}: {what}")


def _name_rows(rows: pl.DataFrame, keys: Sequence[str]) -> str:
    """The first rows by their keys, and how many more there are."""
    words = [key.removesuffix("_id") for key in keys]
    names = [
        " ".join(f"{word} {value}" for word, value in zip(words, row, strict=True))
        for row in rows.select(keys).head(SHOWN).iter_rows()
    ]
    more = f" and {rows.height - SHOWN:,} more" if rows.height > SHOWN else ""
    return "; ".join(names) + more
