"""Several futures of one world: they start alike and diverge, and one matches the future of the world itself."""

from pathlib import Path

import polars as pl
import pytest
from cuda_emulation import emulated as emulated
from resumed_run import assert_same_run, small_run

import hedon
from hedon.check.run import check_run
from hedon.config.load import load_config
from hedon.error import ArgumentError
from hedon.experiment.branch import branch
from hedon.experiment.plan import RunPlan
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.record.manifest import load_manifest
from hedon.record.reader import open_run
from hedon.report.run import write_report

AT, STEPS = 300, 500
PREDATORS = ("world.rollout_steps=64", "learning.minibatch_size=32")


@pytest.fixture(scope="module")
def past(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two worlds, up to the step from which one of them has several futures."""
    folder = tmp_path_factory.mktemp("past") / "run"
    small_run(folder, AT, frames=37)
    return folder


@pytest.fixture(scope="module")
def futures(past: Path) -> Path:
    """Three futures of the world with seed 2: its own and two others."""
    branch(past, past.with_name("futures"), steps=STEPS, seeds=(2, 50, 51), of=2)
    return past.with_name("futures")


def test_the_future_with_the_worlds_own_seed_is_its_own(past: Path, futures: Path) -> None:
    branch(past, past.with_name("own"), steps=STEPS)
    own, ends = load_manifest(past.with_name("own")).world_digests[1], load_manifest(futures).world_digests
    assert ends[0] == own
    assert len({own, *ends}) == 3, "the futures do not all differ"


def test_futures_begin_with_the_same_agents(past: Path, futures: Path) -> None:
    agents = open_run(futures).agents()
    begun = agents.filter(pl.col("birth_step") <= AT).sort("world", "agent_id")
    parts = begun.select("world", "agent_id", "parent_id", "birth_step", r"^(w|neutral)_.*$").partition_by("world")
    first = parts[0].drop("world")
    assert first.height > 3
    assert all(part.drop("world").equals(first) for part in parts)
    before = open_run(past).agents().filter(pl.col("world") == 1, pl.col("death_step").is_null())
    assert set(first["agent_id"]) == set(before["agent_id"])
    born = agents.filter(pl.col("birth_step") > AT).group_by("world").agg(pl.col("birth_step").sort())
    assert born["birth_step"].n_unique() == born.height


@pytest.mark.more
def test_futures_are_checked_replayed_resumed_and_reported(futures: Path, tmp_path: Path) -> None:
    manifest = load_manifest(futures)
    assert manifest.parent is not None
    assert (manifest.parent.seed, manifest.parent.step, manifest.seeds) == (2, AT, (2, 50, 51))
    assert check_run(futures).findings == ()
    findings, said = replay_run(futures)
    assert findings == ()
    assert "computed again from step" in said
    write_report(open_run(futures), folder=tmp_path / "report", figures="none")
    said = "The worlds of futures are futures of one world (seed 2 of run) from step 300 on. They share its past"
    assert said in (tmp_path / "report" / "report.md").read_text(encoding="utf-8")
    whole = branch(futures.with_name("run"), tmp_path / "whole", steps=STEPS + 100, seeds=(2, 50, 51), of=2)
    branch(futures.with_name("run"), tmp_path / "half", steps=STEPS, seeds=(2, 50, 51), of=2)
    assert resume(tmp_path / "half", steps=STEPS + 100).world_digests == whole.world_digests
    assert_same_run(tmp_path / "whole", tmp_path / "half")


def test_worlds_of_several_species_have_futures(tmp_path: Path) -> None:
    config = load_config("predator", overrides=PREDATORS)
    run(RunPlan(config, (4,), 200, tmp_path / "run", 1))
    ends = branch(tmp_path / "run", tmp_path / "futures", steps=400, seeds=(4, 5)).world_digests
    assert ends[0] == resume(tmp_path / "run", steps=400).world_digests[0]
    assert ends[1] != ends[0]
    assert check_run(tmp_path / "futures").findings == ()


@pytest.mark.more
def test_a_device_has_the_same_futures(
    emulated: str, past: Path, futures: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HEDON_BACKEND", emulated)
    made = branch(past, past.with_name("device"), steps=AT + 60, seeds=(2, 50), of=2)
    monkeypatch.delenv("HEDON_BACKEND")
    assert made.world_digests == branch(past, past.with_name("here"), steps=AT + 60, seeds=(2, 50), of=2).world_digests


@pytest.mark.parametrize(
    ("seeds", "of", "says"),
    [
        ((1, 2), None, "of = None: the run has several worlds: name one of the seeds 1, 2"),
        ((1, 2), 9, "of = 9: the run has no such world of the seeds 1, 2"),
        (None, 1, "of = 1: names the world that has several futures: give their seeds, too"),
        ((5, 5), 1, "seeds.*5"),
    ],
)
def test_impossible_futures_are_refused(past: Path, seeds: tuple[int, ...] | None, of: int | None, says: str) -> None:
    with pytest.raises(ArgumentError, match=says):
        branch(past, past.with_name("never"), steps=STEPS, seeds=seeds, of=of)
    assert not past.with_name("never").exists()


def test_reseeding_a_simulation_changes_only_its_future(past: Path) -> None:
    config = open_run(past).config

    def begun() -> hedon.Simulation:
        simulation = hedon.Simulation(config, [1, 2], threads=1)
        simulation.run(AT)
        return simulation

    alone, same, other = begun(), begun(), begun()
    same.reseed([1, 2])
    other.reseed([1, 50])
    digests = [[world.digest() for world in each.worlds] for each in (alone, same, other)]
    assert digests[0] == digests[1] == digests[2], "reseeding changed the present state"
    for each in (alone, same, other):
        each.run(STEPS - AT)
    assert [world.digest() for world in same.worlds] == [world.digest() for world in alone.worlds]
    assert other.worlds[0].digest() == alone.worlds[0].digest()
    assert other.seeds == (1, 50)
    assert other.worlds[1].digest() == load_manifest(past.with_name("futures")).world_digests[1]


def test_worlds_with_obstacles_have_one_future(tmp_path: Path) -> None:
    config = load_config("pitfall", overrides=PREDATORS)
    simulation = hedon.Simulation(config, [1])
    with pytest.raises(ArgumentError, match="reseed: the places of obstacles follow from a world's seed"):
        simulation.reseed([2])
    run(RunPlan(config, (1,), 64, tmp_path / "run", 1))
    with pytest.raises(ArgumentError, match="seeds: the places of obstacles follow from a world's seed"):
        branch(tmp_path / "run", steps=128, seeds=(1, 2))
