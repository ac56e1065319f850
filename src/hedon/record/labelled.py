"""Converts tables to labelled xarray arrays: values over seeds, factors and time instead of rows."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from hedon.error import ArgumentError

if TYPE_CHECKING:
    import xarray


def to_xarray(
    rows: pl.DataFrame, dims: Sequence[str], attributes: Mapping[str, Mapping[str, str]] | None = None
) -> "xarray.Dataset":
    """A table as a dataset whose dimensions are some of its columns, such as the factors and the seed of a sweep.

    Args:
        rows: The table, with one row at most for each combination of values of the dimensions.
        dims: Columns that become dimensions, labeled with their sorted values; all other columns become variables.
        attributes: Attributes of variables, such as units, by name of the variable.

    Returns:
        Variables of shape (labels of the first dimension, of the second, …): numbers as floats, texts as objects; NaN
        if there is no row or no value.

    Raises:
        ArgumentError: A dimension is not a column, a combination appears twice, or xarray is not installed.
    """
    try:
        import xarray as xr
    except ModuleNotFoundError as error:
        raise ArgumentError(f'labelled arrays need {error.name}: pip install "hedon[xarray]"') from error
    for name in dims:
        if name not in rows.columns:
            raise ArgumentError(f"dims: there is no column {name!r} (there are {', '.join(rows.columns)})")
    if rows.select(dims).is_duplicated().any():
        raise ArgumentError(
            f"dims: several rows have the same {', '.join(dims)}: name the columns that tell them apart"
        )
    labels = {name: rows[name].unique().sort().to_numpy() for name in dims}
    shape = tuple(len(coordinates) for coordinates in labels.values())
    places = tuple(np.searchsorted(labels[name], rows[name].to_numpy()) for name in dims)
    variables: dict[str, Any] = {}
    for column in rows.drop(dims):
        numeric = column.dtype.is_numeric() or column.dtype == pl.Boolean
        values = np.full(shape, np.nan) if numeric else np.full(shape, np.nan, object)
        values[places] = column.cast(pl.Float64).to_numpy() if numeric else column.to_list()
        variables[column.name] = (list(dims), values, dict((attributes or {}).get(column.name, {})))
    return xr.Dataset(variables, coords=labels)
