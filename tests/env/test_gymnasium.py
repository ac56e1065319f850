"""Gymnasium's ids, vector environments and wrappers, and a program for any of its environments."""

import importlib.util
import pickle
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, load_config, make

pytest.importorskip("gymnasium", reason='needs the optional packages: pip install "hedon[env]"')
import gymnasium
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers import vector as wrappers

from hedon.config.load import PRESETS
from hedon.env import AgentEnv, AgentVectorEnv, SlotVectorEnv

LIVELY = [*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=30", "population.initial_count=20"]
CONFIG = load_config("baseline", overrides=LIVELY)


@pytest.mark.parametrize("imports", ["gymnasium, hedon", "hedon, gymnasium", "hedon, gymnasium.spaces, gymnasium"])
def test_every_preset_has_an_id(imports):
    program = f"import {imports}, sys; print(sorted(gymnasium.registry)); print('hedon.env' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert all(f"'hedon/{preset}-v0'" in said for preset in PRESETS)
    assert said.endswith("False\n"), "registering loads nothing else"


def test_an_id_makes_the_life_of_one_agent():
    env = gymnasium.make("hedon/baseline-v0", overrides=LIVELY, seed=3)
    assert isinstance(env.unwrapped, AgentEnv)
    assert env.spec is not None
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(minimum|maximum) value is|.*symmetric|.*render")
        check_env(env.unwrapped, skip_render_check=True)
    short = gymnasium.make("hedon/predator-v0", species="prey", max_episode_steps=5)
    short.reset(seed=1)
    ends = [short.step(short.action_space.sample())[3] for _ in range(5)]
    assert ends == [False] * 4 + [True]


def test_a_vector_of_lives_equals_single_lives_up_to_their_ends():
    envs = gymnasium.make_vec("hedon/baseline-v0", num_envs=3, overrides=LIVELY)
    assert isinstance(envs, AgentVectorEnv)
    single = [AgentEnv(CONFIG) for _ in range(3)]
    rows, _ = envs.reset(seed=5)
    alone = [env.reset(seed=5 + i)[0] for i, env in enumerate(single)]
    np.testing.assert_array_equal(rows, alone)
    assert rows.shape == envs.observation_space.shape
    lives, follows, ends = np.ones(3, np.bool_), np.zeros(3, np.bool_), 0
    envs.action_space.seed(1)
    for _ in range(400):
        actions = envs.action_space.sample()
        rows, rewards, died, cut, infos = envs.step(actions)
        assert rows in envs.observation_space
        assert not cut.any()
        for i in np.flatnonzero(lives).tolist():
            row, reward, over, _, told = single[i].step(actions[i])
            assert (reward, over, told["agent_id"]) == (rewards[i], died[i], infos["agent_id"][i])
            np.testing.assert_array_equal(row, rows[i])
        assert not rewards[follows].any()
        assert not died[follows].any(), "a life that has just begun"
        assert rows[follows].any(axis=1).all()
        follows, ends = died, ends + int(died.sum())
        lives &= ~died
    assert not lives.any(), "all of the first lives ended"
    assert ends > 3, "and others followed"
    with pytest.raises(ArgumentError, match=r"actions: must be numbers of shape \(3, 2\), not \(3,\)"):
        envs.step(np.zeros(3))


def test_a_time_limit_ends_the_lives_of_a_vector():
    envs = AgentVectorEnv(CONFIG, 2, seed=1, max_steps=7)
    with pytest.raises(ArgumentError, match="call reset first"):
        envs.step(np.zeros((2, 2)))
    envs.reset()
    immortal = [*QUICK, "hazard.kappa=0", "hazard.alpha_age=0"]
    envs = AgentVectorEnv("baseline", 2, seed=1, max_steps=7, overrides=immortal)
    seeds = [world.seed for world in envs.worlds.simulation.worlds]
    envs.reset()
    for step in range(1, 17):
        _, _, died, cut, _ = envs.step(np.zeros((2, 2)))
        assert not died.any()
        assert cut.tolist() == [step in (7, 15)] * 2, "seven steps, and one in which it begins again"
    assert seeds != [world.seed for world in envs.worlds.simulation.worlds]


@pytest.mark.parametrize("repeat", [1, 3])
def test_a_slot_is_an_environment_whose_episodes_are_lives(repeat):
    worlds = make(CONFIG, 2, seed=1, repeat=repeat)
    envs = SlotVectorEnv(worlds)
    rows, infos = envs.reset(seed=9)
    assert (rows.shape, envs.num_envs) == (envs.observation_space.shape, 60)
    paid, lived = {}, {}
    envs.action_space.seed(2)
    for _ in range(150):
        rows, rewards, died, cut, infos = envs.step(envs.action_space.sample())
        assert not (died & cut).any()
        assert not rows[died].any()
        for i in np.flatnonzero(infos.get("_life", np.zeros(60, np.bool_))).tolist():
            who = (i // 30, int(envs.group.ids_before.ravel()[i]))
            paid[who], lived[who] = infos["life"]["r"][i], infos["life"]["l"][i]
        assert rewards[~infos["alive"] & ~died].sum() == 0
    for index, world in enumerate(worlds.simulation.worlds):
        rows = world.deaths()
        mine = [i for i, who in enumerate(rows["agent_id"]) if (index, int(who)) in paid]
        assert len(mine) > 5
        for i in mine:
            who = (index, int(rows["agent_id"][i]))
            if repeat == 1:
                assert lived[who] == rows["death_step"][i] - rows["birth_step"][i]
                assert paid[who] == pytest.approx(rows["reward"][i], rel=1e-4, abs=1e-5)


def vector_env(kind: str):
    return AgentVectorEnv(CONFIG, 4) if kind == "agent" else SlotVectorEnv(make(CONFIG, 2, max_steps=50))


@pytest.mark.parametrize("kind", ["agent", "slot"])
def test_wrappers_of_gymnasium_accept_it(kind):
    envs = vector_env(kind)
    for wrapper in (
        wrappers.RecordEpisodeStatistics,
        wrappers.NormalizeObservation,
        wrappers.NormalizeReward,
        wrappers.ClipAction,
        wrappers.DictInfoToList,
    ):
        envs = wrapper(envs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rows, _ = envs.reset(seed=1)
        episodes = 0
        for _ in range(120):
            rows, rewards, _, _, infos = envs.step(3 * envs.action_space.sample())
            assert np.isfinite(rows).all()
            assert np.isfinite(rewards).all()
            assert len(infos) == envs.num_envs
            episodes += sum("episode" in info for info in infos)
    assert episodes > 0
    envs.close()


@pytest.mark.parametrize("kind", ["agent", "slot"])
def test_copies_and_pickles_continue_alike(kind):
    envs = vector_env(kind)
    envs.reset(seed=4)
    envs.action_space.seed(4)
    actions = [envs.action_space.sample() for _ in range(60)]
    for action in actions[:20]:
        envs.step(action)
    others = [envs.clone(), pickle.loads(pickle.dumps(envs))]
    for action in actions[20:]:
        seen = envs.step(action)[0]
        for other in others:
            np.testing.assert_array_equal(other.step(action)[0], seen)


@pytest.mark.more
def test_a_program_for_any_environment_of_gymnasium_trains_in_hedon():
    pytest.importorskip("jax")
    place = Path(__file__).parents[2] / "examples" / "vector_ppo.py"
    spec = importlib.util.spec_from_file_location("vector_ppo", place)
    assert spec is not None
    assert spec.loader is not None
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    for env_id in ("hedon/appetite-v0", "Pendulum-v1"):
        assert len(program.train(env_id, 2, 64, 2, 1)) == 2
