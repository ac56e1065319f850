"""Small runs to stop and resume, and a comparison of two runs."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from polars.testing import assert_frame_equal

from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.array_file import ArrayWriter
from hedon.record.checkpoint import Fill
from hedon.record.manifest import Manifest
from hedon.record.reader import open_run

WINDOW = 64
SMALL = (
    "population.capacity=24",
    "population.initial_count=16",
    "food.normal.initial_count=10",
    f"world.rollout_steps={WINDOW}",
    "learning.minibatch_size=32",
    "learning.update_epochs=1",
    "birth.kappa=0.05",
    "hazard.kappa=0.2",
    "hazard.alpha_age=0.001",
)


def small_run(
    out: Path,
    steps: int,
    *,
    seeds: tuple[int, ...] = (1, 2),
    frames: int = 0,
    overrides: Iterable[str] = (),
    checkpoint_seconds: float = 1e9,
    backend: str = "",
) -> Manifest:
    """Runs a small baseline; with the default interval, it saves checkpoints only at the start and the end."""
    config = load_config("baseline", overrides=(*SMALL, *overrides))
    return run(RunPlan(config, seeds, steps, out, 1, frames, checkpoint_seconds, backend=backend))


def assert_same_run(folder: Path, other: Path) -> None:
    """Asserts that two runs recorded the same, row by row and bit by bit, and ended in the same state."""
    a, b = open_run(folder), open_run(other)
    assert a.manifest.world_digests == b.manifest.world_digests
    assert a.manifest.records_digest == b.manifest.records_digest is not None
    assert (a.manifest.steps_done, a.manifest.status) == (b.manifest.steps_done, b.manifest.status)
    agents = [run.agents().sort("world", "agent_id") for run in (a, b)]
    frames = [run.frames().collect().sort("world", "step", maintain_order=True) for run in (a, b)]
    assert_frame_equal(*agents, check_exact=True)
    assert_frame_equal(a.population(), b.population(), check_exact=True)
    assert_frame_equal(*frames, check_exact=True)


def filler(arrays: Mapping[str, NDArray[Any]]) -> Fill:
    """A function that fills a checkpoint with these arrays, by name."""

    def fill(out: ArrayWriter) -> None:
        for name, array in arrays.items():
            out.add(name, array)

    return fill
