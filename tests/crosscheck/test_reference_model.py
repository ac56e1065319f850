"""Every decision of the engine about life and death, compared with the rules in plain Python, step by step."""

from collections.abc import Iterator
from importlib.util import find_spec

import numpy as np
import pytest
from observed_world import read_world
from reference_case.beyond_paper import CASES
from reference_case.case import LIVELY, each
from reference_step import Judge, command, network_size
from worlds import set_scene

from hedon.config.config import Config
from hedon.config.field import Setting, leaves, sections, settings
from hedon.config.load import load_config
from hedon.config.schema.measure import MeasureConfig
from hedon.config.schema.physics import PhysicsConfig
from hedon.config.schema.settings import PROVENANCE
from hedon.experiment.simulation import Simulation
from hedon.record.founder import make_founders

SEED = 2**63 + 17
USUAL = {"births": 5, "deaths": 5}
"""The least number of each event in every case."""


@pytest.mark.parametrize("name", CASES)
def test_every_step_follows_the_rules(name):
    case = CASES[name]
    if ".rule=" in " ".join(case.settings) and find_spec("numba") is None:
        pytest.skip('needs the optional package: pip install "hedon[rules]"')
    simulation = Simulation(case.config, [SEED], threads=1)
    judge, world = Judge(simulation, SEED), simulation.worlds[0]
    judge.begin()
    while world.step < case.steps and not world.extinct:
        command(simulation)
        judge.step()
    happened = {**world.counters, "eaten": world.view("food_stock.eaten").sum(), **judge.happened}
    for what in ("deaths_eaten", "energy_hunted"):
        happened[what] = world.view(f"hunt_counters.{what}").sum()
    for what, least in (USUAL | case.happens).items():
        assert happened[what] >= least, (what, happened)


def test_rivals_for_one_food_follow_the_rules():
    simulation = Simulation(load_config("baseline", None, LIVELY), [SEED], threads=1)
    rng, judge = np.random.default_rng(0), Judge(simulation, SEED)
    x, y = (axis.ravel() for axis in np.meshgrid([60.0, 120, 180], [50.0, 100, 150]))
    for _ in range(10):
        away = rng.uniform(0, 2 * np.pi, 9)[:, None] + 2 * np.pi / 3 * np.arange(3)  # three around each food
        reach = rng.uniform(13.5, 14.2, away.shape)
        places = (x[:, None] + reach * np.sin(away), y[:, None] - reach * np.cos(away))
        set_scene(simulation, np.stack([*places, away % (2 * np.pi)], -1), np.column_stack([x, y]), energy=2.0)
        judge.born_with.clear()
        for _ in range(2):
            judge.step()
    assert judge.happened["rivals"] > 50


@pytest.mark.parametrize("prey", ["nearest", "all"])
@pytest.mark.parametrize("sharing", ["one", "each"])
def test_crowds_that_eat_one_another_follow_the_rules(sharing, prey):
    """Chains of claims, rivals for one agent, pairs that claim each other, and agents that starve in the same step."""
    settings = (
        f'world.prey_sharing="{sharing}"',
        f'world.prey_at_mouth="{prey}"',
        f'world.prey_energy="{"before_step" if prey == "all" else "after_costs"}"',
        *("population.capacity=100", "population.initial_count=1", "sensor.mouth_spread=40", "birth.kappa=0"),
        *each("prey", "energy.basic_cost=0.7", 'energy.at_zero="death"'),
        *each("hunter", 'diet.eats=[["prey", 0.6], ["hunter", 0.3]]', "diet.digestion_steps=1"),
        *each("hunter", "energy.basic_cost=0.7", 'energy.at_zero="death"'),
        *each("top", 'diet.eats=[["hunter", 0.5], ["prey", 0.2], ["top", 0.1]]', "energy.capacity=4"),
    )
    simulation = Simulation(load_config("baseline", None, (*LIVELY, *settings)), [SEED], threads=1)
    rng, judge = np.random.default_rng(0), Judge(simulation, SEED)
    rows, columns = np.mgrid[:9, :10]
    for _ in range(10):
        x, y = 25 + 19.9 * (columns + rows % 2 / 2).ravel(), 25 + 17.2 * rows.ravel()
        places = np.column_stack([x, y, rng.uniform(0, 2 * np.pi, x.size)]) + rng.normal(0, 0.05, (x.size, 3))
        set_scene(simulation, places, species=rng.integers(0, 3, x.size), energy=2.0)
        judge.born_with.clear()
        for _ in range(3):
            judge.step()
    for what in ("contested", "spared", "cannibal", "starved", "digesting" if prey == "nearest" else "feasts"):
        assert judge.happened[what] >= 10, (what, judge.happened[what])


def test_founders_given_as_data_follow_the_rules():
    """Each gets a row of the table; values that it leaves out are drawn as usual."""
    settings = (
        "genome.learning.action_sd.initial_sd=0.2",
        *each("prey", "birth.kappa=0.2"),
        *each("other", "diet.eats=[]"),
    )
    simulation = Simulation(load_config("baseline", None, (*LIVELY, *settings)), [SEED], threads=1)
    genes, rows = ("prey.w_normal", "w_action", "g_action_sd"), [(1.5, 2, 0.5), (-1.5, np.nan, -0.5), (np.nan, 3, 0.25)]
    simulation.set_founders(make_founders(genes, np.array(rows), ("one", "one", "two"), {"one": 0.5, "two": 0.5}))
    judge, world = Judge(simulation, SEED), simulation.worlds[0]
    expected, begun = judge.model.found(), read_world(simulation)
    for agent, founder, slot in zip(begun.agents, expected.agents, world.living, strict=True):
        species = judge.model.rules.of(agent)
        spread = species.gene(agent.genome, "g_action_sd")
        row = next(row for row in rows if row[2] == spread)
        for name, value in zip(("w_normal", "w_action", "g_action_sd"), row, strict=True):
            if name in species.genes and not np.isnan(value):
                founder.genome[species.genes.index(name)] = value
        size = network_size(world.observations(agent.species).shape[1])
        np.testing.assert_allclose(world.view("params")[slot][size - 13 : size - 11], spread * np.log(10), rtol=1e-6)
    judge.assert_same(expected, 0.0)
    groups = [
        species.gene(a.genome, "g_action_sd") == 0.25 for a in begun.agents for species in [judge.model.rules.of(a)]
    ]
    assert np.mean(groups) == 0.5
    while world.step < 30:
        judge.step()
    assert world.counters["births"] >= 10


NETWORKS = "how networks learn: test_ppo, test_gae, test_adam, test_window"
RAYS = "what rays read is taken from the engine: test_cast_rays, test_sensor"
JUDGED_ELSEWHERE = {
    **dict.fromkeys(PROVENANCE, "where a config comes from changes no result"),
    **{f"measure.<kind>.{name}": "what is measured changes no result" for name in settings(MeasureConfig)},
    **{
        f"physics.{name}": "where bodies move is taken from the engine: tests/physics"
        for name in settings(PhysicsConfig)
    },
    **dict.fromkeys(("motor.angle", "obstacle.friction"), "the same"),
    **{f"sensor.ray_{name}": RAYS for name in ("count", "spread", "length", "inside")},
    **{
        f"learning.{name}": NETWORKS for name in ("minibatch_size", "update_epochs", "gamma", "gae_lambda", "clip_coef")
    },
    **{f"learning.{name}": NETWORKS for name in ("learning_rate", "adam_beta1", "adam_beta2", "adam_epsilon")},
    **{f"learning.{name}": NETWORKS for name in ("value_coef", "entropy_coef", "critic_target")},
    **{f"learning.{name}": NETWORKS for name in ("reward_scaling", "advantage_normalization")},
    "food.<kind>.color": "for figures alone",
    "food.<kind>.looks_like": RAYS,
    "world.founders": "a digest that a run sets: tests/contract/test_founders.py",
    "world.networks": "a digest that a run sets: tests/contract/test_frozen.py",
}
"""Settings that no case of the model checks, and why."""


NAMED = ("food", "store", "neighbor", "see", "smell", "pay", "schedule", "mutation", "family", "learning", "extra")
"""Sections whose parts users name."""


def general(path: str) -> str:
    """The path of a setting without the names of species and kinds, as in `every_setting`."""
    parts = path.split(".")
    if parts[0] == "species":
        parts = parts[2:]
    if parts[0] == "food" and parts[2] in ("gives", "needs"):
        parts = parts[:3]
    if parts[:2] == ["sensor", "observes"]:
        parts = parts[:2]
    if parts[:2] == ["genome", "set"]:
        parts = [*parts[:2], "<kind>", parts[-1]]
    for i, part in enumerate(parts[:-1]):
        if part in NAMED and i + 2 < len(parts):
            parts[i + 1] = "<kind>"
    return ".".join(parts)


def every_setting(section: type, path: str = "") -> Iterator[tuple[str, Setting]]:
    """Every setting that a config may have, once."""
    for name, setting in settings(section).items():
        yield f"{path}{name}", setting
    for name, inner in sections(section).items():
        below = "" if name == "species" else f"{path}{name}." + ("<kind>." if inner.repeated else "")
        yield from every_setting(inner.type, below)


def used(config: Config) -> Iterator[tuple[str, object]]:
    """The settings of a config that differ from the default, with their values."""
    default = {general(path): value for path, _, value in leaves(Config())}
    for path, setting, value in leaves(config):
        place = general(path)
        if value != default.get(place, setting.default):
            yield place, value


def test_every_setting_that_changes_rules_has_a_case():
    judged: dict[str, set] = {}
    for case in CASES.values():
        for path, value in used(case.config):
            judged.setdefault(path, set()).add(value if isinstance(value, str) else True)
    missing = []
    for path, setting in every_setting(Config):
        if path in JUDGED_ELSEWHERE:
            continue
        wanted = [choice for choice in setting.choices if choice != setting.default] or [None]
        missing += [
            (path, choice) for choice in wanted if path not in judged or (choice and choice not in judged[path])
        ]
    assert missing == []
    assert set(JUDGED_ELSEWHERE) <= {path for path, _ in every_setting(Config)}
