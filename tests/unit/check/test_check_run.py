"""`hedon check`: every kind of damage to a real run is named, and an untouched run passes."""

import json
import re
import shutil
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import polars as pl
import pytest
from resumed_run import small_run
from typer.testing import CliRunner

from hedon.check.run import check_run
from hedon.cli.main import app
from hedon.experiment.branch import branch
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import resume
from hedon.record.error import RecordError
from hedon.record.folder import LIVING, checkpoint_paths, part_paths

CUT, STEPS = 200, 500


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run of two worlds with frames, interrupted once, so it has several parts of each table."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    small_run(folder, CUT, frames=37)
    resume(folder, STEPS)
    return folder


@pytest.fixture
def run(whole: Path, tmp_path: Path) -> Path:
    """A copy of the whole run, to be damaged."""
    return Path(shutil.copytree(whole, tmp_path / "run"))


def findings(folder: Path) -> str:
    return "\n".join(f"{finding.where}: {finding.what}" for finding in check_run(folder).findings)


def edit_parquet(path: Path, change: Callable[[pl.DataFrame], pl.DataFrame]) -> None:
    change(pl.read_parquet(path)).write_parquet(path)


def edit_json(path: Path, **values: object) -> None:
    path.write_text(json.dumps(json.loads(path.read_text()) | values))


def flip(path: Path, at: int | None = None) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2 if at is None else at] ^= 16
    path.write_bytes(data)


def flip_number(path: Path) -> None:
    """Flips a bit of a number in the largest array of a checkpoint; elsewhere, a byte may be one that is never read."""
    with zipfile.ZipFile(path) as archive:
        largest = max(archive.infolist(), key=lambda each: each.file_size)
    flip(path, largest.header_offset + largest.file_size // 2)


@pytest.mark.smoke
def test_an_untouched_run_passes(whole: Path) -> None:
    assert check_run(whole).findings == ()
    assert replay_run(whole)[0] == ()


@dataclass(frozen=True)
class Damage:
    """A kind of damage to a folder, and what must be reported."""

    do: Callable[[Path], object]
    said: str


def agents(folder: Path) -> Path:
    return part_paths(folder, "agents")[0]


def population(folder: Path) -> Path:
    return max(part_paths(folder, "population"), key=lambda path: pl.read_parquet(path).height)


FILES = {
    "a flipped byte in a part": Damage(lambda f: flip(agents(f)), r"agents/part-000000.parquet: was changed after"),
    "a part cut short": Damage(lambda f: agents(f).write_bytes(agents(f).read_bytes()[:500]), "000000.*cannot be read"),
    "an empty part": Damage(lambda f: population(f).write_bytes(b""), r"population/part-\d+.parquet: cannot be read"),
    "a lost part": Damage(lambda f: agents(f).unlink(), "agents/part-000000.parquet: is missing"),
    "the last part lost": Damage(lambda f: part_paths(f, "frames")[-1].unlink(), "records|frames/part-.*missing"),
    "the last intervals lost": Damage(lambda f: part_paths(f, "population")[-1].unlink(), "ends at step 448, but"),
    "the living lost": Damage(lambda f: (f / LIVING).unlink(), "agents/living.parquet: is missing"),
    "a lost column": Damage(
        lambda f: edit_parquet(agents(f), lambda rows: rows.drop("children")), "these columns are missing: children"
    ),
    "a column of another type": Damage(
        lambda f: edit_parquet(agents(f), lambda rows: rows.with_columns(pl.col("energy").cast(pl.Float64))),
        "these columns have a wrong type: energy",
    ),
    "an unknown column": Damage(
        lambda f: edit_parquet(agents(f), lambda rows: rows.with_columns(x=1)), "has unknown columns: x"
    ),
    "an edited config": Damage(
        lambda f: (f / "config.toml").write_text((f / "config.toml").read_text().replace("0.05", "0.06", 1)),
        "config.toml: (was changed|cannot be used)",
    ),
    "a config that is none": Damage(lambda f: (f / "config.toml").write_text("a = ["), "config.toml: cannot be used"),
    "a lost config": Damage(lambda f: (f / "config.toml").unlink(), "config.toml: cannot be used"),
    "a lost manifest": Damage(lambda f: (f / "manifest.json").unlink(), "manifest.json: cannot be used"),
    "a manifest that is none": Damage(lambda f: (f / "manifest.json").write_text("{"), "manifest.json: cannot be used"),
    "a manifest with a wrong type": Damage(
        lambda f: edit_json(f / "manifest.json", steps_done=["many", 3]), "manifest.json: cannot be used.*steps_done"
    ),
    "a world too many": Damage(
        lambda f: edit_json(f / "manifest.json", steps_done=[500, 500, 500]), "steps_done has 3 entries"
    ),
    "steps that were not made": Damage(
        lambda f: edit_json(f / "manifest.json", steps_done=[500, 450]), "ends at step 500, but the manifest has"
    ),
    "more steps than asked for": Damage(
        lambda f: edit_json(f / "manifest.json", steps_asked=300),
        "steps_done is 500, but must be from 0 to steps_asked = 300",
    ),
    "another config digest": Damage(
        lambda f: edit_json(f / "manifest.json", config_digest="0" * 64), "config.toml: was changed"
    ),
    "another digest of records": Damage(
        lambda f: edit_json(f / "manifest.json", records_digest="0" * 64), "records: rows were changed"
    ),
    "no digest of records": Damage(
        lambda f: edit_json(f / "manifest.json", records_digest=None), "manifest.json: has no digest"
    ),
    "another digest of a world": Damage(
        lambda f: edit_json(f / "manifest.json", world_digests=["0" * 16, "1" * 16]), "digests of the worlds"
    ),
    "other seeds": Damage(
        lambda f: edit_json(f / "manifest.json", seeds=[1, 3]), "its seeds are not those|the seed is not the one"
    ),
    "a damaged checkpoint": Damage(
        lambda f: flip_number(checkpoint_paths(f)[-1]), r"checkpoints/step-0+500.npz: cannot be"
    ),
    "a checkpoint of another run": Damage(
        lambda f: shutil.move(checkpoint_paths(f)[0], f / "checkpoints/step-0000000123.npz"), "0000000123.npz: cannot"
    ),
    "a damaged snapshot": Damage(lambda f: (f / "final.npz").write_bytes(b"PK"), "final.npz: cannot be used"),
}


@pytest.mark.parametrize("damage", FILES.values(), ids=FILES.keys())
def test_damage_to_files_is_named(run: Path, damage: Damage) -> None:
    damage.do(run)
    assert re.search(damage.said, findings(run)), findings(run)


def change_first(**values: pl.Expr) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Changes columns in the first row."""
    return lambda rows: pl.concat([rows.head(1).with_columns(**values).cast(rows.schema), rows.tail(-1)])


def change_child(**values: pl.Expr) -> Callable[[pl.DataFrame], pl.DataFrame]:
    """Changes columns in the first row of an agent that has a parent."""

    def change(rows: pl.DataFrame) -> pl.DataFrame:
        row = rows.with_row_index().drop_nulls("parent_id")["index"][0]
        parts = [rows.head(row), rows[row].with_columns(**values).cast(rows.schema), rows.tail(-row - 1)]
        return pl.concat(parts)

    return change


AGENTS = {
    "a removed row": (lambda rows: rows.tail(-1), "1 agents are missing"),
    "a row twice": (lambda rows: pl.concat([rows, rows.head(1)]), "more than one row has this id"),
    "an id twice": (
        lambda rows: change_first(agent_id=pl.lit(rows["agent_id"][1], pl.Int64))(rows),
        "more than one row has this id",
    ),
    "its own parent": (change_child(parent_id=pl.col("agent_id")), "is its own ancestor: (\\d+) → \\1"),
    "a parent yet to be born": (change_child(parent_id=pl.lit(10**6)), "its parent is itself or a younger agent"),
    "a parent that is not there": (
        lambda rows: change_child(parent_id=pl.lit(rows["agent_id"].min()))(
            rows.filter(pl.col("agent_id") != rows["agent_id"].min())
        ),
        "its parent is missing",
    ),
    "a parent below zero": (change_child(parent_id=pl.lit(-5)), "parent_id = -5: must be from 0"),
    "an id beyond all": (change_first(agent_id=pl.lit(2**62)), "4,611,686,018,427,387,[0-9]+ agents are missing"),
    "another parent": (change_child(parent_id=(pl.col("parent_id") + 1) % 2), "its number of children is not"),
    "another generation": (change_child(generation=pl.col("generation") + 1), "its generation is not one more"),
    "a founder with a past": (change_child(parent_id=pl.lit(None)), "has no parent but is not a founder"),
    "death before birth": (
        change_first(death_step=pl.col("birth_step") - 1),
        "died before its birth or in the same step",
    ),
    "a life after the end": (change_first(death_step=pl.lit(10_000)), "born or died after the last step"),
    "another time of death": (
        change_first(death_step=pl.col("death_step") + 1),
        "does not agree with the table agents|after its parent",
    ),
    "a birth before the parent's": (
        change_child(birth_step=pl.lit(0)),
        "was born before its parent or in the same step",
    ),
    "a child too many": (change_first(children=pl.col("children") + 1), "its number of children is not"),
    "energy below zero": (change_first(energy=pl.lit(-1.0)), "has negative energy"),
    "not a number": (change_first(distance=pl.lit(float("nan"))), "1 values of distance are missing or not finite"),
    "a value lost": (change_first(distance=pl.lit(None)), "1 values of distance are missing or not finite"),
    "a world too many": (change_first(world=pl.lit(7)), "the run has no such world"),
    "another seed": (change_first(seed=pl.lit(7)), "the seed is not the one in the manifest"),
    "a meal too many": (change_first(eaten_normal=pl.col("eaten_normal") + 1), "the agents ate"),
    "another weight": (change_first(w_normal=pl.col("w_normal") + 1), "records: rows were changed"),
}

POPULATION = {
    "a removed row": (lambda rows: rows.tail(-2), "a gap before the interval"),
    "a row twice": (lambda rows: pl.concat([rows, rows.tail(1)]), "the row is repeated"),
    "rows out of order": (lambda rows: rows.reverse(), "the row is repeated or out of order"),
    "another step": (change_first(step=pl.col("step") + 1), "a gap before the interval"),
    "an empty interval": (change_first(steps=pl.lit(0)), "the interval has no length"),
    "a birth too many": (change_first(births=pl.col("births") + 1), "alive does not agree with births and deaths"),
    "births and deaths alike": (
        change_first(births=pl.col("births") + 1, deaths=pl.col("deaths") + 1),
        "births does not agree with the table agents",
    ),
    "one alive too many": (change_first(alive=pl.col("alive") + 1), "alive does not agree with the table agents"),
    "steps of agents": (
        change_first(agent_steps=pl.col("agent_steps") + 1),
        "agent_steps does not agree with the table agents",
    ),
    "energy from nowhere": (
        change_first(energy_eaten=pl.col("energy_eaten") + 1e-3),
        "energy ledger does not close",
    ),
    "energy lost": (change_first(energy_total=pl.col("energy_total") - 1e-3), "energy ledger does not close"),
    "a meal too many": (change_first(eaten_normal=pl.col("eaten_normal") + 1), "the agents ate"),
    "a count below zero": (change_first(deaths=pl.lit(-1)), "alive, births or deaths is negative"),
}

CASES = [("agents", name, *case) for name, case in AGENTS.items()]
CASES += [("population", name, *case) for name, case in POPULATION.items()]


@pytest.mark.parametrize(
    ("table", "change", "said"), [case[:1] + case[2:] for case in CASES], ids=[c[1] for c in CASES]
)
def test_damage_to_rows_is_named_also_without_checkpoints(
    run: Path, table: str, change: Callable[[pl.DataFrame], pl.DataFrame], said: str
) -> None:
    path = agents(run) if table == "agents" else population(run)
    edit_parquet(path, change)
    assert re.search(
        f"{path.parent.name}/{path.name}: was changed after it was written|records: rows were changed", findings(run)
    )
    shutil.rmtree(run / "checkpoints")
    assert re.search(said, findings(run)), findings(run)


def test_a_cycle_of_several_ancestors_is_reported(run: Path) -> None:
    def close(rows: pl.DataFrame) -> pl.DataFrame:
        child = rows.drop_nulls("parent_id").row(0, named=True)
        is_parent = (pl.col("world") == child["world"]) & (pl.col("agent_id") == child["parent_id"])
        new = pl.when(is_parent).then(child["agent_id"]).otherwise(pl.col("parent_id"))
        return rows.with_columns(parent_id=new)

    for path in [*part_paths(run, "agents"), run / LIVING]:
        edit_parquet(path, close)
    assert re.search(r"an agent is its own ancestor: (\d+) → (\d+ → )+\1", findings(run))


def test_usable_files_are_listed(run: Path) -> None:
    flip(part_paths(run, "agents")[-1], at=4)
    usable = "\n".join(check_run(run).usable)
    assert re.search(r"^agents: (\d+) of (?!\1)\d+ files are undamaged", usable)
    assert re.search(r"population: (\d+) of \1 files are undamaged", usable)
    assert "checkpoint of step 200: `hedon branch --at 200`" in usable or "`hedon resume` can continue" in usable
    assert check_run(run).notes == ()


def test_a_run_that_was_killed_before_its_first_checkpoint_is_not_damaged(run: Path) -> None:
    """It has a config and a manifest; the living are written just before a checkpoint."""
    edit_json(run / "manifest.json", status="running", ended=None, world_digests=[], records_digest=None)
    for folder in ("agents", "population", "frames", "checkpoints"):
        shutil.rmtree(run / folder)
        (run / folder).mkdir()
    assert findings(run) == ""


def test_a_branch_and_a_killed_run_pass(run: Path, tmp_path: Path) -> None:
    branch(run, tmp_path / "branch", ["food.normal.growth_rate=0.05"], steps=700)
    assert check_run(tmp_path / "branch").findings == ()
    assert replay_run(tmp_path / "branch")[0] == ()
    edit_json(run / "manifest.json", status="running", ended=None, world_digests=[], records_digest=None)
    part_paths(run, "population")[-1].unlink()
    for path in checkpoint_paths(run)[1:]:
        path.unlink()
    verdict = check_run(run)
    assert verdict.findings == ()
    assert any("is still running, or was killed" in note for note in verdict.notes)


def test_a_replay_finds_rows_that_were_not_simulated(run: Path) -> None:
    """Rows that agree with each other and with their digest, but come from no simulation."""
    from hedon.record.digest import records_digest
    from hedon.record.manifest import load_manifest

    edit_parquet(run / LIVING, change_first(w_normal=pl.col("w_normal") + 1))
    manifest = load_manifest(run)
    digest = records_digest(run, manifest.columns)
    edit_json(run / "manifest.json", records_digest=digest)
    assert findings(run) == ""
    assert "rows differ" in replay_run(run)[0][0].what


def test_a_folder_without_a_run_is_refused(tmp_path: Path) -> None:
    for folder, problem in ((tmp_path, "is not a run folder"), (tmp_path / "nowhere", "does not exist")):
        with pytest.raises(RecordError, match=problem):
            check_run(folder)


def test_exit_codes_of_the_command(whole: Path, run: Path, tmp_path: Path) -> None:
    flip(agents(run))
    answer = CliRunner().invoke(app, ["check", str(whole)])
    assert (answer.exit_code, "no problems" in answer.output) == (0, True)
    answer = CliRunner().invoke(app, ["check", str(whole), str(run)])
    assert (answer.exit_code, "was changed after it was written" in answer.output) == (1, True)
    answer = CliRunner().invoke(app, ["check", str(tmp_path), str(run)])
    assert (answer.exit_code, "is not a run folder" in answer.output) == (2, True)
    assert CliRunner().invoke(app, ["check", "--replay", str(whole)]).exit_code == 0
