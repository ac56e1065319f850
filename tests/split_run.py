"""Runs in which a step can span two parts, as in older versions, which started a new part wherever one was full."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import polars as pl

from hedon import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.folder import part_path, part_paths

FRAMES = 32
"""Steps between two frames."""


def record_species(
    folder: Path, steps: int = 256, seeds: tuple[int, ...] = (1, 2), overrides: Sequence[str] = ()
) -> Path:
    """Records prey and predators, with a population row every 64 steps."""
    quick = ("world.rollout_steps=64", "learning.minibatch_size=64")
    config = load_config("predator", overrides=[*quick, *overrides])
    run(RunPlan(config, seeds, steps, folder, 1, FRAMES))
    return folder


def split_parts(folder: Path, table: str, rows: int) -> int:
    """Rewrites a table with this many rows per part; returns how many steps continue in the next part."""
    paths = part_paths(folder, table)
    whole = pl.concat([pl.read_parquet(path) for path in paths])
    for path in paths:
        path.unlink()
    parts = [whole[at : at + rows] for at in range(0, whole.height, rows)]
    for i, part in enumerate(parts):
        part.write_parquet(part_path(folder, table, i), compression="zstd")
    return sum(a["step"][-1] == b["step"][0] for a, b in pairwise(parts))
