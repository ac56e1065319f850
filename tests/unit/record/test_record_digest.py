"""The digest of records covers rows, not files."""

from pathlib import Path

import polars as pl
import pytest
from synthetic_run import write_run

from hedon.record.digest import records_digest
from hedon.record.error import RecordError
from hedon.record.folder import LIVING, part_path, part_paths
from hedon.record.schema import Columns

KINDS = Columns(("normal",), 1)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    run = write_run(tmp_path / "run", intervals=20, worlds=3)
    frames = {"world": [0, 0, 1], "step": [5, 5, 5], "kind": ["agent", "normal", "agent"], "id": [1, None, 2]}
    places = {"x": [1.0, 2.0, 3.0], "y": [0.0, 0.0, 0.0], "angle": [0.5, None, 0.0], "energy": [1.0, None, 2.0]}
    types = {"world": pl.Int32, "x": pl.Float32, "y": pl.Float32, "angle": pl.Float32, "energy": pl.Float32}
    pl.DataFrame(frames | places, schema_overrides=types).write_parquet(part_path(run, "frames", 0))
    return run


def test_the_split_into_parts_and_the_order_of_worlds_do_not_count(folder: Path) -> None:
    before = records_digest(folder, KINDS)
    for table in ("agents", "population", "frames"):
        rows = pl.concat([pl.read_parquet(path) for path in part_paths(folder, table)])
        for path in part_paths(folder, table):
            path.unlink()
        rows = rows.sort("world", descending=True, maintain_order=True)
        third = rows.height // 3
        for index, part in enumerate((rows[:third], rows[third : third + 1], rows[third + 1 :])):
            part.write_parquet(part_path(folder, table, index))
    assert records_digest(folder, KINDS) == before


@pytest.mark.parametrize("change", ["value", "null", "text", "double", "lost", "living"])
def test_every_row_and_value_counts(folder: Path, change: str) -> None:
    before = records_digest(folder, KINDS)
    path = folder / LIVING if change == "living" else part_path(folder, "frames", 0)
    rows = pl.read_parquet(path)
    changed = {
        "value": lambda: rows.with_columns(pl.col("x") * 1.0000001),
        "null": lambda: rows.with_columns(pl.col("angle").fill_null(0.0)),
        "text": lambda: rows.with_columns(pl.col("kind").replace("normal", "norma1")),
        "double": lambda: pl.concat([rows, rows[-1:]]),
        "lost": lambda: rows[:-1],
        "living": lambda: rows.with_columns(pl.col("generation") + 1),
    }[change]()
    changed.write_parquet(path)
    assert records_digest(folder, KINDS) != before


def test_a_damaged_part_is_named(folder: Path) -> None:
    path = part_paths(folder, "population")[0]
    path.write_bytes(path.read_bytes()[:-9])
    with pytest.raises(RecordError, match=r"damaged part .*population.part-000000"):
        records_digest(folder, KINDS)
