"""Runs one batch of a sweep, and writes its rows of the table and the records to keep.

The result is written last and marks the batch as done. The run is in the sweep's folder or, if the sweep is behind a
URL, in a temporary one. In that case each checkpoint is also sent to the store, so that another process can continue
the batch there.
"""

import io
import json
import shutil
import time
import zipfile
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hedon.ensemble.condition import SweepCondition, describe
from hedon.ensemble.error import EnsembleError
from hedon.ensemble.plan import Batch, SweepPlan, load_config_of, load_rules
from hedon.ensemble.row import world_rows
from hedon.ensemble.store import Store
from hedon.experiment.plan import Callback, Moment, RunPlan
from hedon.experiment.resume import make
from hedon.measure.summary import summarize
from hedon.record.error import InUseError, RecordError
from hedon.record.folder import LOCK, checkpoint_paths
from hedon.record.lock import FolderLock
from hedon.record.manifest import Manifest
from hedon.record.reader import Run, open_run

RESULTS, STATE, WORK, TABLES, RUNS = "results", "state", "work", "tables", "runs"
_LOOK_SECONDS = 0.2
_ORPHAN_SECONDS = 120.0
"""How long a batch waits for another process to release its folder [s]."""


@dataclass(frozen=True)
class BatchJob:
    """A batch to run: what a process must know of a sweep. Its size does not depend on the size of the sweep.

    Attributes:
        location: Path or URL of the sweep's store.
        batch: The batch to run.
        condition: The condition of its worlds.
        changed: Settings that the condition changes in its base, by complete path.
        steps: Length of each world [step].
        keep: Which records to keep in addition to the table.
        folder: Folder for its run.
        checkpoint_seconds: Time between two checkpoints [s].
    """

    location: str
    batch: Batch
    condition: SweepCondition
    changed: Mapping[str, Any]
    steps: int
    keep: tuple[str, ...]
    folder: Path
    checkpoint_seconds: float

    @property
    def threads(self) -> int:
        """Always one: a sweep uses further processors to run more batches at a time."""
        return 1

    @property
    def seeds(self) -> tuple[int, ...]:
        """The seeds of its worlds."""
        return self.batch.seeds

    @property
    def world_steps(self) -> int:
        """Steps summed over its worlds, if none dies out [step]."""
        return self.steps * len(self.seeds)

    def newest(self) -> str:
        """The name of the checkpoint from which the batch would continue; empty if there is none."""
        store = Store(self.location)
        if store.folder is not None:
            return _newest(self.folder)
        with suppress(EnsembleError, zipfile.BadZipFile):
            content = store.read(_state_name(self)) or b""
            with zipfile.ZipFile(io.BytesIO(content)) as state:
                return max((path.name for path in map(Path, state.namelist()) if path.suffix == ".npz"), default="")
        return ""

    def describe(self) -> str:
        """The values of its factors and its seeds."""
        return describe(self.condition.settings, self.batch.seeds)

    @property
    def label(self) -> str:
        """Its name in displays: the description, since the name of the folder is a digest."""
        return self.describe()

    def make(self, threads: int, callback: Callback | None) -> str:
        """Starts or continues the batch, and writes its result at the end.

        Args:
            threads: Threads of the engine.
            callback: Called with moments of the run, if not None.

        Returns:
            "finished" or "interrupted".

        Raises:
            HedonError: The run fails (see `hedon.experiment.run.run`), or its results cannot be written.
        """
        store, batch = Store(self.location), self.batch
        name = f"{RESULTS}/{batch.name}.json"
        _wait_for_folder(self.folder)
        if store.read(name) is not None:
            return "finished"
        config = load_config_of(store, self.condition.digest, self.condition.base, self.changed)
        rules, seconds = load_rules(store, config), self.checkpoint_seconds
        plan = RunPlan(config, batch.seeds, self.steps, self.folder, threads, 0, seconds, rules=rules)
        _fetch_state(store, self)
        manifest = _make(plan, _Carrying(store, self, callback).update if store.folder is None else callback)
        if manifest.status != "finished":
            _send_state(store, self)
            return manifest.status
        run = open_run(self.folder)
        _keep(store, self, run)
        result = {
            "seconds": manifest.run_seconds,
            "worlds": world_rows(summarize(run), manifest.world_digests),
        }
        store.write(name, (json.dumps(result, ensure_ascii=False, allow_nan=False) + "\n").encode())
        store.remove(_state_name(self))
        shutil.rmtree(self.folder, ignore_errors=True)
        return "finished"


def batch_job(location: str, plan: SweepPlan, batch: Batch, folder: Path, checkpoint_seconds: float) -> BatchJob:
    """The job that runs one batch of a plan.

    Args:
        location: Path or URL of the sweep's store, valid from any working folder.
        plan: Plan of the sweep.
        batch: The batch to run.
        folder: Folder for its run.
        checkpoint_seconds: Time between two checkpoints [s]; 0 for one at the end of every window.
    """
    condition = plan.conditions[batch.condition]
    changed = plan.changes(condition)
    return BatchJob(location, batch, condition, changed, plan.steps, plan.keep, folder, checkpoint_seconds)


def _make(plan: RunPlan, callback: Callback | None) -> Manifest:
    """Continues the run of a batch; restarts it if it is too damaged to continue."""
    try:
        return make(plan, () if callback is None else (callback,))
    except RecordError as error:
        if isinstance(error, InUseError) or not plan.out.exists() or checkpoint_paths(plan.out):
            raise
        shutil.rmtree(plan.out)
        return make(plan, () if callback is None else (callback,))


def _keep(store: Store, job: BatchJob, run: Run) -> None:
    for table in ("agents", "population"):
        if table in job.keep:
            rows = run.agents().sort("world", "agent_id") if table == "agents" else run.population()
            buffer = io.BytesIO()
            rows.write_parquet(buffer)
            store.write(f"{TABLES}/{table}/{job.batch.name}.parquet", buffer.getvalue())
    if "run" in job.keep:
        paths = sorted(path for path in job.folder.rglob("*") if path.is_file() and path.name != LOCK)
        if store.folder is None:  # one object, since the parts of an earlier process may have other boundaries
            store.write(f"{RUNS}/{job.batch.name}.zip", _archive(job.folder, paths))
            return
        shutil.rmtree(store.folder / RUNS / job.batch.name, ignore_errors=True)
        for path in paths:
            store.write(f"{RUNS}/{job.batch.name}/{path.relative_to(job.folder)}", path.read_bytes())


class _Carrying:
    """Sends the state of a run to the store after each new checkpoint, and forwards moments."""

    def __init__(self, store: Store, job: BatchJob, callback: Callback | None) -> None:
        self._store, self._job, self._callback = store, job, callback
        self._sent = _newest(job.folder)

    def update(self, moment: Moment) -> None:
        if (newest := _newest(self._job.folder)) != self._sent:
            self._sent = newest
            _send_state(self._store, self._job)
        if self._callback is not None:
            self._callback(moment)


def _wait_for_folder(folder: Path) -> None:
    """Waits for an earlier process that still uses the folder, after a sweep was killed or a node died.

    That process ends soon, since it can no longer report its progress.

    Raises:
        InUseError: It does not end in time.
        RecordError: The folder cannot be written.
    """
    deadline = time.monotonic() + _ORPHAN_SECONDS
    while folder.exists():
        try:
            with FolderLock(folder):
                return
        except InUseError:
            if time.monotonic() > deadline:
                raise
            time.sleep(_LOOK_SECONDS)


def _newest(folder: Path) -> str:
    return max((path.name for path in checkpoint_paths(folder)), default="")


def _state_name(job: BatchJob) -> str:
    return f"{STATE}/{job.batch.name}.zip"


def _send_state(store: Store, job: BatchJob) -> None:
    """Sends a run's folder. The checkpoint goes first: on resuming, later rows in the other files are removed."""
    if store.folder is not None:
        return
    other_files = sorted(path for path in job.folder.rglob("*") if path.is_file() and not path.name.startswith("."))
    checkpoints = checkpoint_paths(job.folder)[-1:]
    state = _archive(job.folder, [*checkpoints, *(path for path in other_files if path.suffix != ".npz")])
    store.write(_state_name(job), state)


def _archive(folder: Path, paths: Sequence[Path]) -> bytes:
    """The content of a zip file with files of a folder, in this order."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path in paths:
            archive.write(path, str(path.relative_to(folder)))
    return buffer.getvalue()


def _fetch_state(store: Store, job: BatchJob) -> None:
    """Copies the state of a run from the store, if it was started elsewhere and not here."""
    if store.folder is not None or _newest(job.folder):
        return
    content = store.read(_state_name(job))
    if content is not None:
        shutil.rmtree(job.folder, ignore_errors=True)
        # If the state cannot be read, the batch starts again.
        with suppress(zipfile.BadZipFile), zipfile.ZipFile(io.BytesIO(content)) as archive:
            archive.extractall(job.folder)
