"""Arguments of driven worlds: a wrong one is named in one sentence and changes nothing."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from worlds import QUICK

import hedon
from hedon import ArgumentError, load_config

CONFIG = load_config("baseline", overrides=[*QUICK, "population.capacity=6", "population.initial_count=4"])
SHAPE = (1, 6, 2)
make: Any = hedon.make


def put(name: str, value: Any) -> Callable[[Any], None]:
    return lambda worlds: setattr(worlds.groups["agent"], name, value)


def freeze(name: str) -> Callable[[Any], None]:
    return lambda worlds: getattr(worlds.groups["agent"], name).setflags(write=False)


ARRAY = r"actions: must be the array of \(1, 6, 2\) float32 that was there: write into it, actions\[\.\.\.\] = …"
WRONG: dict[str, tuple[Callable[[Any], Any], str]] = {
    "half a seed": (lambda w: w.reset(seed=0.5), r"seed = 0\.5: must be a whole number"),
    "a seed as a text": (lambda w: w.reset(seed="1"), r"seed = '1': must be a whole number"),
    "half a seed in a list": (lambda w: w.reset(seed=[0.5]), r"seeds = 0\.5: must be a whole number"),
    "a seed too many": (lambda w: w.reset(seed=[1, 2]), "there must be 1, one per world, not 2"),
    "no number of threads": (lambda w: make(CONFIG, threads=None), "threads = None: must be a whole number"),
    "a truth as threads": (lambda w: make(CONFIG, threads=False), "threads = False: must be a whole number"),
    "an unknown option": (
        lambda w: w.reset(options={"mask": [True]}),
        "options: there is no 'mask'; there is 'reset_m",
    ),
    "a short mask": (lambda w: w.reset(options={"reset_mask": []}), r"options\['reset_mask'\]: must be \(1,\) bool"),
    "an empty mask": (lambda w: w.reset(options={"reset_mask": np.array([False])}), "true for at least one world"),
    "no repeat": (lambda w: make(CONFIG, repeat=None), "repeat = None: must be a whole number from 1"),
    "half a repeat": (lambda w: make(CONFIG, repeat=1.5), r"repeat = 1\.5: must be"),
    "repeat as a truth": (lambda w: make(CONFIG, repeat=True), "repeat = True: must be"),
    "no world": (lambda w: make(CONFIG, 0), "worlds = 0: must be a whole number from 1"),
    "half a life": (lambda w: make(CONFIG, max_steps=0.5), r"max_steps = 0\.5: must be"),
    "other actions": (lambda w: make(CONFIG, actions="units"), "actions = 'units': must be .*; did you mean unit"),
    "another picture": (lambda w: make(CONFIG, render_mode="ansi"), "render_mode = 'ansi': must be rgb_array or human"),
    "species as a number": (lambda w: make(CONFIG, species=5), "species: must be a name, or a list of them, not 5"),
    "species of numbers": (lambda w: make(CONFIG, species=[5]), "species '5': there is no such species"),
    "a config of numbers": (lambda w: make(3), "config: must be a Config, as load_config gives it, a preset or a file"),
    "threads": (lambda w: make(CONFIG, threads="two"), "threads = 'two': must be a whole number"),
    "given shape": (
        lambda w: w.step(np.zeros((1, 5, 2))),
        r"actions: must be numbers of shape \(1, 6, 2\) or \(6, 2\), not \(1, 5",
    ),
    "given other axes": (
        lambda w: w.step(np.zeros((1, 2, 6))),
        r"actions: must be numbers of shape .*, not \(1, 2, 6\)",
    ),
    "a species twice": (lambda w: make(CONFIG, species=["agent", "agent"]), "species = .*: must be at least one name"),
    "given nothing": (lambda w: w.step(None), "actions: must be numbers of shape .*, not None"),
    "given text": (lambda w: w.step("left"), "actions: must be numbers of shape .*, not 'left'"),
    "given masks": (lambda w: w.step(np.ma.masked_array(np.zeros(SHAPE), True)), "must be numbers of shape"),
    "given too much": (
        lambda w: w.step(np.full(SHAPE, 1.5)),
        r"actions\[0, 0, 0\] \(left\) = 1\.5: must be from -1 to 1",
    ),
    "masked": (put("actions", np.ma.masked_array(np.zeros(SHAPE, np.float32), True)), ARRAY),
    "shape": (put("actions", np.zeros((1, 6), np.float32)), ARRAY),
    "type": (put("actions", np.zeros(SHAPE)), ARRAY),
    "byte order": (put("actions", np.zeros(SHAPE, ">f4")), ARRAY),
    "stride": (put("actions", np.zeros((1, 6, 4), np.float32)[:, :, ::2]), ARRAY),
    "a list": (put("actions", [[[0.0, 0.0]] * 6]), ARRAY),
    "nothing": (put("actions", None), ARRAY),
    "another table": (put("observations", np.zeros(1)), r"observations: must be the array of \(1, 6, 95\) float32"),
    "other ids": (put("ids", np.zeros((1, 6), np.int64)), r"ids: must be the array of \(1, 6\) int32"),
    "frozen": (freeze("observations"), "observations: must be as it was made, writeable, contiguous"),
    "not a number": (
        lambda w: w.groups["agent"].actions.__setitem__((0, 3, 1), np.nan),
        r"actions\[0, 3, 1\] \(right\) = nan: must be from -1 to 1",
    ),
}


@pytest.mark.parametrize(("wrong", "says"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_named_and_changes_nothing(wrong, says):
    worlds = make(CONFIG, seed=1, threads=1)
    held = worlds.groups["agent"].actions

    def go_on():
        wrong(worlds)
        worlds.step(worlds.actions)

    with pytest.raises(ArgumentError, match=says) as caught:
        go_on()
    assert "\n" not in str(caught.value)
    assert worlds.groups["agent"].actions is held
    assert worlds.simulation.worlds[0].step == 0


def test_actions_can_be_written_in_every_way():
    worlds = make(CONFIG, seed=1, threads=1)
    group = worlds.groups["agent"]
    group.actions += 0.5
    group.actions[...] = np.ones(SHAPE)
    group.actions.fill(0.25)
    group.actions = group.actions
    worlds.step(worlds.actions)
    assert (group.actions[group.alive & ~group.born] == 0.25).all()
    worlds.step(np.full(SHAPE, -0.5, np.float64))
    assert (group.actions[group.alive & ~group.born] == -0.5).all()


def test_settings_are_changed_as_when_a_config_is_loaded():
    worlds = make("baseline", overrides=["population.capacity=7", "population.initial_count=3"])
    assert worlds.actions.shape == (1, 7, 2)
    assert make(CONFIG, overrides=iter(())).simulation.config.species == make(CONFIG).simulation.config.species
    with pytest.raises(ArgumentError, match=r"overrides: go with .*config\.with_"):
        make(CONFIG, overrides=["population.capacity=7"])


def test_environments_of_one_world_take_overrides_too():
    settings = ["population.capacity=7", "population.initial_count=3"]
    assert len(hedon.env.ParallelEnv("baseline", overrides=settings).reset()[0]) == 3
    own = hedon.env.AgentEnv("baseline", overrides=settings).simulation.config
    assert own.species["agent"].population.capacity == 7
    for kind in (hedon.env.ParallelEnv, hedon.env.AgentEnv):
        with pytest.raises(hedon.ConfigError, match=r"population\.capacty: unknown name; did you mean capacity"):
            kind("baseline", overrides=["population.capacty=7"])


REFUSED = {
    "not a number": (lambda: np.full(SHAPE, np.nan), "must be from -1 to 1"),
    "too far": (lambda: np.full(SHAPE, 1.5), "must be from -1 to 1"),
    "shape": (lambda: np.zeros((1, 5, 2)), "must be numbers of shape"),
}


@pytest.mark.parametrize(("bad", "says"), REFUSED.values(), ids=REFUSED)
def test_refused_actions_leave_none_behind(bad, says):
    worlds = make(CONFIG, seed=1, threads=1)
    worlds.step(np.full(SHAPE, 0.25))
    before = worlds.actions.copy()
    with pytest.raises(ArgumentError, match=says):
        worlds.step(bad())
    assert (worlds.actions == before).all()
    worlds.step(worlds.actions)
    assert worlds.simulation.worlds[0].step == 2


def test_a_wrong_action_of_one_species_leaves_all_actions_unchanged():
    worlds, like = (make("predator", seed=1, threads=1) for _ in range(2))
    before = {name: array.copy() for name, array in worlds.actions.items()}
    saved = worlds.save()
    first, second = worlds.actions
    with pytest.raises(ArgumentError, match="must be from -1 to 1"):
        worlds.step({first: np.full_like(before[first], 0.5), second: np.full_like(before[second], np.nan)})
    assert all((worlds.actions[name] == before[name]).all() for name in before)
    assert worlds.save() == saved
    for each in (worlds, like):
        each.step(each.actions)
    assert worlds.simulation.worlds[0].digest() == like.simulation.worlds[0].digest()


def test_actions_of_several_species_are_named_by_them():
    worlds = make("predator", seed=1, threads=1)
    with pytest.raises(
        ArgumentError, match=r"actions: must be a dict of arrays by species \(prey, predator\), not ndarray"
    ):
        worlds.step(np.zeros(3))
    with pytest.raises(ArgumentError, match=r"actions\['shark'\]: no such species is driven"):
        worlds.step({**worlds.actions, "shark": np.zeros(3)})


def test_a_table_of_all_slots_gives_each_its_own():
    worlds = make("small", worlds=3, seed=1, threads=1)
    table = np.linspace(-1, 1, worlds.actions.size, dtype=np.float32).reshape(-1, 2)
    alive = worlds.alive.copy()
    worlds.step(table)
    old = alive & worlds.alive & ~worlds.groups["agent"].born
    assert old.sum() > 10
    np.testing.assert_array_equal(worlds.actions[old], table.reshape(worlds.actions.shape)[old])


def test_only_the_environment_changes_its_worlds():
    worlds = make(CONFIG, seed=1, threads=1)
    other = worlds.simulation.clone()
    calls = {
        "run": lambda each: each.run(5),
        "reset": lambda each: each.reset([3]),
        "restore": lambda each: each.restore(worlds.simulation.save()),
    }
    for name, call in calls.items():
        with pytest.raises(ArgumentError, match=f"{name}: an environment drives these worlds"):
            call(worlds.simulation)
        call(other)  # a copy of the worlds is free
    assert worlds.simulation.worlds[0].step == 0


def test_what_the_caller_wrote_stays_until_it_is_set_right():
    worlds = make(CONFIG, seed=1, threads=1)
    worlds.actions[0, 3, 1] = np.nan
    for _ in range(2):
        with pytest.raises(ArgumentError, match=r"actions\[0, 3, 1\]"):
            worlds.step(worlds.actions)
    worlds.actions[0, 3, 1] = 0.5
    worlds.step(worlds.actions)
    assert worlds.simulation.worlds[0].step == 1


def test_a_wrong_action_of_one_agent_in_gymnasium_leaves_none_behind():
    pytest.importorskip("gymnasium", reason='needs the optional packages: pip install "hedon[env]"')
    from hedon.env import AgentEnv

    env = AgentEnv(CONFIG)
    env.reset(seed=1)
    before = env._group.actions.copy()
    with pytest.raises(ArgumentError, match="must be from -1 to 1"):
        env.step(np.array([np.nan, 0.0], np.float32))
    assert (env._group.actions == before).all()


@pytest.mark.parametrize(
    ("others", "says"),
    [
        (3, "others: must be a function from observations to actions, not 3"),
        (lambda seen: seen[:1], r"others: must return numbers of shape \(6, 2\), not \(1, 95\)"),
        (lambda seen: None, r"others: must return numbers of shape \(6, 2\), not None"),
        (lambda seen: np.full((6, 2), np.nan), r"others: returned \[\d, 0\] = nan: must be from -1 to 1"),
        (lambda seen: np.full((6, 2), 2.0), r"others: returned \[\d, 0\] = 2.0: must be from -1 to 1"),
    ],
)
def test_a_wrong_policy_of_the_others_is_named(others, says):
    pytest.importorskip("gymnasium", reason='needs the optional packages: pip install "hedon[env]"')
    from hedon.env import AgentEnv

    def one_step():
        env = AgentEnv(CONFIG, others=others)
        env.reset(seed=1)
        env.step(np.zeros(2, np.float32))

    with pytest.raises(ArgumentError, match=says):
        one_step()


MASKED = np.ma.masked_array([0.0, 1.0], [False, True])
ACTIONS = {
    "none": (None, "actions = None: must be a dict of two numbers for each agent"),
    "a list": ([[0.0, 0.0]], "must be a dict"),
    "a text": ({"agent_0": "12"}, "two finite numbers"),
    "texts": ({"agent_0": ["1", "2"]}, "two finite numbers"),
    "truths": ({"agent_0": [True, False]}, "two finite numbers"),
    "complex": ({"agent_0": np.array([1 + 2j, 0])}, "two finite numbers"),
    "masked": ({"agent_0": MASKED}, "two finite numbers"),
    "nothing": ({"agent_0": None}, "two finite numbers"),
    "ragged": ({"agent_0": [[1.0], [1.0, 2.0]]}, "two finite numbers"),
    "a column": ({"agent_0": np.zeros((2, 1))}, "two finite numbers"),
    "too large": ({"agent_0": [1e300, 0.0]}, "two finite numbers"),
    "a number as name": ({0: [0.0, 0.0]}, "no agent '0' is alive"),
    "too far": ({"agent_0": [0.0, 1.5]}, "left and right, from -1 to 1"),
    "the second": ({"agent_0": [0.9, 0.9], "agent_1": [np.nan, 0.0]}, r"actions\['agent_1'\] = \[nan, 0\.0\]"),
}


@pytest.mark.parametrize(("actions", "says"), ACTIONS.values(), ids=ACTIONS)
def test_wrong_actions_of_pettingzoo_are_named_and_none_is_applied(actions, says):
    pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
    from hedon.env import ParallelEnv

    world, other = ParallelEnv(CONFIG), ParallelEnv(CONFIG)
    for each in (world, other):
        each.reset(seed=1)
    with pytest.raises(ArgumentError, match=says) as caught:
        world.step(actions)
    assert "\n" not in str(caught.value)
    for each in (world, other):
        each.step({"agent_2": np.array([1, 0]), "agent_3": np.array((0.5, -0.5))})
    assert world.simulation.worlds[0].digest() == other.simulation.worlds[0].digest()


def test_other_arguments_of_pettingzoo_are_named():
    pytest.importorskip("pettingzoo", reason='needs the optional packages: pip install "hedon[env]"')
    from hedon.env import ParallelEnv

    new: Any = ParallelEnv
    world: Any = ParallelEnv(CONFIG)
    wrong = {
        "seeds = 'x'": lambda: world.reset(seed="x"),
        "seed = -1": lambda: new(CONFIG, seed=-1),
        "options = 5: must be a dict": lambda: world.reset(options=5),
        "max_steps = -1": lambda: new(CONFIG, max_steps=-1),
        "agent '5': there is no such agent": lambda: world.action_space(5),
        "agent 'agent_²'": lambda: world.action_space("agent_²"),
    }
    for says, call in wrong.items():
        with pytest.raises(ArgumentError, match=says):
            call()


FIXED = ["species.predator.learning.policy=fixed", "species.predator.birth.network=initial"]


@pytest.mark.parametrize(
    ("preset", "arguments", "threads"),
    [
        ("baseline", {}, 1),
        ("baseline", {"worlds": 2}, 2),
        ("baseline", {"worlds": 32}, 4),
        ("predator", {}, 3),
        ("predator", {"species": "prey"}, 0),
        ("predator", {"species": "prey", "overrides": FIXED}, 0),
        ("predator", {"species": "prey", "overrides": ["species.predator.learning.policy=random"]}, 3),
        ("baseline", {"threads": 3}, 3),
    ],
)
def test_worlds_get_as_many_threads_as_speed_them_up(monkeypatch, preset, arguments, threads):
    """All processors speed up networks that the engine computes, as for the other species of `predator`."""
    monkeypatch.setattr("hedon.env.argument.usable_cpus", lambda: 4)
    assert make(preset, **arguments).simulation._threads == threads
