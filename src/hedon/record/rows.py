"""Converts arrays from the engine to a table as it is stored."""

from collections.abc import Mapping

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from hedon.record.column import NUMPY_TYPES, Column, Table
from hedon.record.error import RecordError

MISSING_INTEGER = -1  # the engine's "none" in a nullable integer column


def rows_to_frame(table: Table, rows: Mapping[str, ArrayLike]) -> pl.DataFrame:
    """Checks rows against the schema and copies them.

    Args:
        table: Schema of the rows.
        rows: One array of shape (n,) per column, in any order; a scalar stands for n equal values, and a
            nullable column may be omitted. In nullable columns, −1 (integers) and NaN (floats) become
            missing values.

    Returns:
        The rows with exactly the columns and types of the table, as a copy.

    Raises:
        RecordError: A column is missing or unknown, has another length, or has a value that its type cannot represent.
    """
    column_names = {column.name for column in table.columns}
    unknown = sorted(set(rows) - column_names)
    missing = [c.name for c in table.columns if c.name not in rows and not c.nullable]
    if unknown or missing:
        raise RecordError(f"rows of {table.name}: unknown columns {unknown}, missing columns {missing}")
    arrays = {name: np.asarray(values) for name, values in rows.items()}
    lengths = {name: len(array) for name, array in arrays.items() if array.ndim == 1}
    if any(array.ndim > 1 for array in arrays.values()) or len(set(lengths.values())) > 1:
        raise RecordError(f"rows of {table.name}: columns need the same length and one dimension, got {lengths}")
    count = next(iter(lengths.values()), 1)
    types = table.polars_schema
    return pl.DataFrame([_series(table, c, types[c.name], arrays.get(c.name), count) for c in table.columns])


def _series(table: Table, column: Column, dtype: type[pl.DataType], array: np.ndarray | None, count: int) -> pl.Series:
    if array is None:
        return pl.Series(column.name, [None] * count, dtype=dtype)
    if column.dtype == "string":
        return pl.Series(column.name, np.broadcast_to(array, (count,)).tolist(), dtype=dtype)
    values = np.broadcast_to(_cast(table, column, array), (count,)).copy()
    series = pl.Series(column.name, values, dtype=dtype)
    if not column.nullable:
        return series
    is_missing = np.isnan(values) if values.dtype.kind == "f" else values == MISSING_INTEGER
    return series.set(pl.Series(is_missing), None) if is_missing.any() else series


def _cast(table: Table, column: Column, array: np.ndarray) -> np.ndarray:
    target: np.dtype = np.dtype(NUMPY_TYPES[column.dtype])
    if array.dtype == target:
        return array
    if target.kind == "i":
        limits = np.iinfo(target)
        is_outside = array.size > 0 and (array.min() < limits.min or array.max() > limits.max)
        if array.dtype.kind not in "iub" or is_outside:
            raise RecordError(f"rows of {table.name}: {column.name} needs integers of type {column.dtype}")
    elif array.dtype.kind not in "fiub":
        raise RecordError(f"rows of {table.name}: {column.name} needs numbers, got {array.dtype}")
    return array.astype(target)
