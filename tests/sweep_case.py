"""A sweep of small worlds, and how two are compared."""

import textwrap
from pathlib import Path

import polars as pl
import pytest
from polars.testing import assert_frame_equal
from resumed_run import SMALL

from hedon.experiment.plan import Moment
from hedon.sweep.collect import collect
from hedon.sweep.plan import SweepPlan, load_plan, write_plan
from hedon.sweep.read import read_sweep
from hedon.sweep.store import Store, open_store
from hedon.sweep.work import make_batch, make_task

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


class MachineDiedError(Exception):
    """A machine that ends without a word."""


def assert_goes_on_elsewhere(url: str, folder: Path, steps: int) -> None:
    """A batch that died on one machine goes on from its state on another, and the table is that of a folder."""
    file = sweep_file(folder, steps)
    plan, store = planned(file, str(folder / "folder"))
    for batch in plan.batches():
        make_batch(make_task(store.location, plan, batch, folder / batch.name, 1e9), 1, None)
    remote, far = planned(file, url)

    class Stopping:
        """A machine that dies when a state has been sent."""

        def update(self, moment: Moment) -> None:
            if moment.step > steps // 2:
                raise MachineDiedError

    first = remote.batches()[0]
    with pytest.raises(MachineDiedError):
        make_batch(make_task(url, remote, first, folder / "one machine", 0.0), 1, Stopping())
    assert far.names("state") == [f"{first.name}.zip"]
    assert far.names("results") == []
    begun: list[int] = []

    class Watching:
        """Another machine, which notes where it goes on."""

        def update(self, moment: Moment) -> None:
            begun.append(moment.first)

    assert make_batch(make_task(url, remote, first, folder / "another", 1e9), 1, Watching()) == "finished"
    assert begun[0] > 0, "it was to go on from the state"
    assert far.names("state") == []
    for batch in remote.batches():
        assert make_batch(make_task(url, remote, batch, folder / f"rest-{batch.name}", 1e9), 1, None) == "finished"
    assert_same_table(table_of(url), table_of(store.location))
