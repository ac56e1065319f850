import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from synthetic_run import synthetic_snapshot, write_run

from hedon.record.error import RecordError
from hedon.record.manifest import Manifest, load_manifest, save_manifest
from hedon.record.provenance import collect_provenance, git_revision
from hedon.record.reader import open_run
from hedon.record.schema import Columns, agent_table, run_tables
from hedon.record.snapshot import load_snapshot, save_snapshot


def test_names_follow_the_genome() -> None:
    assert Columns(("normal", "poison"), 2).gene_names == (
        "w_normal",
        "w_poison",
        "w_action",
        "neutral_1",
        "neutral_2",
    )
    names = [column.name for column in agent_table(Columns(("normal", "poison"), 2)).columns]
    assert names[-5:] == ["w_normal", "w_poison", "w_action", "neutral_1", "neutral_2"]
    assert names.index("eaten_normal") + 1 == names.index("eaten_poison")


def test_every_column_is_documented() -> None:
    for table in run_tables(Columns(("normal",), 1)).values():
        assert all(column.meaning for column in table.columns)


def test_a_food_kind_that_repeats_a_column_is_refused() -> None:
    with pytest.raises(RecordError, match="w_action appear twice"):
        run_tables(Columns(("action",), 1))


def test_weights_split_into_rewards_and_neutral_genes(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=1, food_kinds=("normal", "poor"), neutral_count=2)
    run = open_run(folder)
    assert run.reward_names == ("w_normal", "w_poor", "w_action")
    assert run.neutral_names == ("neutral_1", "neutral_2")


def test_manifest_round_trip(tmp_path: Path) -> None:
    manifest = Manifest(
        food_kinds=("normal",),
        neutral_count=1,
        seeds=(1, 2),
        steps_asked=100,
        extinct_steps=(None, 50),
        **collect_provenance(),
    )
    save_manifest(tmp_path, manifest)
    assert load_manifest(tmp_path) == manifest
    assert manifest.python is not None
    assert manifest.started is not None
    assert manifest.started.endswith("+00:00")


def test_manifest_faults_are_named(tmp_path: Path) -> None:
    manifest = Manifest(food_kinds=("normal",), neutral_count=1, seeds=(1,), steps_asked=100)
    with pytest.raises(RecordError, match="status 'done' is not one of"):
        replace(manifest, status="done")
    with pytest.raises(RecordError, match="cannot write the manifest"):
        save_manifest(tmp_path / "nowhere", manifest)
    with pytest.raises(RecordError, match="cannot read the manifest"):
        load_manifest(tmp_path)
    save_manifest(tmp_path, manifest)
    path = tmp_path / "manifest.json"
    values = json.loads(path.read_text())
    path.write_text(json.dumps(values | {"later": 1}))
    assert load_manifest(tmp_path) == manifest
    path.write_text(json.dumps({name: value for name, value in values.items() if name not in ("name", "modified")}))
    assert load_manifest(tmp_path).modified is None
    path.write_text(json.dumps(values | {"format_version": 99}))
    with pytest.raises(RecordError, match="update hedon"):
        load_manifest(tmp_path)
    path.write_text(path.read_text()[:40])
    with pytest.raises(RecordError, match="damaged manifest"):
        load_manifest(tmp_path)


def test_revision_outside_of_a_checkout(tmp_path: Path) -> None:
    assert git_revision(tmp_path) == (None, None)


def test_the_error_for_a_folder_without_a_run_suggests_the_nearest(tmp_path: Path) -> None:
    write_run(tmp_path / "runs" / "baseline", intervals=1, worlds=1)
    (empty_folder := tmp_path / "elsewhere" / "empty").mkdir(parents=True)
    with pytest.raises(RecordError, match=r"does not exist; did you mean .*runs.baseline\?"):
        open_run(tmp_path / "runs" / "basline")
    with pytest.raises(RecordError, match=r"not a run folder.*did you mean .*runs.baseline\?"):
        open_run(tmp_path / "runs")
    with pytest.raises(RecordError, match=r"did you mean .*runs.baseline\?"):
        open_run(tmp_path / "runs" / "baseline" / "agents")
    with pytest.raises(RecordError, match=r"x does not exist$"):
        open_run(tmp_path / "elsewhere" / "x")
    with pytest.raises(RecordError, match=r"not a run folder: it has no manifest.json$"):
        open_run(empty_folder)


def test_a_run_without_config_is_named(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=1, worlds=1)
    (folder / "config.toml").unlink()
    with pytest.raises(RecordError, match=r"config\.toml"):
        open_run(folder)


def test_a_folder_may_have_any_name(tmp_path: Path) -> None:
    """Characters that are wildcards elsewhere are ordinary ones here."""
    name = "[1, 2] #!" if os.name == "nt" else "[1, 2] *?"  # Windows allows neither * nor ?
    plain, strange = (open_run(write_run(tmp_path / each, intervals=2, worlds=1)) for each in ("run", name))
    assert strange.damaged_parts() == []
    assert strange.agents().equals(plain.agents())
    assert strange.population().equals(plain.population())


def test_a_damaged_part_is_named_and_the_others_are_read(tmp_path: Path) -> None:
    folder = write_run(tmp_path / "run", intervals=20, worlds=2)
    run = open_run(folder)
    whole, living = run.agents(), run.agents()["death_step"].null_count()
    assert run.damaged_parts() == []
    part = folder / "agents/part-000000.parquet"
    part.write_bytes(part.read_bytes()[:-100])
    with pytest.raises(RecordError, match="part-000000"):
        run.agents()
    assert run.agents(skip_damaged=True).height == living < whole.height
    assert run.damaged_parts() == [part]


def test_frames_are_empty_without_frames(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", intervals=1, worlds=1))
    assert run.frames().collect().height == 0


def test_snapshot_round_trip(tmp_path: Path) -> None:
    assert load_snapshot(tmp_path) is None
    snapshot = synthetic_snapshot(("normal", "poor"))
    save_snapshot(tmp_path, snapshot)
    again = load_snapshot(tmp_path)
    assert again is not None
    assert again.food_kinds == ("normal", "poor")
    assert (again.step, again.radius) == (snapshot.step, 10.0)
    np.testing.assert_array_equal(again.rays, snapshot.rays)


def test_snapshot_faults_are_named(tmp_path: Path) -> None:
    snapshot = synthetic_snapshot()
    with pytest.raises(RecordError, match="energy has shape"):
        replace(snapshot, energy=snapshot.energy[:-1])
    with pytest.raises(RecordError, match="cannot write"):
        save_snapshot(tmp_path / "nowhere", snapshot)
    (tmp_path / "final.npz").write_bytes(b"no archive")
    with pytest.raises(RecordError, match="damaged snapshot"):
        load_snapshot(tmp_path)
