"""Tables of a run as data frames of Polars or pandas."""

import difflib
from typing import TYPE_CHECKING, Any, Literal

import polars as pl

from hedon.error import ArgumentError
from hedon.text import brief

if TYPE_CHECKING:
    import pandas as pd

FrameName = Literal["polars", "pandas"]
FRAMES: tuple[FrameName, ...] = ("polars", "pandas")


def require_frame(name: Any) -> None:
    """Checks that a data frame library is known and installed, before anything is read.

    Raises:
        ArgumentError: The name is not one of `FRAMES`, or pandas is not installed.
    """
    if name not in FRAMES:
        matches = difflib.get_close_matches(str(name), FRAMES, n=1)
        hint = f"; did you mean {matches[0]!r}?" if matches else ""
        raise ArgumentError(f"frame = {brief(repr(name), 60)}: must be one of {', '.join(FRAMES)}{hint}")
    if name == "pandas":
        _pandas()


def to_pandas(table: pl.DataFrame) -> "pd.DataFrame":
    """A copy of the rows for pandas.

    Numbers keep their types, except that integers with missing values become 64-bit floats, with NaN for missing.
    Missing texts are None.
    """
    return _pandas().DataFrame({column.name: column.to_numpy(writable=True) for column in table})


def _pandas() -> Any:
    try:
        import pandas as pd
    except ModuleNotFoundError as error:
        raise ArgumentError(f"frame = 'pandas' needs {error.name}: pip install \"hedon[pandas]\"") from error
    return pd
