"""Slots as environments of Stable-Baselines3, tested by its own checker and training, and against the arrays."""

import warnings
from typing import Any

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, env, load_config, make

REASON = "needs 5 GB that the project does not install: pip install stable-baselines3"
library: Any = pytest.importorskip("stable_baselines3", reason=REASON)
checker: Any = pytest.importorskip("stable_baselines3.common.env_checker", reason=REASON)
vector: Any = pytest.importorskip("stable_baselines3.common.vec_env", reason=REASON)
torch: Any = pytest.importorskip("torch", reason=REASON)

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=30", "population.initial_count=20")
CONFIG = load_config("baseline", overrides=LIVELY)


def test_its_checker_finds_nothing_wrong():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(env.AgentEnv(CONFIG))


def test_an_episode_is_a_life():
    """The reward and the length of an episode are those of the life in the engine; empty slots have no episode."""
    slots, rng = env.SlotVecEnv(make(CONFIG, 2, seed=3, threads=1)), np.random.default_rng(0)
    group, simulation = slots.group, slots.worlds.simulation
    assert slots.reset().shape == (60, 95)
    paid, lives, empty = np.zeros(60), {}, 0
    ids = group.ids.ravel().copy()
    for _ in range(120):
        seen, rewards, dones, infos = slots.step(rng.uniform(-1, 1, (60, 2)).astype(np.float32))
        np.testing.assert_array_equal(seen, group.observations.reshape(60, 95))
        paid += rewards
        changed = group.ids.ravel() != ids
        np.testing.assert_array_equal(dones, changed & (ids >= 0))
        assert all(("episode" in info) == done for info, done in zip(infos, dones, strict=True))
        empty += (ids < 0).sum()
        for i in np.flatnonzero(dones):
            assert infos[i]["terminal_observation"].shape == (95,)
            assert not infos[i]["terminal_observation"].any()
            assert not infos[i]["TimeLimit.truncated"]
            assert infos[i]["episode"]["r"] == pytest.approx(paid[i], abs=1e-9)
            lives[i // 30, ids[i]] = paid[i], infos[i]["episode"]["l"]
            paid[i] = 0
        assert [info["alive"] for info in infos] == group.alive.ravel().tolist()
        ids = group.ids.ravel().copy()
    assert len(lives) > 20
    assert empty > 20
    for world in simulation.worlds:
        rows = world.deaths()
        columns = (rows[name].tolist() for name in ("agent_id", "reward", "birth_step", "death_step"))
        for identity, reward, born, died in zip(*columns, strict=True):
            paid_in_life, steps = lives.pop((world.index, identity))
            assert paid_in_life == pytest.approx(reward, rel=1e-4, abs=1e-6)
            assert steps == died - born
    assert not lives


@pytest.mark.parametrize(("alpha", "max_steps"), [(0.01, 25), (1.0, 0)], ids=["time", "everyone"])
def test_worlds_restart_when_time_is_up_or_all_agents_are_dead(alpha, max_steps):
    brief = CONFIG.with_("hazard.alpha_age", alpha).with_("birth.kappa", 0.0)
    slots = env.SlotVecEnv(make(brief, 3, seed=5, max_steps=max_steps, threads=1))
    slots.reset()
    nothing = np.zeros((90, 2), np.float32)
    extinct = cut = 0
    for step in range(1, 80):
        before = [world.seed for world in slots.worlds.simulation.worlds]
        left = slots.group.alive.copy()
        _, _, dones, infos = slots.step(nothing)
        for i, world in enumerate(slots.worlds.simulation.worlds):
            mine, told = dones[30 * i : 30 * i + 30], infos[30 * i : 30 * i + 30]
            if world.seed == before[i]:
                assert world.step > 0
                continue
            assert world.seed not in before
            assert world.step == 0
            assert world.alive == 20
            np.testing.assert_array_equal(mine, left[i])
            late = [info.get("TimeLimit.truncated", False) for info in told]
            assert sum(late) <= left[i].sum()
            cut += any(late)
            extinct += not any(late)
            last = [
                info["terminal_observation"].any() if done else over
                for info, done, over in zip(told, mine, late, strict=True)
            ]
            assert last == late
        assert slots.group.alive.any(axis=1).all(), step
    assert (cut > 5, extinct > 5) == (bool(max_steps), not max_steps)


def test_it_trains_and_the_trained_policy_acts():
    worlds = make(CONFIG, 2, seed=1, repeat=4, max_steps=200, threads=1)
    slots = vector.VecNormalize(vector.VecMonitor(env.SlotVecEnv(worlds)), norm_reward=False)
    model = library.PPO("MlpPolicy", slots, n_steps=32, batch_size=480, n_epochs=1, seed=1, device="cpu").learn(60 * 64)
    before = model.policy.state_dict()["action_net.weight"].clone()
    model.learn(60 * 32, reset_num_timesteps=False)
    assert not torch.equal(before, model.policy.state_dict()["action_net.weight"])
    actions, _ = model.predict(slots.normalize_obs(worlds.observations.reshape(60, 95)))
    assert (np.abs(actions) <= 1).all()
    worlds.step(actions)


def test_seeds_are_those_that_a_library_gives():
    slots = env.SlotVecEnv(make(CONFIG, 2, seed=1, threads=1))
    slots.seed(40)
    slots.reset()
    assert slots.worlds.simulation.seeds == (40, 41)
    slots.reset()
    later = slots.worlds.simulation.seeds
    assert len({40, 41, *later}) == 4
    slots.seed(40)
    slots.reset()
    slots.reset()
    assert slots.worlds.simulation.seeds == later


def test_features_that_slots_lack_are_named():
    slots: Any = env.SlotVecEnv(make(CONFIG, 2))
    assert slots.get_attr("repeat", [0, 3]) == [1, 1]
    assert slots.env_is_wrapped(vector.VecMonitor) == [False] * 60
    with pytest.raises(ArgumentError, match="repeat: slots have no attributes of their own"):
        slots.set_attr("repeat", 2)
    with pytest.raises(ArgumentError, match="render: slots have no methods of their own"):
        slots.env_method("render")
    with pytest.raises(ArgumentError, match="worlds: must drive one species, not prey, predator"):
        env.SlotVecEnv(make("predator"))


def test_tensors_share_the_memory_of_the_arrays():
    worlds = make(CONFIG, 2, seed=1, threads=1)
    seen, rewards = torch.from_numpy(worlds.observations), torch.from_numpy(worlds.rewards)
    actions, alive = torch.from_numpy(worlds.actions), torch.from_numpy(worlds.alive)
    layer = torch.nn.Linear(seen.shape[-1], 2)
    for _ in range(3):
        with torch.no_grad():
            torch.tanh(layer(seen), out=actions)
        worlds.step(worlds.actions)
        assert seen.data_ptr() == worlds.observations.ctypes.data
        np.testing.assert_array_equal(rewards[alive].numpy(), worlds.rewards[worlds.alive])
    told = worlds.simulation.worlds[0].view("external_action")[worlds.simulation.worlds[0].living]
    assert told.any()
