"""Runs exported as a dataset: a hub can read the card, every column is documented, every file has a checksum."""

import hashlib
import json
from pathlib import Path
from typing import Any

import polars as pl
import pytest
from synthetic_run import write_run
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run as make_run
from hedon.export.dataset import write_dataset
from hedon.export.table import ExportError
from hedon.record.reader import open_run


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """One run with one species and one with two, whose tables have different columns."""
    folder = tmp_path_factory.mktemp("runs")
    pair = load_config("predator", overrides=["world.rollout_steps=64", "learning.minibatch_size=32"])
    make_run(RunPlan(pair, (4,), 128, folder / "pair", 1, frames=64))
    return [write_run(folder / "single *run*", intervals=5, worlds=2), folder / "pair"]


@pytest.fixture(scope="module")
def dataset(runs: list[Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("out") / "set"
    words = ["export", "dataset", *map(str, runs), "--out", str(out), "--license", "cc0-1.0", "--title", 'A "title"']
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    return out


def test_a_hub_reads_the_card(dataset: Path) -> None:
    hub: Any = pytest.importorskip("huggingface_hub")
    card = hub.DatasetCard.load(dataset / "README.md")
    assert (card.data.license, card.data.pretty_name) == ("cc0-1.0", 'A "title"')
    files = {each["config_name"]: each["data_files"] for each in card.data.to_dict()["configs"]}
    assert files == {"agents": "data/agents.parquet", "population": "data/population.parquet"}
    assert all((dataset / file).is_file() for file in files.values())
    assert "| single \\*run\\* | baseline (corrected) | 2 |" in card.text


def test_every_column_is_in_the_card_and_every_row_in_the_tables(dataset: Path, runs: list[Path]) -> None:
    card = (dataset / "README.md").read_text(encoding="utf-8")
    for table in ("agents", "population"):
        rows = pl.read_parquet(dataset / "data" / f"{table}.parquet")
        section = card.split(f"## data/{table}.parquet")[1].split("\n## ")[0]
        told = [line.split(" | ")[0].removeprefix("| ") for line in section.splitlines() if line.startswith("| ")][2:]
        assert set(told) == set(rows.columns) - {"run"}
        for path in runs:
            own = getattr(open_run(path), table)()
            mine = rows.filter(pl.col("run") == path.name).select(own.columns)
            assert mine.equals(own)


def test_checksums_and_manifests_match_the_files(dataset: Path, runs: list[Path]) -> None:
    lines = (dataset / "SHA256SUMS").read_text().splitlines()
    sums = {name: digest for digest, name in (line.split("  ", 1) for line in lines)}
    there = {path.relative_to(dataset).as_posix() for path in dataset.rglob("*") if path.is_file()}
    assert sums.keys() == there - {"SHA256SUMS"}
    for name, digest in sums.items():
        assert hashlib.sha256((dataset / name).read_bytes()).hexdigest() == digest
    manifest = json.loads((dataset / "runs/pair/manifest.json").read_text())
    assert manifest["seeds"] == [4]
    assert (dataset / "runs/pair/config.toml").read_text() == (runs[1] / "config.toml").read_text()


def test_an_impossible_dataset_is_refused(runs: list[Path], tmp_path: Path) -> None:
    opened = [open_run(path) for path in runs]
    with pytest.raises(ExportError, match="two runs are called pair"):
        write_dataset([opened[1], opened[1]], tmp_path / "set")
    with pytest.raises(ExportError, match="has no frames"):
        write_dataset(opened, tmp_path / "set", frames=True)
    assert not (tmp_path / "set").exists()
    assert len(write_dataset([opened[1]], tmp_path / "set", frames=True)) == 7
    with pytest.raises(ExportError, match="is there already"):
        write_dataset([opened[1]], tmp_path / "set")
