"""Damaged files of a run: whatever is truncated or changed, each command carries on or reports it in one sentence.

HEDON_DAMAGED=N damages N files for each command and kind of damage instead of the default number.
"""

import os
import random
import shutil
from pathlib import Path

import polars as pl
import pytest
from split_run import record_species
from typer.testing import CliRunner

from hedon.cli.main import app
from hedon.config.problem import ConfigError
from hedon.error import HedonError
from hedon.record.folder import LOCK, part_paths

TRIALS = int(os.environ.get("HEDON_DAMAGED", "2"))

QUIET = ("--threads", "1", "--no-report")
FEW = tuple(
    f"species.{name}.population.{setting}={count}"
    for name, capacity, initial in (("prey", 60, 40), ("predator", 12, 8))
    for setting, count in (("capacity", capacity), ("initial_count", initial))
)
SMALL = tuple(word for setting in FEW for word in ("--set", setting))
COMMANDS = {
    "check": ("check", "{run}"),
    "agents": ("export", "agents", "{run}", "--out", "{out}.csv"),
    "population": ("export", "population", "{run}", "--format", "parquet", "--out", "{out}.parquet"),
    "frames": ("export", "frames", "{run}", "--format", "arrow", "--out", "{out}.arrow"),
    "phylogeny": ("export", "phylogeny", "{run}", "--out", "{out}.alife.csv"),
    "newick": ("export", "phylogeny", "{run}", "--format", "newick", "--out", "{out}.nwk"),
    "view": ("view", "{run}", "--export", "{out}-site"),
    "video": ("export", "video", "{run}", "{out}.gif", "--from", "224", "--speed", "32", "--width", "160"),
    "branch": ("branch", "{run}", "--steps", "260", "--out", "{out}-branch", *QUIET),
    "fault": ("check", "{run}", "--fault", "--threads", "1"),
    "founders": ("run", "predator", *SMALL, "--founders", "{run}", "--steps", "1", "--out", "{out}-run", *QUIET),
    "resume": ("resume", "{out}-resumed", "--steps", "260", *QUIET),
}
SLOW = {
    "report": ("report", "{run}"),
    "analyze": ("analyze", "{run}", "--out", "{out}-analysis"),
}


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    return record_species(tmp_path_factory.mktemp("damaged") / "run", seeds=(1,), overrides=FEW)


def command(name: str, run: Path, out: Path) -> str:
    """Calls a command; returns its message if it refuses, otherwise ""."""
    if name == "resume":  # it changes its run
        shutil.copytree(run, f"{out}-resumed")
    arguments = [each.format(run=run, out=out) for each in (COMMANDS | SLOW)[name]]
    done = CliRunner().invoke(app, arguments)
    error = done.exception
    if isinstance(error, HedonError) or (isinstance(error, OSError) and error.filename is not None):
        assert isinstance(error, ConfigError) or "\n" not in str(error).strip(), f"{name}: {error}"
        return str(error)
    if error is not None and not isinstance(error, SystemExit):
        raise error
    return done.output if done.exit_code or name == "view" else ""


def files(run: Path) -> list[Path]:
    return sorted(path for path in run.rglob("*") if path.is_file() and path.name != LOCK)


def cut(content: bytes, draw: random.Random) -> bytes:
    return content[: draw.choice([0, 1, len(content) // 2, len(content) - 9, len(content) - 1])]


def change(content: bytes, draw: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(draw.choice([1, 1, 8])):
        changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
    return bytes(changed)


@pytest.mark.repeated
@pytest.mark.parametrize("damage", [cut, change])
@pytest.mark.parametrize("name", COMMANDS)
def test_a_damaged_file_ends_no_command_in_a_traceback(original, tmp_path, name, damage):
    draw = random.Random(f"{name} {damage.__name__}")
    run = Path(shutil.copytree(original, tmp_path / "run"))
    for trial in range(TRIALS):
        file = draw.choice(files(run))
        content = file.read_bytes()
        file.write_bytes(damage(content, draw))
        command(name, run, tmp_path / f"{trial}")
        file.write_bytes(content)
    assert name in ("fault", "view") or command(name, run, tmp_path / "whole") == ""


@pytest.mark.parametrize("name", COMMANDS)
def test_a_part_cut_in_half_is_named(original, tmp_path, name):
    run = Path(shutil.copytree(original, tmp_path / "run"))
    for table in ("agents", "population", "frames"):
        part = part_paths(run, table)[-1]
        part.write_bytes(part.read_bytes()[: part.stat().st_size // 2])
    said = command(name, run, tmp_path / "cut")
    assert name in ("fault", "branch") or "part-000" in said  # these read only checkpoints


NEVER = {
    "world": [-1, 1, 2**31 - 1],
    "step": [-1, 257, 2**62],
    "id": [-1, 2**62],
    "agent_id": [-1, 2**62, 2**63 - 1],
    "parent_id": [-1, 2**62],
    "generation": [-1, 2**31 - 1],
    "birth_step": [-1, 2**62],
    "death_step": [-1, 2**62],
    "eaten_normal": [-1, 2**31 - 1],
    "alive": [-1, 2**31 - 1],
    "steps": [-1, 2**31 - 1],
    "kind": ["", "nobody"],
    "species": ["", "nobody"],
    "cause": ["", "bored"],
    "energy": [float("nan"), float("inf"), -1e30],
    "x": [float("nan"), 1e30],
    "angle": [float("nan"), 3e38, -3e38],
    "w_normal": [float("inf"), 1e30],
}
"""Values that a file may hold although no run writes them."""


@pytest.mark.repeated
@pytest.mark.parametrize("name", [*COMMANDS, *(pytest.param(name, marks=pytest.mark.long) for name in SLOW)])
def test_values_that_no_run_has_end_no_command_in_a_traceback(original, tmp_path, name):
    """In the first, the last or a middle row."""
    draw = random.Random(name)
    run = Path(shutil.copytree(original, tmp_path / "run"))
    for table in ("agents", "population", "frames"):
        for file in [part_paths(run, table)[-1], *(run / table).glob("living.parquet")]:
            content, rows = file.read_bytes(), pl.read_parquet(file)
            cases = [(column, value) for column in rows.columns for value in NEVER.get(column, ())]
            for i, (column, value) in enumerate(draw.sample(cases, min(TRIALS, len(cases)))):
                at = draw.choice([0, rows.height // 2, rows.height - 1])
                chosen = pl.int_range(rows.height) == at
                changed = pl.when(chosen).then(pl.lit(value, rows.schema[column])).otherwise(pl.col(column))
                rows.with_columns(changed.alias(column)).write_parquet(file, compression="zstd")
                command(name, run, tmp_path / f"{table}-{file.stem}-{i}")
            file.write_bytes(content)
