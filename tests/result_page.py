"""Pages of results, the tables that accompany them, and numbers formatted as on the pages."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from scipy import stats

RESULTS = Path(__file__).parents[1] / "docs" / "results"


def page(name: str) -> str:
    return (RESULTS / name).read_text(encoding="utf-8")


def table(path: str) -> pl.DataFrame:
    return pl.read_parquet(RESULTS / path) if path.endswith(".parquet") else pl.read_csv(RESULTS / path)


def text(value: float, digits: int, sign: bool = False) -> str:
    """A number as shown on the pages: with a true minus sign, and no sign before a rounded 0."""
    shown = f"{value:{'+' if sign else ''}.{digits}f}"
    shown = shown.lstrip("-+") if float(shown) == 0 else shown
    return shown.replace("-", "\N{MINUS SIGN}")


def span(values: np.ndarray, digits: int = 3, sign: bool = True) -> str:
    """Mean and 95% confidence interval from Student's t."""
    bounds = stats.ttest_1samp(values, 0).confidence_interval()
    low, high = text(bounds.low, digits), text(bounds.high, digits)
    return f"{text(values.mean(), digits, sign)} ({low} … {high})"


def p_of(values: np.ndarray) -> float:
    found: Any = stats.ttest_1samp(values, 0)
    return float(found.pvalue)


def p_text(p: float) -> str:
    """A p value as shown on the pages: with two decimals, three below 0.0095, four below 0.001."""
    return f"{p:.4f}" if p < 0.001 else f"{p:.3f}" if p < 0.0095 else f"{p:.2f}"


def small(p: float) -> str:
    """A p value with at most four decimals."""
    return "< 0.0001" if p < 0.0001 else p_text(p)


def shares(name: str) -> np.ndarray:
    """For each world of a contest, the first group's final share minus one half."""
    worlds = table(f"compete/{name}/tables/contest_world.csv")
    first, second = (worlds[column].to_numpy() for column in worlds.columns[1:3])
    return first / (first + second) - 0.5


def coefficient(name: str) -> tuple[float, str]:
    row = table(f"compete/{name}/tables/contest.csv").row(0, named=True)
    return row["value"], f"({text(row['low'], 3)} … {text(row['high'], 3)})"
