"""The types of the schema: columns and tables."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import polars as pl

POLARS_TYPES = {"i32": "Int32", "i64": "Int64", "f32": "Float32", "f64": "Float64", "string": "String"}
NUMPY_TYPES: dict[str, type[np.generic]] = {
    "i32": np.int32,
    "i64": np.int64,
    "f32": np.float32,
    "f64": np.float64,
}
MOST_TURN = 1e9
"""Largest valid heading [rad]. No body turns this far in a run; larger values mean damage and cannot be drawn."""


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes:
        name: Name in the files.
        dtype: "i32", "i64", "f32", "f64" or "string".
        unit: Unit; "1" for counts and pure numbers.
        meaning: Description, as a phrase.
        nullable: Whether values may be missing; the writer takes −1 (integers) or NaN (floats) for a missing value.
        choices: The values that a string may have.
        missing_for: The kinds (column `kind`) whose rows have no value, while all others have one; None if unknown.
    """

    name: str
    dtype: str
    unit: str
    meaning: str
    nullable: bool = False
    choices: tuple[str, ...] = ()
    missing_for: tuple[str, ...] | None = None


@dataclass(frozen=True)
class Table:
    """One table: the name of its folder, the meaning of a row, and its columns in order."""

    name: str
    row: str
    columns: tuple[Column, ...]

    @property
    def polars_schema(self) -> "dict[str, type[pl.DataType]]":
        """The columns with their Polars types, in order."""
        import polars as pl  # not needed for worlds in memory

        return {column.name: getattr(pl, POLARS_TYPES[column.dtype]) for column in self.columns}
