"""Every valid config can be simulated: the engine refuses nothing that `load_config` accepts.

HEDON_FUZZ=N tries N examples instead of the default number.
"""

import os
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, example, given, settings
from hypothesis import strategies as st
from two_stores import FED

from hedon.config.config import Config
from hedon.config.field import Setting, leaves
from hedon.config.load import load_config
from hedon.config.problem import ConfigError, format_value
from hedon.config.schema.settings import changes_worlds
from hedon.error import EngineError
from hedon.experiment.memory import memory_needed
from hedon.experiment.simulation import Simulation

EXAMPLES = int(os.environ.get("HEDON_FUZZ", "0"))
FUZZ = {"deadline": None, "suppress_health_check": list(HealthCheck)}
SMALL = (
    "population.capacity=12",
    "population.initial_count=3",
    "world.rollout_steps=4",
    "learning.minibatch_size=2",
)
ALL_TABLES = (
    *(f"food.normal.schedule.{name}={{points=[[0, 1.0], [9, 0.5]]}}" for name in ("growth_rate", "capacity")),
    "hazard.schedule.scale={points=[[0, 1.0], [9, 0.5]]}",
    "obstacle.schedule.harmful={points=[[0, 1.0], [9, 0.5]]}",
    "obstacle.count=2",
    "arena.inner_walls=[[10, 10, 50, 60]]",
    "food.normal.placement={form='mixture', centers=[[50, 50], [80, 90]], sd=[9, 9]}",
    *FED,
    "food.normal.needs.nutrient=1",
    "reward.drive_reduction_coef=1",
    "reward.family=between",
    "reward.gate=age",
    "reward.pay.moved={}",
    "sensor.observes={moved=1.0, births=1.0}",
    "genome.learning={gamma={}, action_sd={}}",
    "genome.family.threshold={}",
    "genome.set={sensor.ray_length={}, store.nutrient.basic_cost={}, body.radius={}, hazard.kappa={}}",
    "genome.mutation.g_body_radius.limit=0.3",
    "genome.mutation.w_action.law=normal",
)
SOURCES = {
    "one": ("baseline", (*SMALL, *ALL_TABLES, 'sensor.smells=["*"]', "reward.pay.smell_normal={}")),
    "two": (
        "predator",
        (*(f"species.{name}.{text}" for name in ("prey", "predator") for text in SMALL[:2]), *SMALL[2:]),
    ),
}
SETTINGS = {
    source: [each for each in leaves(load_config(preset, overrides=texts)) if changes_worlds(each[0])]
    for source, (preset, texts) in SOURCES.items()
}
EDGES = [
    0.0,
    -0.0,
    1e-45,
    1e-6,
    0.999999999,
    1.0,
    1e4,
    1e5,
    1e5 + 0.01,
    1e6,
    1e6 + 1,
    1e7,
    1e30,
    1e39,
    2**31,
    2**31 - 1,
]


def numbers(setting: Setting) -> st.SearchStrategy[Any]:
    """Numbers at and around the limits of a setting, and ordinary ones."""
    limits = setting.doc.range
    borders = [each for each in (limits.ge, limits.gt, limits.le, limits.lt, *(limits.each or ())) if each is not None]
    near = [each * factor for each in borders for factor in (1, 1 - 1e-9, 1 + 1e-9, 0.5)]
    floats = st.one_of(st.sampled_from([*EDGES, *(-each for each in EDGES), *near]), st.floats(-200, 200))
    whole = st.one_of(st.sampled_from([int(each) for each in borders] or [0]), st.integers(-3, 40))
    return whole if setting.type is int else st.one_of(floats, whole.map(float))


def values(setting: Setting, value: Any) -> st.SearchStrategy[Any]:
    """Values of a setting's type."""
    if setting.choices:
        return st.sampled_from(setting.choices)
    if isinstance(value, bool):
        return st.booleans()
    if isinstance(value, str):
        return st.just(value)
    if isinstance(value, tuple):
        changed = [st.tuples(st.just(i), numbers(setting)) for i in _places(value)]
        return st.one_of(st.just(()), *(each.map(lambda pair: _put(value, *pair)) for each in changed))
    return numbers(setting)


def _places(value: tuple[Any, ...]) -> list[tuple[int, ...]]:
    """The indices of numbers in nested lists."""
    found = []
    for i, item in enumerate(value):
        below = _places(item) if isinstance(item, tuple) else [()] if not isinstance(item, str) else []
        found += [(i, *rest) for rest in below]
    return found


def _put(value: tuple[Any, ...], at: tuple[int, ...], number: float) -> tuple[Any, ...]:
    new = _put(value[at[0]], at[1:], number) if at[1:] else type(value[at[0]])(number)
    return (*value[: at[0]], new, *value[at[0] + 1 :])


@st.composite
def changes(draw: st.DrawFn) -> tuple[str, list[tuple[str, Any]]]:
    """The name of a config, and new values for some of its settings."""
    source = draw(st.sampled_from(["one", "two"]))
    chosen = draw(st.lists(st.sampled_from(SETTINGS[source]), min_size=1, max_size=3))
    return source, [(path, draw(values(setting, value))) for path, setting, value in chosen]


@pytest.mark.repeated
@settings(max_examples=EXAMPLES or 400, **FUZZ)
@given(changed=changes())
@example(changed=("one", [("store.nutrient.hazard_weight", 1e7)]))
@example(changed=("one", [("motor.max_force", 1e4), ("motor.force_scale", 1e3)]))
@example(changed=("one", [("food.normal.placement.sd", (1e30, 1e30))]))
@example(changed=("one", [("food.normal.placement.sd", (1e-50, 1.0))]))
@example(changed=("one", [("food.normal.placement.drift", (1e7, 0.0))]))
@example(changed=("one", [("arena.inner_walls", ((10.0, 10.0, 10.0, 10.000001),))]))
@example(changed=("one", [("hazard.schedule.scale.points", ((2**31, 1.0),))]))
@example(changed=("one", [("physics.dt", 1e-45)]))
@example(changed=("two", [("species.prey.diet.eats", (("normal", 1e30),))]))
def test_the_engine_takes_what_the_config_accepts(changed):
    config = _load(*changed)
    if config is None:
        return
    assume(sum(memory_needed(config, 1, 1).values()) < 200e6)
    assume(all(species.population.initial_count < 1000 for species in config.species.values()))
    assume(all(food.initial_count < 1000 for food in config.food.values()))
    refused = _refusal(config)
    assert refused is None or refused.startswith("initial_placement"), refused  # known only after placing them


def _refusal(config: Config) -> str | None:
    try:
        Simulation(config, [1], threads=1)
    except EngineError as error:
        return str(error)
    return None


def _load(source: str, changed: list[tuple[str, Any]]) -> Config | None:
    preset, settings_ = SOURCES[source]
    try:
        return load_config(
            preset, overrides=[*settings_, *(f"{path}={format_value(value)}" for path, value in changed)]
        )
    except ConfigError:
        return None
