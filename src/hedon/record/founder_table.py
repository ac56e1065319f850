"""Reads tables of founders, which may be from an untrusted source."""

import csv
import io
import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hedon.config.config import Config
from hedon.config.gene import limits_of
from hedon.record.founder import FOUNDERS, GROUP, SHARE, FounderError, Founders, column_of, make_founders, unknown_gene
from hedon.text import brief

MAX_ROWS = 100_000
"""Largest number of rows of a table."""
MAX_BYTES = 100_000_000


def read_table(path: Path, config: Config) -> Founders:
    """Reads a table of founders from a CSV file.

    Args:
        path: Path of the CSV file.
        config: Config of the worlds that the founders are for.

    Raises:
        FounderError: The table cannot be used; the message gives the place, the value and the allowed values.
    """
    origin = brief(str(path))
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
        if len(content) > MAX_BYTES:
            raise FounderError(f"{origin}: is too large for a table of founders (at most {MAX_BYTES:,} bytes)")
        rows = list(csv.reader(io.StringIO(content.decode("utf-8-sig"), newline=""), strict=True))
    except OSError as error:
        raise FounderError(f"{origin}: cannot be read: {error.strerror}") from None
    except (UnicodeDecodeError, csv.Error) as error:
        reason = "it is not UTF-8 text" if isinstance(error, UnicodeDecodeError) else f"it is not CSV: {error}"
        raise FounderError(f"{origin}: cannot be read: {reason}") from None
    header = [cell.strip() for cell in rows[0]] if rows else []
    genes = _columns(header, config, origin)
    lines = [(number, row) for number, row in enumerate(rows[1:], 2) if row]
    if not 1 <= len(lines) <= MAX_ROWS:
        raise FounderError(f"{origin}: must have from 1 to {MAX_ROWS:,} rows below its first line, not {len(lines):,}")
    values, groups, shares = [], [], {}
    limits = limits_of(config, genes.values())
    for number, row in lines:
        place = f"{origin}: line {number}"
        if len(row) != len(header):
            raise FounderError(f"{place}: has {len(row)} cells, but there are {len(header)} columns")
        cells = dict(zip(header, map(str.strip, row), strict=True))
        group = cells.get(GROUP) or path.stem
        if SHARE in header:
            share = _number(cells[SHARE], f"{place}, {SHARE}", 0.0, 1e9)
            if not share > 0 or shares.setdefault(group, share) != share:
                rule = "must be above 0, and the same in all rows of a group"
                raise FounderError(f"{place}, {SHARE} = {brief(cells[SHARE])}: {rule}")
        values.append(
            [
                _number(cells[name], f"{place}, {name}", -limits[gene], limits[gene], empty=True)
                for name, gene in genes.items()
            ]
        )
        groups.append(group)
    return make_founders(tuple(genes.values()), np.array(values, np.float32), groups, shares or None)


def load_founders(folder: Path, config: Config) -> Founders | None:
    """Reads the table of founders of a run; None if founders are drawn from the config's distributions.

    Args:
        folder: Folder of the run.
        config: Config of the run, with the digest of the table.

    Raises:
        FounderError: The table is missing or was changed.
    """
    if not config.world.founders:
        return None
    founders = read_table(folder / FOUNDERS, config)
    if founders.digest != config.world.founders:
        raise FounderError(f"{folder / FOUNDERS}: was changed: its digest differs from the one in the config")
    return founders


def _columns(header: Sequence[str], config: Config, origin: str) -> dict[str, str]:
    """The genome column for each gene column of a table."""
    genes: dict[str, str] = {}
    for name in header:
        if name in (GROUP, SHARE):
            continue
        column = column_of(config, name)
        if column is None:
            raise FounderError(f"{origin}: line 1: {unknown_gene(config, name)}")
        if column in genes.values():
            raise FounderError(f"{origin}: line 1: the gene {name!r} appears twice")
        genes[name] = column
    if not genes:
        raise FounderError(f"{origin}: line 1: must name at least one gene, such as food or action, besides {GROUP}")
    if len(set(header)) < len(header):
        raise FounderError(f"{origin}: line 1: a column appears twice")
    return genes


def _number(text: str, place: str, low: float, high: float, *, empty: bool = False) -> float:
    if empty and not text:
        return math.nan
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise FounderError(f"{place} = {brief(repr(text))}: must be a number from {low:g} to {high:g}")
    return value
