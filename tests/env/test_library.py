"""Environments pass the checkers of the libraries for which they are made: Gymnasium, PettingZoo with SuperSuit."""

import pickle
import warnings
from typing import Any

import numpy as np
import pytest
from worlds import QUICK

from hedon import ArgumentError, EngineError, load_config, make

pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
import supersuit
from gymnasium.spaces import Box
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

from hedon.env import AgentEnv, ParallelEnv

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=30", "population.initial_count=20")
CONFIG = load_config("baseline", overrides=LIVELY)
GUEST = load_config(
    "baseline",
    overrides=[
        *LIVELY,
        "species.agent.hazard.kappa=0",
        "species.guest.population.capacity=1",
        "species.guest.population.initial_count=1",
        "species.guest.birth.kappa=0",
    ],
)
"""Agents that learn by themselves, and one among them that the caller drives."""


@pytest.mark.parametrize(
    ("config", "species", "options"),
    [
        (CONFIG, None, {}),
        (GUEST, "guest", {"repeat": 3, "actions": "force"}),
        ("predator", "predator", {"max_steps": 9}),
    ],
    ids=["alone", "guest", "predator"],
)
def test_gymnasium_finds_nothing_wrong_with_one_agent(config, species, options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings(
            "ignore", message=".*(minimum|maximum) value is|.*symmetric|.*does not have a spec|.*not having a spec"
        )
        check_env(AgentEnv(config, species, render_mode="rgb_array", **options), skip_close_check=False)


def test_a_life_is_an_episode():
    """The rewards of an episode add up to the reward of a life, and the episode ends at death."""
    env = AgentEnv(GUEST, "guest", seed=1)
    env.action_space.seed(1)
    lives, world, seeds = 0, env.simulation.worlds[0], set()
    for life in range(6):
        observation, info = env.reset()
        seeds.add(world.seed)
        assert len(seeds) == life + 1
        assert 1 in seeds
        assert info["slot"] == 0
        np.testing.assert_array_equal(observation, world.observations("guest")[0])
        paid, died, steps = 0.0, False, 0
        while not died and steps < 300:
            observation, reward, died, cut, told = env.step(env.action_space.sample())
            assert told["agent_id"] == info["agent_id"]
            assert not cut
            paid += reward
            steps += 1
        lives += died
        if died:
            rows = world.deaths()
            mine = rows["agent_id"] == info["agent_id"]
            assert rows["reward"][mine] == pytest.approx(paid, rel=1e-4, abs=1e-6)
            assert (rows["death_step"] - rows["birth_step"])[mine] == steps
            assert not observation.any()
            with pytest.raises(ArgumentError, match="call reset first"):
                env.step(env.action_space.sample())
    assert lives > 2
    assert world.counters_of("agent")["learners"] > 0 == world.counters_of("guest")["learners"]


def test_others_of_the_species_follow_the_given_policy():
    forces = []
    for others in (None, lambda seen: np.ones((len(seen), 2), np.float32)):
        env = AgentEnv(CONFIG, others=others)
        _, info = env.reset(seed=1)
        for _ in range(5):
            env.step(np.full(2, -1, np.float32))
        agents = env.simulation.worlds[0].agents()
        mine = agents["agent_id"] == info["agent_id"]
        age = np.maximum(agents["age"], 1)
        forces.append((agents["force_left"][mine] / age[mine], (agents["force_left"] / age)[~mine & (age == 5)]))
    motor = CONFIG.species["agent"].motor
    middle = (motor.min_force + motor.max_force) / 2
    for (mine, theirs), force in zip(forces, (middle, motor.max_force), strict=True):
        np.testing.assert_allclose(mine, motor.min_force, rtol=1e-6)
        np.testing.assert_allclose(theirs, force, rtol=1e-6)
        assert len(theirs) > 10


def test_wrong_arguments_of_one_agent_are_named():
    with pytest.raises(ArgumentError, match="species: must be one of prey, predator, that of the agent"):
        AgentEnv("predator")
    env = AgentEnv(CONFIG)
    env.reset()
    wrong: Any
    for wrong in (np.zeros(3), "go", None, np.zeros((1, 2))):
        with pytest.raises(ArgumentError, match="action: must be two numbers, left and right"):
            env.step(wrong)
    with pytest.raises(ArgumentError, match=r"actions\[0, 0, 1\] \(right\) = 2\.0: must be from -1 to 1"):
        env.step(np.array([0.0, 2.0]))
    with pytest.raises(EngineError, match=r"no founders: population\.initial_count is 0"):
        AgentEnv(GUEST.with_("species.guest.population.initial_count", 0), "guest").reset()


@pytest.mark.parametrize("slots", [False, True])
def test_pettingzoo_finds_nothing_wrong(slots):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # without slots, possible agents are not listed, and newborns are new agents
        parallel_api_test(ParallelEnv(CONFIG, slots=slots, repeat=2), num_cycles=100)
        parallel_seed_test(lambda: ParallelEnv(CONFIG, slots=slots), num_cycles=50)


def test_a_slot_stands_for_the_agent_that_lives_there():
    world, arrays = ParallelEnv(CONFIG, slots=True, seed=3), make(CONFIG, seed=3, threads=1)
    world.reset()
    group, rng = arrays.groups["agent"], np.random.default_rng(0)
    arrays.reset()
    assert world.agents == world.possible_agents == [f"agent_slot_{i}" for i in range(30)]
    seen = {"alive": 0, "died": 0, "born": 0}
    for _ in range(60):
        group.actions[...] = rng.uniform(-1, 1, group.actions.shape)
        observations, rewards, ended, cut, infos = world.step(
            {name: group.actions[0, i].copy() for i, name in enumerate(world.agents)}
        )
        arrays.step(arrays.actions)
        assert world.agents == world.possible_agents
        assert not any(ended.values())
        assert not any(cut.values())
        np.testing.assert_array_equal(np.array(list(observations.values())), group.observations[0])
        np.testing.assert_array_equal(np.array(list(rewards.values()), np.float32), group.rewards[0])
        for what, array in (("alive", group.alive), ("died", group.terminated), ("born", group.born)):
            told = [info[what] for info in infos.values()]
            assert told == array[0].tolist()
            seen[what] += sum(told)
    assert min(seen.values()) > 10


def test_all_slots_end_when_no_agent_is_left():
    doomed = CONFIG.with_("hazard.alpha_age", 0.5).with_("birth.kappa", 0.0)
    world = ParallelEnv(doomed, slots=True)
    world.reset(seed=1)
    ended: dict[str, bool] = {}
    steps = 0
    while world.agents:
        assert not any(ended.values())
        _, _, ended, cut, _ = world.step({})
        assert not any(cut.values())
        steps += 1
    assert all(ended.values())
    assert len(ended) == 30
    assert steps == world.simulation.worlds[0].extinct_step


def test_supersuit_makes_a_vector_of_slots():
    """SuperSuit's own conversion, for single-agent libraries; it restarts when all slots have ended."""
    parallel = ParallelEnv(CONFIG, slots=True, max_steps=20)
    vector: Any = supersuit.pettingzoo_env_to_vec_env_v1(supersuit.frame_stack_v1(parallel, 2))
    observations, _ = vector.reset(seed=1)
    assert observations.shape == (30, 2 * 95)
    assert isinstance(vector.action_space, Box)
    ends = 0
    for _ in range(50):
        actions = np.array([vector.action_space.sample() for _ in range(30)])
        observations, rewards, _, cut, _ = vector.step(actions)
        assert observations.shape == (30, 2 * 95)
        assert rewards.shape == (30,)
        ends += bool(cut.all())
    assert ends == 2
    both: Any = supersuit.concat_vec_envs_v1(vector, 2, base_class="gymnasium")
    assert both.reset(seed=3)[0].shape == (60, 2 * 95)
    assert both.step(np.zeros((60, 2), np.float32))[0].shape == (60, 2 * 95)


@pytest.mark.parametrize("slots", [False, True])
def test_a_world_of_pettingzoo_can_be_copied(slots):
    world = ParallelEnv(CONFIG, slots=slots)
    world.reset(seed=1)
    for _ in range(30):
        world.step({})
    other = pickle.loads(pickle.dumps(world))
    for _ in range(20):
        told = [each.step({each.agents[0]: np.ones(2, np.float32)}) for each in (world, other)]
        for mine, theirs in zip(*told, strict=True):
            assert mine.keys() == theirs.keys()
            for name in mine:
                np.testing.assert_array_equal(mine[name], theirs[name])
    assert world.simulation.worlds[0].digest() == other.simulation.worlds[0].digest()


def test_bounds_allow_for_genes_and_rounding():
    """A capacity set by a gene, and quotients rounded up in 32 bits."""
    settings = [
        "genome.set.energy.capacity.initial_sd=0.3",
        "energy.initial=30",
        "energy.capacity=31",
        "sensor.observes.one=0.06",
    ]
    settings += ["food.normal.gives.energy=40", "population.initial_count=60"]
    worlds = make("baseline", 2, seed=1, overrides=settings)
    columns, most = worlds.groups["agent"].columns, 0.0
    for _ in range(60):
        worlds.step(worlds.actions)
        seen = worlds.observations[worlds.alive]
        assert all(row in worlds.single_observation_space for row in seen)
        most = max(most, float(seen[:, columns.index("energy")].max()))
    assert most > 31


def test_spaces_match_observations_and_actions():
    """Every observation is within its bounds, and rays at walls reach the lower one."""
    both = make("predator", 2, seed=1)
    assert set(both.single_observation_space.spaces) == {"prey", "predator"}
    worlds = make("predator", 2, seed=1, species="prey", actions="force", repeat=20)
    space, motor = worlds.single_observation_space, worlds.config.species["prey"].motor
    assert worlds.single_action_space == Box(motor.min_force, motor.max_force, (2,), np.float32)
    assert make("predator", species="prey", actions="logit").single_action_space == Box(
        -np.inf, np.inf, (2,), np.float32
    )
    assert worlds.observation_space.shape == worlds.observations.shape
    assert worlds.action_space.shape == worlds.actions.shape
    worlds.action_space.seed(1)
    low, high = np.full(space.shape, np.inf), np.full(space.shape, -np.inf)
    for _ in range(40):
        worlds.step(worlds.action_space.sample())
        seen = worlds.observations[worlds.alive]
        assert all(row in space for row in seen)
        low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
    columns = worlds.groups["prey"].columns
    for i, name in enumerate(columns):
        if name.startswith("ray_"):
            assert (space.low[i], space.high[i]) == (-1, 1)
        if name.startswith("ray_wall"):
            assert low[i] == -1
            assert high[i] > 0.3
    energy = columns.index("energy")
    assert space.high[energy] == worlds.config.species["prey"].energy.capacity
    assert space.low[energy] == 0
