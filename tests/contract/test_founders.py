"""Founders given as a table: worlds start with them, and runs can be resumed, branched, repeated and checked."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from mechanism_world import mechanism_config
from worlds import QUICK

from hedon.check.run import check_run
from hedon.config import load_config
from hedon.experiment.branch import branch
from hedon.experiment.plan import RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.experiment.simulation import Simulation
from hedon.record.founder import FounderError, make_founders
from hedon.record.founder_source import living, read_founders
from hedon.record.reader import open_run

CONFIG = load_config("baseline", overrides=[*QUICK, "population.initial_count=20", "genome.neutral_count=2"])
TABLE = make_founders(
    ("w_action", "w_normal"), np.array([[1, 2], [3, 4], [-5, 6]]), ["a", "a", "b"], {"a": 0.5, "b": 0.5}
)


def test_founders_have_the_genes_of_the_table_and_draw_the_others() -> None:
    with_table, without = Simulation(CONFIG, [7]), Simulation(CONFIG, [7])
    with_table.set_founders(TABLE)
    given, drawn = (each.worlds[0].agents()["genome"] for each in (with_table, without))
    np.testing.assert_array_equal(given[:, 2:], drawn[:, 2:])
    rows = TABLE.draw(7, 20)
    np.testing.assert_array_equal(given[:, 0], TABLE.values[rows, 1])
    np.testing.assert_array_equal(given[:, 1], TABLE.values[rows, 0])
    assert (given[:, 1] == -5).sum() == 10
    for world in (with_table.worlds[0], without.worlds[0]):
        np.testing.assert_array_equal(world.agents()["energy"], 40.0)


def test_a_run_with_a_table_is_repeatable_resumable_and_checked(tmp_path: Path) -> None:
    whole = run(RunPlan(CONFIG, [1, 2], 256, tmp_path / "whole", 1, founders=TABLE))
    run(RunPlan(CONFIG, [1, 2], 128, tmp_path / "half", 1, founders=TABLE))
    resumed = resume(tmp_path / "half", 256, 1)
    assert resumed.world_digests == whole.world_digests
    config = load_config(tmp_path / "whole" / "config.toml")
    again = read_founders(str(tmp_path / "whole" / "founders.csv"), config)
    repeated = run(RunPlan(config, [1, 2], 256, tmp_path / "again", 1, founders=again))
    assert (repeated.config_digest, repeated.world_digests) == (whole.config_digest, whole.world_digests)
    plain = run(RunPlan(CONFIG, [1, 2], 256, tmp_path / "plain", 1))
    assert plain.config_digest != whole.config_digest, "another table must be another condition"
    branched = branch(tmp_path / "half", tmp_path / "branch", steps=320, threads=1)
    assert branched.status == "finished"
    for name in ("whole", "half", "branch"):
        assert not check_run(tmp_path / name).findings
    path = next((tmp_path / "whole" / "agents").glob("*.parquet"))
    rows = pl.read_parquet(path)
    rows.with_columns(pl.when(pl.col("generation") == 0).then(9.0).otherwise("w_action").alias("w_action")).cast(
        rows.schema
    ).write_parquet(path)
    assert any("are not those of founders.csv" in str(finding) for finding in check_run(tmp_path / "whole").findings)


def test_agents_alive_at_a_step_can_be_founders(tmp_path: Path) -> None:
    busy = load_config("baseline", overrides=[*QUICK, "hazard.kappa=0.5", "birth.kappa=0.02"])
    run(RunPlan(busy, [1, 2], 256, tmp_path / "old", 1))
    agents = open_run(tmp_path / "old").agents()
    then = agents.filter((pl.col("birth_step") <= 100) & ((pl.col("death_step") > 100).fill_null(True)))
    found = living(tmp_path / "old", 100, busy)
    assert 0 < len(then) < len(agents)
    np.testing.assert_array_equal(np.sort(found.values[:, 0]), then["w_normal"].sort().to_numpy())
    assert set(found.group) == {"old@100"}
    assert len(living(tmp_path / "old", None, busy).values) == agents["death_step"].null_count()
    with pytest.raises(FounderError, match="has only 256 steps"):
        living(tmp_path / "old", 257, busy)
    run(RunPlan(load_config("poison", overrides=QUICK), [1], 64, tmp_path / "poison", 1))
    with pytest.raises(FounderError, match="there is no gene 'w_poison'"):
        living(tmp_path / "poison", None, busy)


def test_genomes_of_another_shape_or_size_are_refused() -> None:
    simulation = Simulation(CONFIG, [1])
    good = simulation.worlds[0].agents()["genome"]
    for bad in (good[:-1], good[:, :-1], good + 100, np.full_like(good, np.nan)):
        with pytest.raises(ValueError, match="gen"):
            simulation.engine.set_genomes(0, np.ascontiguousarray(bad))


def test_founders_of_several_species_are_given_and_checked(tmp_path: Path) -> None:
    """A value for a gene that only one species has, a gene that names its species, and the living agents of a run."""
    config = mechanism_config("species that differ in everything")
    first: Path | None = None
    for index, source in enumerate(("normal=1", "prey.action=0.5,hunter.action=-0.5", "RUN")):
        folder = tmp_path / str(index)
        founders = read_founders(source.replace("RUN", str(first)), config)
        pinned = config.with_("world.founders", founders.digest)
        run(RunPlan(pinned, (1,), 150, folder, 1, 0, 1e9, founders))
        assert check_run(folder).findings == ()
        first = folder
    lived = open_run(tmp_path / "1").agents().filter(pl.col("death_step").is_null())
    agents = open_run(tmp_path / "2").agents().filter(pl.col("generation") == 0)
    for name in ("prey", "hunter"):
        born = agents.filter(pl.col("species") == name)["w_action"]
        assert set(born) <= set(lived.filter(pl.col("species") == name)["w_action"])
    path = next((tmp_path / "1" / "agents").glob("*.parquet"))
    edited = pl.read_parquet(path).with_columns(
        w_action=pl.when((pl.col("species") == "hunter") & (pl.col("generation") == 0)).then(1.5).otherwise("w_action")
    )
    edited.cast({"w_action": pl.Float32}).write_parquet(path)
    assert any("are not those of founders.csv" in finding.what for finding in check_run(tmp_path / "1").findings)
