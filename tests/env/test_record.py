"""Records of driven worlds: the folder of a run, which everything that reads runs accepts."""

from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import polars as pl
import pytest
from command import hedon
from worlds import QUICK

from hedon import ArgumentError, RecordError, load_config, make, open_run
from hedon.check import check_run
from hedon.env import AgentEnv, AgentVectorEnv, ParallelEnv, SlotVectorEnv
from hedon.experiment.replay import replay_run
from hedon.record.reader import Run
from hedon.report import write_report
from hedon.report.analysis import analyze, write_analysis
from hedon.view.index import RunIndex

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=30", "population.initial_count=20")
CONFIG = load_config("baseline", overrides=LIVELY)
PAIR = load_config("predator", overrides=QUICK)


def drive(out: Path, config: Any, steps: int, **options: Any) -> list[str]:
    rng = np.random.default_rng(0)
    with make(config, 2, seed=4, threads=1, record=out, frames=8, **options) as worlds:
        worlds.reset()
        for _ in range(steps):
            for group in worlds.groups.values():
                group.actions[...] = rng.uniform(-1, 1, group.actions.shape)
            worlds.step(worlds.actions)
        return [world.digest() for world in worlds.simulation.worlds]


@pytest.mark.parametrize(
    ("config", "species", "repeat"),
    [
        pytest.param(CONFIG, None, 1, marks=pytest.mark.long),
        pytest.param(CONFIG, None, 3, marks=pytest.mark.long),
        (PAIR, "predator", 2),
    ],
)
def test_a_folder_of_records_is_a_run(config, species, repeat, tmp_path):
    out = tmp_path / "run"
    digests = drive(out, config, 200 // repeat, species=species, repeat=repeat)
    run = open_run(out)
    steps = 200 // repeat * repeat
    assert run.manifest.status == "finished"
    assert (run.manifest.steps_done, run.manifest.steps_asked) == ((steps, steps), steps)
    assert list(run.manifest.world_digests) == digests
    found = check_run(out).findings
    assert not found, [f"{each.where}: {each.what}" for each in found]
    assert replay_run(out) == ((), "not computed again: another program told its agents what to do")
    frames = run.frames().collect()
    assert sorted(set(frames["step"])) == list(range(8, steps + 1, 8))
    agents = run.agents()
    assert agents.filter(pl.col("death_step").is_not_null()).height > 3
    rows = run.population()
    assert sorted(set(rows["step"])) == [64, 128, 192, *([steps] if steps > 192 else [])]
    assert rows["births"].sum() == agents.filter(pl.col("birth_step") > 0).height
    write_analysis(analyze([run]), tmp_path / "analysis")
    assert all(file.stat().st_size for file in write_report(run, folder=tmp_path / "report"))
    assert RunIndex(out).describe()["status"] == "finished"


def test_records_change_nothing(tmp_path):
    plain, rng = make(CONFIG, 2, seed=4, threads=1), np.random.default_rng(0)
    for _ in range(150):
        plain.step(rng.uniform(-1, 1, plain.actions.shape))
    assert drive(tmp_path / "run", CONFIG, 150) == [world.digest() for world in plain.simulation.worlds]


def test_every_death_is_recorded_however_many_die(tmp_path):
    few = CONFIG.with_("population.initial_count", 8).with_("population.capacity", 10)
    crowd = few.with_("birth.kappa", 1.0).with_("hazard.alpha_age", 0.2).with_("energy.initial", 40.0)
    drive(tmp_path / "run", crowd, 300, repeat=1)
    run = open_run(tmp_path / "run")
    dead = run.agents().filter(pl.col("death_step").is_not_null()).height
    assert dead == run.population()["deaths"].sum() > 16 * 10
    assert not check_run(tmp_path / "run").findings


def test_a_folder_can_be_read_while_its_worlds_continue(tmp_path):
    out = tmp_path / "run"
    worlds = make(CONFIG, seed=1, threads=1, record=out, repeat=64)
    worlds.step(worlds.actions)
    assert open_run(out).manifest.status == "running"
    assert open_run(out).population()["step"].to_list() == [64]
    with pytest.raises(RecordError, match="is in use by another run"):
        make(CONFIG, record=out)
    with pytest.raises(ArgumentError, match="worlds that are recorded only go on or begin again"):
        worlds.restore(worlds.save())
    other = worlds.clone()
    other.step(other.actions)  # is not recorded
    worlds.close()
    worlds.close()
    assert open_run(out).manifest.steps_done == (64,)
    assert not check_run(out).findings


def test_a_run_of_a_driver_cannot_be_resumed_and_says_so(tmp_path):
    drive(tmp_path / "run", CONFIG, 10)
    for words in (("resume", tmp_path / "run"), ("branch", tmp_path / "run", "--steps", 100)):
        refused = hedon(*words)
        assert refused.returncode == 2
        assert "worlds that a program drove, and only such a program can go on" in " ".join(refused.stderr.split())
    done = hedon("check", tmp_path / "run")
    assert done.returncode == 0, done.stderr


def test_no_advice_names_a_command_that_cannot_continue(tmp_path):
    killed = make(CONFIG, seed=1, threads=1, record=tmp_path / "killed")
    killed.step(killed.actions)
    told = hedon("check", tmp_path / "killed")
    assert "is still running, or was killed" in " ".join(told.stdout.split())
    assert "resume" not in told.stdout + told.stderr
    assert str(open_run(tmp_path / "killed")).count(" of 2,147") == 0
    killed.close()
    drive(tmp_path / "run", CONFIG, 64)
    (tmp_path / "run" / "population" / "part-000000.parquet").write_bytes(b"")
    broken = hedon("check", tmp_path / "run")
    assert broken.returncode == 1
    assert "resume" not in broken.stdout + broken.stderr
    assert "branch" not in broken.stdout + broken.stderr


def test_only_the_records_take_the_dead(tmp_path):
    with make(CONFIG, seed=1, threads=1, record=tmp_path / "run") as worlds:
        (world,) = worlds.simulation.worlds
        with pytest.raises(ArgumentError, match="deaths: the world is recorded, and its records take them"):
            world.deaths()
        assert not len(worlds.clone().simulation.worlds[0].deaths()["agent_id"])  # a copy has no records
    with pytest.raises(ArgumentError, match=r"step: the records in .* are closed"):
        worlds.step(worlds.actions)


def test_wrong_arguments_of_records_are_named(tmp_path):
    wrong: Any = make
    for says, options in {
        "frames = 5: give record": {"frames": 5},
        "frames = -1: must be": {"frames": -1, "record": tmp_path / "a"},
        "record = 5: must be the path of a folder": {"record": 5},
        "seeds: 3 appears twice": {"record": tmp_path / "b", "worlds": 2, "seed": [3, 3]},
    }.items():
        with pytest.raises(ArgumentError, match=says):
            wrong(CONFIG, **options)
    assert not list(tmp_path.iterdir())


def runs_of(folder: Path) -> list[Run]:
    """The runs of one environment, in the order in which they began."""
    found = [open_run(each) for each in sorted(folder.iterdir()) if (each / "manifest.json").is_file()]
    return sorted(found, key=lambda run: (len(run.path.name), run.path.name))


def assert_sound(runs: list[Run]) -> None:
    for run in runs:
        assert run.manifest.status == "finished"
        assert check_run(run.path).findings == ()
        rows, agents = run.population(), run.agents()
        assert rows["births"].sum() == agents.filter(pl.col("birth_step") > 0).height
        assert rows["deaths"].sum() == agents["death_step"].count()
        assert rows["steps"].sum() == sum(run.manifest.steps_done) * max(len(run.columns.species), 1)


def test_each_life_of_an_agent_is_a_separate_run(tmp_path):
    mortal = CONFIG.with_("hazard.alpha_age", 0.05)
    env, rng = AgentEnv(mortal, seed=9, record=tmp_path / "run", frames=4), np.random.default_rng(1)
    lengths = []
    for seed in (3, None, None):
        env.reset(seed=seed)
        over, steps = False, 0
        while not over:
            _, _, died, cut, _ = env.step(rng.uniform(-1, 1, 2).astype(np.float32))
            over, steps = died or cut, steps + 1
        lengths.append(steps)
    env.reset()  # starts no run, as no step follows
    env.close()
    runs = runs_of(tmp_path)
    assert [run.path.name for run in runs] == ["run", "run-run2", "run-run3"]
    assert [run.manifest.steps_done for run in runs] == [(steps,) for steps in lengths]
    assert runs[0].manifest.seeds == (3,)
    assert len({run.manifest.seeds for run in runs}) == 3
    assert_sound(runs)
    assert write_report(runs[1], folder=tmp_path / "report", figures="none")


def test_worlds_that_restart_one_by_one_are_separate_runs(tmp_path):
    def drive_both(**record: Any) -> Any:
        envs, rng = AgentVectorEnv(CONFIG, 3, seed=5, max_steps=90, threads=1, **record), np.random.default_rng(2)
        envs.reset(seed=8)
        digests: dict[int, str] = {}
        for _ in range(200):
            over = envs._over.copy()
            worlds = envs.worlds.simulation.worlds
            before = {world.seed: world.digest() for world in worlds if over[world.index]}
            envs.step(rng.uniform(-1, 1, (3, 2)).astype(np.float32))
            digests |= before
        digests |= {world.seed: world.digest() for world in envs.worlds.simulation.worlds}
        envs.close()
        return envs, digests

    _, plain = drive_both()
    _, recorded = drive_both(record=tmp_path / "run")
    assert recorded == plain
    runs = runs_of(tmp_path)
    assert runs[0].manifest.seeds == (8, 9, 10)
    assert len(runs) > 3, "some agents died before the time limit"
    assert_sound(runs)
    kept = {seed for run in runs for seed in run.manifest.seeds}
    assert kept == set(plain)


@pytest.mark.parametrize("kind", ["parallel", "slots", "masks"])
def test_records_of_every_environment_are_runs(tmp_path, kind):
    rng, record = np.random.default_rng(3), {"record": tmp_path / "run", "frames": 16}
    if kind == "parallel":
        env = ParallelEnv(CONFIG, seed=2, max_steps=70, **record)
        for _ in range(2):
            env.reset()
            while env.agents:
                env.step({name: rng.uniform(-1, 1, 2).astype(np.float32) for name in env.agents})
        env.close()
    elif kind == "slots":
        slots = SlotVectorEnv(make(CONFIG, 2, seed=2, max_steps=70, **record))
        slots.reset(seed=4)
        for _ in range(160):
            slots.step(rng.uniform(-1, 1, (slots.num_envs, 2)).astype(np.float32))
        slots.close()
    else:
        with make(PAIR, 4, seed=2, threads=1, **record) as worlds:
            for _ in range(150):
                mask = rng.random(4) < 0.05
                if mask.any():
                    worlds.reset(options={"reset_mask": mask})
                worlds.step(worlds.actions)
    runs = runs_of(tmp_path)
    assert len(runs) >= 2
    assert_sound(runs)


def test_a_gymnasium_id_takes_a_folder(tmp_path):
    env = gymnasium.make("hedon/small-v0", record=str(tmp_path / "run"))
    env.reset(seed=1)
    env.step(env.action_space.sample())
    env.close()
    assert open_run(tmp_path / "run").manifest.steps_done == (1,)
