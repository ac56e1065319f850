"""A sweep of small worlds, and how two are compared."""

import textwrap
from pathlib import Path

import polars as pl
from polars.testing import assert_frame_equal
from resumed_run import SMALL

from hedon.sweep.collect import collect
from hedon.sweep.plan import SweepPlan, load_plan, write_plan
from hedon.sweep.read import read_sweep
from hedon.sweep.store import Store, open_store

FACTORS = """
[factor]
"energy.basic_cost" = [0.001, 0.01]
"""


def sweep_file(folder: Path, steps: int = 320, seeds: int = 2, worlds: int = 2, rest: str = FACTORS) -> Path:
    """Writes the file of a sweep of small worlds."""
    path = folder / "small.toml"
    fixed = "\n".join(SMALL)
    path.write_text(f"steps = {steps}\nseeds = {seeds}\nworlds = {worlds}\n[set]\n{fixed}\n{textwrap.dedent(rest)}")
    return path


def planned(file: Path, location: str) -> tuple[SweepPlan, Store]:
    """The plan of a file, written to a place."""
    store = open_store(location)
    return write_plan(read_sweep(file), store), store


def table_of(location: str) -> pl.DataFrame:
    """The table of all worlds of a sweep."""
    store = open_store(location)
    return collect(load_plan(store), store)


def assert_same_table(one: pl.DataFrame, other: pl.DataFrame) -> None:
    """Two sweeps gave the same, bit for bit."""
    assert_frame_equal(one, other, check_exact=True)
