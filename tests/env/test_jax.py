"""Worlds inside JAX programs, compared with a plain loop over the same worlds."""

import copy
import gc
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, HedonError, env, load_config, make, open_run
from hedon.check import check_run

jax: Any = pytest.importorskip("jax", reason='needs the optional package: pip install "hedon[jax]"')

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=12", "population.initial_count=8")
CONFIG = load_config("baseline", overrides=LIVELY)
PAIR = load_config("predator", overrides=QUICK)
STEPS = 40


def act(weights: Any, seen: Any) -> Any:
    """A policy that uses no function that NumPy and XLA compute differently."""
    return np.float32(0.5) * (seen[..., :2] + weights).clip(-1, 1)


def rollout(worlds: Any, weights: Any, steps: int = STEPS) -> Any:
    """Starts worlds and advances them in a scan; returns first observations, results of all steps, and final states."""

    def advance(carry: Any, key: Any) -> Any:
        seen, state = carry
        keys = jax.random.split(key, len(seen))
        seen, state, paid, done, info = jax.vmap(worlds.step)(keys, state, act(weights, seen))
        return (seen, state), (seen, state.agent_id, paid, done, info["terminated"], info["alive"])

    @jax.jit
    def program(key: Any) -> Any:
        begin, go_on = jax.random.split(key)
        count = len(worlds.simulation.worlds)
        seen, state = jax.vmap(worlds.reset)(jax.random.split(begin, count))
        (_, state), told = jax.lax.scan(advance, (seen, state), jax.random.split(go_on, steps))
        return seen, told, state

    seen, told, state = jax.block_until_ready(program(jax.random.key(3)))
    return np.asarray(seen), [np.asarray(each) for each in told], state


def seeds_of(keys: Any) -> list[int]:
    data = np.asarray(jax.random.key_data(keys)).astype(np.uint64)
    return [(int(high) & 0x7FFFFFFF) << 32 | int(low) for high, low in data]


@pytest.mark.parametrize(
    ("config", "species", "count", "repeat", "max_steps"),
    [(CONFIG, None, 3, 1, 0), (CONFIG, None, 1, 1, 0), (CONFIG, None, 2, 3, 45), (PAIR, "predator", 2, 2, 0)],
)
def test_a_scan_is_a_plain_loop(config, species, count, repeat, max_steps):
    worlds = env.JaxEnv(config, count, species, repeat=repeat, max_steps=max_steps, threads=1)
    weights = np.linspace(-0.4, 0.4, 2, dtype=np.float32)
    first, (seen, ids, paid, done, died, alive), _ = rollout(worlds, weights)
    begin, go_on = jax.random.split(jax.random.key(3))
    plain = make(config, count, seeds_of(jax.random.split(begin, count)), species, repeat=repeat, threads=2)
    group = next(iter(plain.groups.values()))
    np.testing.assert_array_equal(first, plain.observations)
    ends = deaths = 0
    for i, key in enumerate(jax.random.split(go_on, STEPS)):
        plain.step(act(weights, plain.observations))
        np.testing.assert_array_equal(paid[i], plain.rewards)
        np.testing.assert_array_equal(died[i], group.terminated)
        steps = np.array([world.step for world in plain.simulation.worlds])
        over = ~group.alive.any(axis=1) | (bool(max_steps) & (steps >= max_steps))
        np.testing.assert_array_equal(done[i], over)
        deaths += group.terminated.sum()
        ends += over.sum()
        seeds = seeds_of(jax.random.split(key, count))
        for w in np.flatnonzero(over):
            plain.simulation.engine.reset(int(w), seeds[w])
        if over.any():
            plain._open(over)
        np.testing.assert_array_equal(seen[i], plain.observations)
        np.testing.assert_array_equal(ids[i], group.ids)
        np.testing.assert_array_equal(alive[i], group.alive)
    mine, theirs = ([world.digest() for world in each.simulation.worlds] for each in (worlds, plain))
    assert mine == theirs
    assert (ends > 0) == bool(max_steps)
    assert deaths > 0 or species


def test_worlds_restart_when_no_agent_is_left():
    doomed = CONFIG.with_("hazard.alpha_age", 1.0).with_("birth.kappa", 0.0)
    worlds = env.JaxEnv(doomed, 2, threads=1)
    _, (_, ids, _, done, died, alive), _ = rollout(worlds, np.zeros(2, np.float32))
    assert done.sum() > 4
    assert died.any()
    for i, w in zip(*np.nonzero(done), strict=True):
        assert alive[i, w].sum() == 8
        assert set(ids[i, w][alive[i, w]]) == set(range(8)), "ids in a new world start at 0"


def test_a_seed_gives_the_same_program_on_any_number_of_threads():
    told = [rollout(env.JaxEnv(CONFIG, 3, threads=threads), np.ones(2, np.float32)) for threads in (1, 2)]
    for mine, theirs in zip(told[0][1], told[1][1], strict=True):
        np.testing.assert_array_equal(mine, theirs)


def test_a_stale_state_is_an_error_by_its_name():
    worlds = env.JaxEnv(CONFIG, threads=1)
    step, key = jax.jit(worlds.step), jax.random.key(0)
    action = np.zeros((12, 2), np.float32)
    _, first = jax.jit(worlds.reset)(key)
    _, second, *_ = step(key, first, action)
    with pytest.raises(Exception, match=r"hedon: stale state: a later step or reset has used its worlds"):
        jax.block_until_ready(step(key, first, action))
    jax.block_until_ready(step(key, second, action))  # the worlds are as they were
    assert worlds.simulation.worlds[0].step == 2


def test_states_of_other_worlds_are_refused():
    worlds, others = (env.JaxEnv(CONFIG, 2, threads=1) for _ in range(2))
    keys = jax.random.split(jax.random.key(0), 2)
    action = np.zeros((2, 12, 2), np.float32)
    (_, state), (_, foreign) = (jax.vmap(each.reset)(keys) for each in (worlds, others))
    swapped = state._replace(agent_id=state.agent_id[:, ::-1])
    for wrong, says in ((foreign, "stale state"), (swapped, "agent_id: is not that of the state")):
        with pytest.raises(Exception, match=f"hedon: {says}"):
            jax.block_until_ready(jax.vmap(worlds.step)(keys, wrong, action))
    assert [world.step for world in worlds.simulation.worlds] == [0, 0]
    jax.block_until_ready(jax.vmap(worlds.step)(keys, state, action))


@pytest.mark.parametrize(
    ("part", "change"),
    [
        ("agent_id", lambda each: each[:1]),
        ("agent_id", lambda each: each.astype(np.float32)),
        ("turn", lambda each: each.astype(np.int32)),
        ("world", lambda each: each[None]),
    ],
)
def test_states_of_another_shape_or_type_are_refused(part, change):
    worlds = env.JaxEnv(CONFIG, threads=1)
    _, state = worlds.reset(jax.random.key(0))
    wrong = state._replace(**{part: change(getattr(state, part))})
    with pytest.raises(ArgumentError, match=rf"state\.{part}: must be u?int32 of shape"):
        worlds.step(jax.random.key(1), wrong, jax.numpy.zeros((12, 2)))


def test_no_traceback_follows_an_error_that_was_caught():
    env.JaxEnv(CONFIG)  # compiles the call, which prints a message
    program = """
import jax, numpy as np
from hedon import env
worlds = env.JaxEnv("baseline", overrides=["population.capacity=12", "population.initial_count=8"])
key, action = jax.random.key(0), np.zeros((12, 2), np.float32)
_, state = jax.jit(worlds.reset)(key)
step = jax.jit(worlds.step)
jax.block_until_ready(step(key, state, action))
try:
    jax.block_until_ready(step(key, state, action))
except Exception as error:
    print("stale state" in str(error))
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout.strip(), ended.stderr) == (0, "True", "")


def test_what_is_wrong_is_named_and_changes_nothing():
    worlds = env.JaxEnv(CONFIG, 2, threads=1)
    keys = jax.random.split(jax.random.key(0), 2)
    _, state = jax.vmap(worlds.reset)(keys)
    slot = int(np.flatnonzero(np.asarray(state.agent_id)[1] >= 0)[0])
    wrong = np.zeros((2, 12, 2), np.float32)
    wrong[1, slot, 1] = 1.5
    before = [world.digest() for world in worlds.simulation.worlds]
    with pytest.raises(Exception, match=rf"hedon: action\[1, {slot}, 1\] = 1\.5: is not an action"):
        jax.block_until_ready(jax.vmap(worlds.step)(keys, state, wrong))
    alone = jax.tree.map(lambda each: each[0], state)
    with pytest.raises(Exception, match=r"hedon: called for 1 worlds, and there are 2: use jax\.vmap"):
        jax.block_until_ready(worlds.step(keys[0], alone, wrong[0] * 0))
    swapped = jax.tree.map(lambda each: each[::-1], state)
    with pytest.raises(Exception, match="hedon: the states are not in the order of the worlds"):
        jax.block_until_ready(jax.vmap(worlds.step)(keys, swapped, wrong * 0))
    with pytest.raises(ArgumentError, match=r"action: must be of shape \(12, 2\), not \(3, 2\)"):
        worlds.step(keys[0], state, jax.numpy.zeros((3, 2)))
    assert [world.digest() for world in worlds.simulation.worlds] == before
    with pytest.raises(ArgumentError, match="species: must be one of prey, predator"):
        env.JaxEnv("predator")


def test_a_program_whose_worlds_are_gone_says_so():
    worlds = env.JaxEnv(CONFIG, threads=1)
    program = jax.jit(worlds.reset)
    jax.block_until_ready(program(jax.random.key(0)))
    del worlds.simulation
    gc.collect()
    with pytest.raises(Exception, match="hedon: the worlds are gone: keep the environment"):
        jax.block_until_ready(program(jax.random.key(1)))


def test_a_state_knows_nothing_of_other_worlds():
    one, other = env.JaxEnv(CONFIG, threads=1), env.JaxEnv(CONFIG, threads=1)
    key = jax.random.key(0)
    _, mine = one.reset(key)
    _, theirs = other.reset(key)
    action = jax.numpy.zeros((12, 2), jax.numpy.float32)
    seen = [np.asarray(each.step(key, state, action)[0]) for each, state in ((one, mine), (other, theirs))]
    np.testing.assert_array_equal(seen[0], seen[1])


def test_without_a_compiler_it_says_so(monkeypatch, tmp_path):
    from hedon.env import jax as module

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.delenv("CXX", raising=False)
    monkeypatch.setattr("shutil.which", lambda name: None)
    with pytest.raises(HedonError, match="needs a C\\+\\+ compiler on first use, and finds none"):
        module._library()
    monkeypatch.setenv("CXX", "false")
    with pytest.raises(HedonError, match="cannot compile"):
        module._library()


@pytest.mark.long
def test_a_policy_that_was_trained_in_a_scan_forages_better_than_chance():
    """The example, with fewer generations."""
    spec = spec_from_file_location("scan", Path(__file__).parents[2] / "examples" / "scan.py")
    assert spec is not None
    assert spec.loader is not None
    scan = module_from_spec(spec)
    spec.loader.exec_module(scan)
    trained, random = scan.Trainer().compare(generations=4)
    assert trained.mean() > 1.5 * random.mean() > 0


@pytest.mark.parametrize("actions", ["unit", "force", "logit"])
def test_spaces_match_what_functions_take_and_return(actions):
    worlds = env.JaxEnv("baseline", actions=actions, overrides=["population.capacity=7", "population.initial_count=3"])
    like = make(worlds.simulation.config, actions=actions)
    observations, _ = worlds.reset(jax.random.key(0))
    assert worlds.observation_space().shape == observations.shape == (7, len(worlds.columns))
    assert worlds.observation_space().dtype == observations.dtype
    assert worlds.observation_space().contains(np.asarray(observations))
    assert worlds.action_space().shape == (worlds.slots, 2)
    assert (worlds.action_space().low == like.action_space.low[0]).all()
    assert (worlds.action_space().high == like.action_space.high[0]).all()


def test_a_population_under_one_key_lives_in_worlds_that_begin_alike():
    worlds = env.JaxEnv(CONFIG, 3, threads=1)

    def live(key: Any, weights: Any) -> Any:
        begin, go_on = jax.random.split(key)

        def advance(carry: Any, key: Any) -> Any:
            seen, state = carry
            seen, state, paid, *_ = worlds.step(key, state, act(weights, seen))
            return (seen, state), (seen, paid)

        return jax.lax.scan(advance, worlds.reset(begin), jax.random.split(go_on, STEPS))[1]

    population = np.linspace(-0.5, 0.5, 6, dtype=np.float32).reshape(3, 2)
    key = jax.random.key(5)
    seen, paid = jax.jit(jax.vmap(live, in_axes=(None, 0)))(key, population)
    (seed,) = seeds_of(jax.random.split(key)[:1])
    for i, weights in enumerate(population):
        plain = make(CONFIG, 1, seed, threads=1)
        for step in range(STEPS):
            plain.step(act(weights, plain.observations))
            np.testing.assert_array_equal(seen[i, step], plain.observations[0])
            np.testing.assert_array_equal(paid[i, step], plain.rewards[0])
    assert not np.array_equal(seen[0], seen[1])


def test_params_set_the_length_of_each_world():
    worlds = env.JaxEnv(CONFIG, 3, threads=1)
    params = env.JaxParams(jax.numpy.array([10, 20, 0]))
    keys = jax.random.split(jax.random.key(0), 3)
    _, state = jax.vmap(worlds.reset)(keys, params)
    ends = []
    for _ in range(40):
        _, state, _, done, _ = jax.vmap(worlds.step)(keys, state, np.zeros((3, 12, 2), np.float32), params)
        ends.append(np.asarray(done))
    assert np.sum(ends, axis=0).tolist() == [4, 2, 0]
    assert worlds.default_params == env.JaxParams(0)
    with pytest.raises(ArgumentError, match=r"params\.max_steps: must be one whole number"):
        worlds.reset(keys[0], env.JaxParams(jax.numpy.float32(3)))


def test_a_log_reports_the_reward_of_each_life():
    worlds = env.JaxEnv(CONFIG, 2, threads=1, max_steps=25)
    log = env.JaxLog(worlds)
    rng, keys = np.random.default_rng(0), jax.random.split(jax.random.key(1), 2)
    _, state = jax.vmap(log.reset)(keys)
    step = jax.jit(jax.vmap(log.step))
    paid, lived, ids = np.zeros((2, 12)), np.zeros((2, 12), int), np.asarray(state.env_state.agent_id)
    lives = 0
    for i in range(60):
        action = rng.uniform(-1, 1, (2, 12, 2)).astype(np.float32)
        _, state, rewards, done, info = step(jax.random.split(jax.random.key(i), 2), state, action)
        paid += np.asarray(rewards)
        lived += ids >= 0
        ended = (ids >= 0) & (np.asarray(info["terminated"]) | np.asarray(done)[:, None])
        np.testing.assert_array_equal(info["returned_episode"], ended)
        np.testing.assert_allclose(info["returned_episode_returns"], np.where(ended, paid, 0), rtol=1e-5, atol=1e-6)
        np.testing.assert_array_equal(info["returned_episode_lengths"], np.where(ended, lived, 0))
        paid[ended], lived[ended] = 0, 0
        lives += ended.sum()
        ids = np.asarray(state.env_state.agent_id)
    assert lives > 20
    assert log.slots == 12


def test_records_of_a_program_are_runs_and_change_nothing(tmp_path):
    def ends(**record: Any) -> list[str]:
        with env.JaxEnv(CONFIG, 3, threads=1, repeat=2, max_steps=30, **record) as worlds:
            rollout(worlds, np.full(2, 0.3, np.float32))
            return [world.digest() for world in worlds.simulation.worlds]

    assert ends(record=tmp_path / "run", frames=8) == ends()
    runs = [open_run(each) for each in sorted(tmp_path.iterdir())]
    assert len(runs) >= 3
    for run in runs:
        assert run.manifest.status == "finished"
        assert check_run(run.path).findings == ()
    assert sum(sum(run.manifest.steps_done) for run in runs) == 3 * 2 * STEPS
    worlds = env.JaxEnv(CONFIG, 2, record=tmp_path / "alike")
    with pytest.raises(Exception, match=r"hedon: seeds: .* appears twice"):
        jax.block_until_ready(worlds.reset(jax.random.key(0)))
    with pytest.raises(ArgumentError, match="frames = 5: give record"):
        env.JaxEnv(CONFIG, frames=5)


def test_a_program_continues_only_while_its_records_are_open(tmp_path):
    worlds = env.JaxEnv(CONFIG, record=tmp_path / "run")
    key, action = jax.random.key(0), jax.numpy.zeros((12, 2))
    _, state = worlds.reset(key)
    _, state, *_ = worlds.step(key, state, action)
    copied = copy.copy(worlds)
    worlds.close()
    with pytest.raises(Exception, match=r"hedon: step: the records in .* are closed"):
        jax.block_until_ready(worlds.step(key, state, action))
    jax.block_until_ready(copied.step(key, state, action))
    assert open_run(tmp_path / "run").manifest.steps_done == (1,)
