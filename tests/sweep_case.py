"""A sweep of small worlds, and a comparison of two sweeps."""

import io
import json
import subprocess
import sys
import textwrap
import zipfile
from pathlib import Path
from tempfile import TemporaryDirectory

import polars as pl
import pytest
from polars.testing import assert_frame_equal
from resumed_run import SMALL

from hedon.config import Config
from hedon.config.validate import rebuild
from hedon.ensemble.batch import WORK, batch_job
from hedon.ensemble.batches import batch_jobs
from hedon.ensemble.collect import collect
from hedon.ensemble.job import Job, Outcome
from hedon.ensemble.plan import SweepFile, SweepPlan, load_plan, write_plan
from hedon.ensemble.process import JobListener, make_jobs
from hedon.ensemble.store import Store
from hedon.experiment.plan import Moment
from hedon.record.reader import open_run
from hedon.sweep.read import read_sweep

FACTORS = """
[factor]
"energy.basic_cost" = [0.001, 0.01]
"""


class Silent:
    """A display that shows nothing."""

    def update(self, job: Job, moment: Moment) -> None: ...

    def end(self, job: Job, outcome: Outcome) -> None: ...


def sweep_file(folder: Path, steps: int = 320, seeds: int = 2, worlds: int = 2, rest: str = FACTORS) -> Path:
    """Writes the file for a sweep of small worlds."""
    path = folder / "small.toml"
    fixed = "\n".join(SMALL)
    path.write_text(f"steps = {steps}\nseeds = {seeds}\nworlds = {worlds}\n[set]\n{fixed}\n{textwrap.dedent(rest)}")
    return path


def planned(file: Path, location: str) -> tuple[SweepPlan, Store]:
    """The plan of a sweep file, written to a location."""
    store = Store(location)
    return write_plan(read_sweep(file), store), store


def condition_configs(file: SweepFile) -> list[Config]:
    """The config of each condition: its base with its changes."""
    plan = file.plan
    return [rebuild(file.bases[each.base].config, plan.changes(each), "") for each in plan.conditions]


def table_of(location: str) -> pl.DataFrame:
    """The table of all worlds of a sweep."""
    store = Store(location)
    return collect(load_plan(store), store)


def run_sweep(
    plan: SweepPlan,
    store: Store,
    checkpoint_seconds: float = 1e9,
    workers: int = 0,
    ray: str | None = None,
    display: JobListener | None = None,
) -> dict[str, Outcome]:
    """Makes all open batches; returns the outcome of each, by name."""
    with batch_jobs(plan, store, checkpoint_seconds, on_cluster=ray is not None) as jobs:
        outcomes = make_jobs(jobs, display or Silent(), workers, ray)
    return {folder.name: outcome for folder, outcome in outcomes.items()}


def under_way(place: Path) -> dict[str, tuple[int, int]]:
    """The process and the last checkpoint's step of each batch in progress."""
    found = {}
    for lock in (place / WORK).glob("*/.lock"):
        try:
            process = json.loads(lock.read_text())["process"]
        except (OSError, ValueError):  # it has just started or ended
            continue
        checkpoints = sorted((lock.parent / "checkpoints").glob("step-*.npz"))
        found[lock.parent.name] = process, int(checkpoints[-1].stem[5:]) if checkpoints else 0
    return found


def assert_same_table(one: pl.DataFrame, other: pl.DataFrame) -> None:
    """Asserts that two sweeps gave the same table, bit for bit."""
    assert_frame_equal(one, other, check_exact=True)


class MachineDiedError(Exception):
    """A machine died without notice."""


def assert_goes_on_elsewhere(url: str, folder: Path, steps: int) -> None:
    """Asserts that a batch that died on one machine continues on another, with the same table as in a folder."""
    file = sweep_file(folder, steps)
    plan, store = planned(file, str(folder / "folder"))
    for batch in plan.batches():
        batch_job(store.location, plan, batch, folder / batch.name, 1e9).make(1, None)
    remote, far = planned(file, url)

    class Stopping:
        """A machine that dies after sending a state."""

        def update(self, moment: Moment) -> None:
            if moment.step > steps // 2:
                raise MachineDiedError

    first = next(remote.batches())
    with pytest.raises(MachineDiedError):
        batch_job(url, remote, first, folder / "one machine", 0.0).make(1, Stopping().update)
    assert far.names("state") == [f"{first.name}.zip"]
    assert far.names("results") == []
    begun: list[int] = []

    class Watching:
        """Another machine, which records where it continues."""

        def update(self, moment: Moment) -> None:
            begun.append(moment.first)

    assert batch_job(url, remote, first, folder / "another", 1e9).make(1, Watching().update) == "finished"
    assert begun[0] > 0, "it should continue from the saved state"
    assert far.names("state") == []
    for batch in remote.batches():
        assert batch_job(url, remote, batch, folder / f"rest-{batch.name}", 1e9).make(1, None) == "finished"
    assert_same_table(table_of(url), table_of(store.location))


def assert_two_make_one(url: str, folder: Path, rest: str = FACTORS) -> None:
    """Asserts that two processes that run one sweep at a URL concurrently write the same rows as one in a folder."""
    file = sweep_file(folder, 3_200, rest=rest)
    file.write_text('keep = ["agents", "run"]\n' + file.read_text())
    plan, store = planned(file, str(folder / "folder"))
    for batch in plan.batches():
        batch_job(store.location, plan, batch, folder / batch.name, 1e9).make(1, None)
    words = ["sweep", "run", str(file), "--out", url, "--workers", "1", "--checkpoint", "0"]
    start = "from hedon.cli.start import main; main()"
    both = [
        subprocess.Popen([sys.executable, "-c", start, *words], stdout=subprocess.PIPE, text=True) for _ in range(2)
    ]
    for one in both:
        said, _ = one.communicate(timeout=300)
        assert one.returncode == 0, said
        assert "All done" in said
    remote, far = planned(file, url)
    assert far.names("state") == []
    assert_same_table(table_of(url), table_of(store.location))
    assert_kept_whole(far, remote)


def assert_kept_whole(store: Store, plan: SweepPlan) -> None:
    """Asserts that a sweep at a URL keeps complete files, with each batch from one process: run and table agree."""
    for batch in plan.batches():
        table = pl.read_parquet(store.read(f"tables/agents/{batch.name}.parquet") or b"")
        with (
            zipfile.ZipFile(io.BytesIO(store.read(f"runs/{batch.name}.zip") or b"")) as run,
            TemporaryDirectory() as at,
        ):
            run.extractall(at)
            assert_frame_equal(open_run(Path(at)).agents().sort("world", "agent_id"), table)
