"""Columns and tables: the types that the schema uses."""

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
"""No body turns so far in a run [rad]: a heading beyond it is damage, and no figure could be drawn with it."""


@dataclass(frozen=True)
class Column:
    """One column of a table.

    Attributes:
        name: as in the files.
        dtype: "i32", "i64", "f32", "f64" or "string".
        unit: "1" for counts and pure numbers.
        meaning: one phrase.
        nullable: whether a value may be missing; pass −1 (integers) or NaN (floats) to the writer for such a value.
        choices: the values that a string may have.
        missing_for: the kinds (column `kind`) whose rows have no value, and no others; None where it is not known.
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
        """The columns as Polars writes them, in order."""
        import polars as pl  # a world in memory needs no tables

        return {column.name: getattr(pl, POLARS_TYPES[column.dtype]) for column in self.columns}
