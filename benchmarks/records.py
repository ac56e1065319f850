"""The cost of records: rows per second of the writer, bytes on disk, and their share of a run's time."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

import numpy as np

from benchmarks.check import require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table
from benchmarks.plan import Plan
from benchmarks.scene import peopled
from hedon.config.dump import dump_toml
from hedon.config.schema.species import ONLY
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.experiment.sample import PopulationSampler, Rows, agent_rows
from hedon.experiment.simulation import Simulation
from hedon.record.manifest import Manifest
from hedon.record.reader import open_run
from hedon.record.writer import Writer

STREAM_WINDOWS = 1000
RUN_WINDOWS = 20


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row: a stream with the rows of many windows through the writer, and a normal short run."""
    with TemporaryDirectory(prefix="hedon-bench-") as folder:
        return [{**_stream(plan, Path(folder) / "stream"), **_run(plan, Path(folder) / "run")}]


def _stream(plan: Plan, folder: Path) -> Row:
    """Writes as many deaths per window as a populated world has, made from its living, and its population row."""
    config, world = plan.config(), peopled(plan)
    windows = 20 if plan.quick else STREAM_WINDOWS
    deaths = max(1, round(world.counters["deaths"] / (world.step / config.world.rollout_steps)))
    lives = world.agents()
    rng = np.random.default_rng(1)
    stream = [agent_rows(world, _made_up(lives, deaths, rng)) for _ in range(windows)]
    population = PopulationSampler(world).row()
    steps = windows * config.world.rollout_steps
    neutral = config.species[ONLY].genome.neutral_count
    manifest = Manifest(tuple(config.food), neutral, (world.seed,), max(steps, world.step))

    wall, total, caller = time.perf_counter(), time.process_time(), time.thread_time()
    with Writer(folder, dump_toml(config), manifest) as writer:
        for rows in stream:
            writer.append("agents", rows)
            writer.append("population", population)
    wall, total, caller = time.perf_counter() - wall, time.process_time() - total, time.thread_time() - caller
    written = open_run(folder)
    require(written.agents().height == windows * deaths, "records: the agents read back are not those written")
    require(written.population().height == windows, "records: the population rows read back are not those written")
    return {
        "stream_rows": windows * (deaths + 1),
        "stream_steps": steps,
        "stream_seconds": wall,
        "stream_caller_cpu_seconds": caller,
        "stream_thread_cpu_seconds": total - caller,
        "bytes_per_1e6_steps": sum(f.stat().st_size for f in folder.rglob("*.parquet")) * 1e6 / steps,
    }


def _made_up(lives: Rows, count: int, rng: np.random.Generator) -> Rows:
    """Random copies of given lives. All numbers are changed by up to a tenth: exact copies would compress too well."""
    drawn = rng.integers(0, len(lives["agent_id"]), count)

    def changed(column: np.ndarray) -> np.ndarray:
        return (column[drawn] * rng.uniform(0.9, 1.1, column[drawn].shape)).astype(column.dtype)

    return {name: changed(column) for name, column in lives.items()}


def _run(plan: Plan, folder: Path) -> Row:
    """A run with its records. All time of its loop outside the engine counts as theirs, including checkpoints."""
    config = plan.config()
    steps = (2 if plan.quick else RUN_WINDOWS) * config.world.rollout_steps
    with _engine_seconds() as engine:
        manifest = run(RunPlan(config, (1,), steps, folder, plan.threads[-1]))
    require(manifest.status == "finished", f"records: the status of the run is {manifest.status}")
    return {
        "run_steps": steps,
        "run_threads": plan.threads[-1],
        "run_seconds": manifest.run_seconds,
        "run_engine_seconds": sum(engine),
    }


@contextmanager
def _engine_seconds() -> Iterator[list[float]]:
    """Measures the time of each call of the engine, from any caller [s]."""
    seconds: list[float] = []
    advance = Simulation.run

    def timed(self: Simulation, steps: int) -> None:
        before = time.perf_counter()
        advance(self, steps)
        seconds.append(time.perf_counter() - before)

    with patch.object(Simulation, "run", timed):
        yield seconds


def table(rows: list[Row], _: Calibration) -> Table:
    """One line."""
    row = rows[0]
    per_step = row["run_engine_seconds"] / row["run_steps"]
    line = (
        f"{row['stream_rows'] / row['stream_seconds']:,.0f}",
        f"{row['bytes_per_1e6_steps'] / 1e6:.2f}",
        f"{1 - row['run_engine_seconds'] / row['run_seconds']:.2%}",
        f"{row['stream_thread_cpu_seconds'] / row['stream_steps'] / per_step:.2%}",
    )
    headings = ("rows/s", "MB per 1e6 steps", "loop outside the engine", "writing threads")
    notes = (
        f"Stream: {row['stream_rows']:,} rows of {row['stream_steps']:,} steps. Shares: of the time of a run of"
        f" {row['run_steps']:,} steps on {row['run_threads']} threads; the writing threads work in parallel.",
    )
    return Table("records: writing a run's tables", headings, [line], notes)
