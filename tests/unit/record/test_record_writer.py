import os
import threading
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from synthetic_run import INTERVAL, SyntheticWorld, population_rows, write_run

from hedon.config import load_config
from hedon.record.error import RecordError
from hedon.record.folder import LIVING, holds_run, part_paths
from hedon.record.manifest import Manifest
from hedon.record.reader import open_run
from hedon.record.schema import Columns, agent_table, columns_of, run_tables
from hedon.record.writer import Writer

MANIFEST = Manifest(food_kinds=("normal",), neutral_count=1, seeds=(1,), steps_asked=10_000)


def test_rows_read_back_unchanged(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7)
    rows = [world.step()[1] for _ in range(5)]
    living = world.living_rows()
    with Writer(tmp_path / "run", "x = 1\n", MANIFEST) as writer:
        writer.append("population", population_rows(rows))
        writer.replace_living(living)
    run = open_run(tmp_path / "run")
    agents, population = run.agents(), run.population()
    assert agents.schema == run_tables(Columns(("normal",), 1))["agents"].polars_schema
    assert population["energy_total"].to_list() == [row["energy_total"] for row in rows]
    assert agents["death_step"].null_count() == agents.height == len(living["agent_id"])
    assert agents["parent_id"].null_count() == int((living["parent_id"] == -1).sum())
    np.testing.assert_array_equal(agents["w_normal"].to_numpy(), living["w_normal"])
    assert run.config_text == "x = 1\n"


def test_caller_may_reuse_its_arrays(tmp_path: Path) -> None:
    rows = population_rows([SyntheticWorld(0, 7).step()[1]])
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.append("population", rows)
        rows["alive"][:] = 99
    assert 99 not in open_run(tmp_path / "run").population()["alive"].to_list()


def test_parts_are_written_when_full_and_none_is_lost(tmp_path: Path) -> None:
    rows = population_rows([SyntheticWorld(0, 7).step()[1]] * 10)
    with Writer(tmp_path / "run", "", MANIFEST, part_rows=25, queue_size=2) as writer:
        for i in range(20):
            writer.append("population", rows | {"step": np.full(10, i)})
    assert len(part_paths(tmp_path / "run", "population")) == 7  # 6 of 30 rows, the rest at the end
    steps = open_run(tmp_path / "run").population()["step"].to_list()
    assert steps == [i for i in range(20) for _ in range(10)]


def test_a_reader_sees_rows_during_the_run(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7)
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.append("population", population_rows([world.step()[1]]))
        writer.replace_living(world.living_rows())
        run, deadline = open_run(tmp_path / "run"), time.monotonic() + 10
        while run.population().is_empty() or run.agents().is_empty():
            assert time.monotonic() < deadline
            time.sleep(0.01)


def test_flush_returns_once_everything_is_on_disk(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7)
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.append("agents", world.step()[0])
        writer.replace_living(world.living_rows())
        writer.flush()
        assert open_run(tmp_path / "run").agents().height >= 50


def test_an_agent_that_died_counts_once(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7, birth_factor=0.0)
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.replace_living(world.living_rows())
        dead, _ = world.step()
        assert len(dead["agent_id"]) > 0
        writer.append("agents", dead)
        writer.replace_living(world.living_rows())
        writer.flush()
        agents = open_run(tmp_path / "run").agents()
    assert sorted(agents["agent_id"]) == list(range(50))
    assert agents["death_step"].is_not_null().sum() == len(dead["agent_id"])


def test_a_reader_sees_a_single_moment(tmp_path: Path) -> None:
    """Deaths written after the living are not seen until the next living are; otherwise births would be missing."""
    world = SyntheticWorld(0, 7)
    with Writer(tmp_path / "run", "", MANIFEST, part_rows=1) as writer:
        writer.replace_living(world.living_rows())
        for _ in range(5):
            dead, _ = world.step()
            writer.append("agents", dead)
            writer.flush()  # as happens with a full part or a checkpoint
            before = set(open_run(tmp_path / "run").agents()["agent_id"])
            assert before == set(range(len(before))), "an agent is missing"
            writer.replace_living(world.living_rows())
            writer.flush()
            agents = open_run(tmp_path / "run").agents()
            assert sorted(agents["agent_id"]) == list(range(agents.height))
            assert set(agents.filter(pl.col("death_step").is_null())["agent_id"]) == set(
                world.living_rows()["agent_id"].tolist()
            )


def test_a_folder_that_is_removed_or_replaced_is_noticed_at_once(tmp_path: Path) -> None:
    writer = Writer(tmp_path / "run", "", MANIFEST)
    writer.require_folder()
    (tmp_path / "run").rename(tmp_path / "moved")
    with pytest.raises(RecordError, match="was removed or replaced during the run"):
        writer.require_folder()
    (tmp_path / "run" / "agents").mkdir(parents=True)
    with pytest.raises(RecordError, match="was removed or replaced"):
        writer.save_manifest(MANIFEST)
    with pytest.raises(RecordError, match="was removed or replaced"):
        writer.close()
    assert [path.name for path in (tmp_path / "run").rglob("*")] == ["agents"], "nothing is written to the new folder"


def test_a_folder_that_vanishes_between_the_check_and_the_write_is_reported_the_same_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = Writer(tmp_path / "run", "", MANIFEST)

    def vanish() -> None:
        (tmp_path / "run").rename(tmp_path / "moved")
        raise FileNotFoundError

    monkeypatch.setattr(writer._parts, "flush", vanish)
    with pytest.raises(RecordError, match="was removed or replaced during the run"):
        writer.flush()


def test_refuses_a_folder_that_holds_a_run(tmp_path: Path) -> None:
    write_run(tmp_path / "run", intervals=1, worlds=1)
    before = sorted(path.stat().st_mtime_ns for path in (tmp_path / "run").rglob("*"))
    with pytest.raises(RecordError, match="already holds a run"):
        Writer(tmp_path / "run", "", MANIFEST)
    assert sorted(path.stat().st_mtime_ns for path in (tmp_path / "run").rglob("*")) == before


def test_a_file_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "run").write_text("not a folder")
    with pytest.raises(RecordError, match="cannot write the run's folder"):
        Writer(tmp_path / "run", "", MANIFEST)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows | {"colour": rows["alive"]}, r"unknown columns \['colour'\]"),
        (lambda rows: {k: v for k, v in rows.items() if k != "alive"}, r"missing columns \['alive'\]"),
        (lambda rows: rows | {"alive": rows["alive"][:1]}, "the same length"),
        (lambda rows: rows | {"alive": rows["alive"][None]}, "one dimension"),
        (lambda rows: rows | {"alive": rows["alive"] + 2**40}, "alive needs integers of type i32"),
        (lambda rows: rows | {"alive": rows["alive"] + 0.5}, "alive needs integers"),
        (lambda rows: rows | {"energy_eaten": np.array(["a", "b"])}, "energy_eaten needs numbers"),
    ],
)
def test_rows_that_do_not_fit_are_refused(tmp_path: Path, change, message: str) -> None:
    world = SyntheticWorld(0, 7)
    rows = population_rows([world.step()[1], world.step()[1]])
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        with pytest.raises(RecordError, match=message):
            writer.append("population", change(rows))
        with pytest.raises(RecordError, match="no table 'agent'"):
            writer.append("agent", rows)


def test_scalars_and_left_out_nullable_columns(tmp_path: Path) -> None:
    rows = {"world": 0, "step": 5, "kind": "normal", "x": np.ones(3), "y": np.arange(3.0)}
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.append("frames", rows)
    frames = open_run(tmp_path / "run").frames().collect()
    assert frames["step"].to_list() == [5, 5, 5]
    assert frames["id"].null_count() == frames["angle"].null_count() == 3


def test_an_error_in_the_thread_reaches_the_caller_and_earlier_parts_stay(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7)
    rows = population_rows([world.step()[1]])
    writer = Writer(tmp_path / "run", "", MANIFEST, part_rows=1)
    writer.append("population", rows)
    writer.flush()
    (tmp_path / "run/population/part-000001.parquet").mkdir()  # in the way of the next part
    (tmp_path / "run/population/part-000001.parquet/x").touch()
    writer.append("population", rows)
    with pytest.raises(RecordError, match=r"cannot write records to .*run"):
        writer.flush()
    with pytest.raises(RecordError, match="cannot write records"):
        writer.append("population", rows)
    for _ in range(200):  # more than the queue holds: nothing may hang
        writer._queue.put(("population", pl.DataFrame()))
    with pytest.raises(RecordError, match="cannot write records"):
        writer.close()
    writer.close()
    run = open_run(tmp_path / "run")
    with pytest.raises(RecordError, match=r"damaged part .*part-000001"):
        run.population()
    assert run.population(skip_damaged=True).height == 1
    assert [path.name for path in run.damaged_parts()] == ["part-000001.parquet"]
    assert not list((tmp_path / "run").rglob("*.tmp"))


def test_a_full_disk_leaves_no_torn_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = population_rows([SyntheticWorld(0, 7).step()[1]])

    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    writer = Writer(tmp_path / "run", "", MANIFEST, part_rows=1)
    monkeypatch.setattr(os, "fsync", full)
    writer.append("population", rows)
    with pytest.raises(RecordError, match="No space left on device"):
        writer.close()
    assert not list((tmp_path / "run/population").iterdir())


def test_leaving_the_context_raises_the_error_only_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = population_rows([SyntheticWorld(0, 7).step()[1]])

    def run() -> None:
        with Writer(tmp_path / "run", "", MANIFEST, part_rows=1) as writer:
            monkeypatch.setattr(os, "fsync", lambda descriptor: 1 / 0)
            writer.append("population", rows)
            writer.flush()

    with pytest.raises(RecordError) as caught:
        run()
    assert not isinstance(caught.value.__context__, RecordError)


def test_waiting_rows_are_written_even_after_an_error_in_the_run(tmp_path: Path) -> None:
    rows = population_rows([SyntheticWorld(0, 7).step()[1]])
    writer = Writer(tmp_path / "run", "", MANIFEST)

    def run() -> None:
        with writer:
            writer.append("population", rows)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run()
    assert open_run(tmp_path / "run").population().height == 1
    with pytest.raises(RecordError, match="is closed"):
        writer.append("population", rows)


def test_a_reader_never_sees_a_torn_file(tmp_path: Path) -> None:
    world = SyntheticWorld(0, 7)
    living = world.living_rows()
    faults: list[Exception] = []
    stop = threading.Event()
    with Writer(tmp_path / "run", "", MANIFEST, part_rows=1) as writer:

        def read() -> None:
            run = open_run(tmp_path / "run")
            while not stop.is_set():
                try:
                    assert run.agents().height in (0, len(living["agent_id"]))
                except Exception as error:  # checked below, in the main thread
                    faults.append(error)

        reader = threading.Thread(target=read)
        reader.start()
        for _ in range(40):
            writer.replace_living(living)
            writer.flush()
        stop.set()
        reader.join()
    assert faults == []


def test_manifest_is_replaced(tmp_path: Path) -> None:
    with Writer(tmp_path / "run", "", MANIFEST) as writer:
        writer.save_manifest(replace(MANIFEST, status="failed"))
    assert open_run(tmp_path / "run").manifest.status == "failed"
    assert holds_run(tmp_path / "run")


def test_a_million_steps_take_less_than_30_megabytes(tmp_path: Path) -> None:
    write_run(tmp_path / "run", intervals=200, worlds=1)
    size = sum(path.stat().st_size for path in (tmp_path / "run").rglob("*.parquet"))
    assert (tmp_path / "run" / LIVING).stat().st_size < 100_000
    assert size * 1e6 / (200 * INTERVAL) < 30e6


def test_every_gene_has_a_description() -> None:
    genes = [
        "reward.family=between",
        "reward.gate=age",
        "reward.drive_reduction_coef=1.0",
        "genome.learning.gamma.initial_sd=0.1",
        "reward.pay.see_wall.coef=0.1",
        "reward.pay.child.channel=births",
    ]
    table = agent_table(columns_of(load_config("baseline", overrides=genes)))
    meaning = {column.name: column.meaning for column in table.columns}
    assert meaning["w_normal"] == "reward weight for a food of kind normal"
    assert meaning["w_normal_old"] == "reward weight when old, beside w_normal"
    assert meaning["w_child"] == "reward weight for child"
    assert meaning["w_see_wall"] == "reward weight for seeing wall"
    assert meaning["set_point"] == "energy that is sought, as a share of the capacity"
    assert meaning["g_gamma"] == "power of ten by which the odds of the discount differ"
