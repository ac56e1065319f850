"""Repeats a run, and compares its records and the worlds at its end."""

import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import polars as pl

from hedon.check.finding import Finding
from hedon.error import HedonError
from hedon.experiment.branch import plan_branch, start_branch
from hedon.experiment.plan import Callback
from hedon.record.folder import checkpoint_paths
from hedon.record.manifest import Manifest
from hedon.record.reader import Run, open_run


def replay_run(
    folder: Path | str, threads: int = 0, callbacks: Iterable[Callback] = ()
) -> tuple[tuple[Finding, ...], str]:
    """Repeats a run from its oldest checkpoint to its end, and compares both.

    Returns:
        The differences, and a sentence on what was compared.
    """
    folder = Path(folder)
    run = open_run(folder)
    steps = max(run.manifest.steps_done, default=0)
    checkpoint_steps = [int(path.stem.removeprefix("step-")) for path in checkpoint_paths(folder)]
    if run.manifest.status not in ("finished", "interrupted") or not run.manifest.world_digests:
        return (), f"not computed again: the run's status is {run.manifest.status}, so there is no end to compare with"
    if not checkpoint_steps or checkpoint_steps[0] >= steps:
        return (), "not computed again: there is no checkpoint before the end"
    config = run.config
    if config.driven:
        return (), "not computed again: another program told its agents what to do"
    start = checkpoint_steps[0]
    with tempfile.TemporaryDirectory(prefix="hedon-replay-") as scratch:
        try:
            replay_folder = Path(scratch) / "run"
            manifest = start_branch(
                plan_branch(folder, replay_folder, at=start, steps=steps, threads=threads), callbacks
            )
            findings = tuple(_compare(run, open_run(replay_folder), manifest, start))
        except HedonError as error:
            return (Finding(f"checkpoint of step {start:,}", f"cannot be computed again: {error}"),), "not compared"
    return findings, f"computed again from step {start:,} to {steps:,} and compared"


def _compare(run: Run, replay: Run, manifest: Manifest, start: int) -> Iterator[Finding]:
    for world, (old, new) in enumerate(zip(run.manifest.world_digests, manifest.world_digests, strict=True)):
        if old != new:
            yield Finding("manifest.json", f"world {world}: computed again, its digest is {new}, not {old}")
    # If a world died out in the checkpoint's window, before the checkpoint, both have its row of that window.
    window = start - start % run.config.world.rollout_steps
    is_later = pl.col("death_step").is_null() | (pl.col("death_step") > start)
    tables = {
        "agents": (run.agents().filter(is_later), replay.agents(), ["world", "agent_id"]),
        "population": (run.population().filter(pl.col("step") > window), replay.population(), ["world", "step"]),
        "frames": (run.frames().filter(pl.col("step") > start).collect(), replay.frames().collect(), ["world", "step"]),
    }
    for name, (old, new, keys) in tables.items():
        old, new = (rows.sort(keys, maintain_order=True) for rows in (old, new))
        if old.height != new.height:
            yield Finding(name, f"computed again, has {new.height:,} rows after step {start:,}, not {old.height:,}")
        elif not old.equals(new):
            differs = pl.any_horizontal([~old[column].eq_missing(new[column]) for column in old.columns])
            row = old.select(keys).filter(pl.select(differs).to_series()).row(0)
            location = ", ".join(f"{key} {value}" for key, value in zip(keys, row, strict=True))
            yield Finding(name, f"computed again, rows differ; the first is at {location}")
