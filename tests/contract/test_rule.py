"""Rewards from Python rules, compared with the same rule in plain Python and with the engine's own terms."""

import numpy as np
import pytest
from two_stores import FED
from worlds import CHILDLESS, DEATHLESS, QUICK, make_simulation

from hedon import EngineError, Simulation, load_config
from hedon.config import ConfigError
from hedon.config.layout import rule_columns
from hedon.experiment.rule import RuleError, pinned, rules

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=60", "population.initial_count=40")
RULES = """
def same(agent):
    return agent.linear

def by_terms(agent):
    return agent.w_normal * agent.normal + 0.01 * agent.w_action * agent.action

def curious(agent):
    surprise = abs(agent.nearness - agent.memory_1)
    agent.memory_1 += 0.1 * (agent.nearness - agent.memory_1)
    return agent.w_action * surprise

def homeostatic(agent):
    return abs(agent.energy_before - 40.0) - abs(agent.energy - 40.0)

def bad(agent):
    return 1.0 / (agent.age - 3.0)

def huge(agent):
    return 1e39 if agent.age > 2.0 else 3e38

def stuffed(agent):
    agent.memory_1 = agent.memory_2 = 1.7e308
    return 1.0

def raising(agent):
    if agent.age > 2.0:
        raise ValueError("old")
    return 1.0

def wordy(agent):
    return "much"

def untyped(agent):
    return agent.hungr

def marked(agent):
    return agent.linear + 0.0 * agent.neutral_1

def marked_item(agent):
    return agent["neutral_1"]
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "my_rules.py"
    path.write_text(RULES)
    return path


def paid(file, name, *settings, memory=0, threads=1, seeds=(3,)):
    return make_simulation(
        *settings, f'reward.rule="{file}:{name}"', f"reward.memory={memory}", seeds=seeds, threads=threads
    )


def test_a_rule_that_repeats_the_terms_changes_nothing(file):
    """Not even learning, births and deaths: the rewards have the same bits."""
    plain, ruled = make_simulation(*LIVELY, seeds=(3,)), paid(file, "same", *LIVELY)
    for simulation in (plain, ruled):
        simulation.run(200)
    assert plain.worlds[0].counters["learners"] > 0
    assert plain.worlds[0].digest() == ruled.worlds[0].digest()


def recording(file, name, left_out=()):
    """A simulation whose rule also copies its record into memory, from the fourth number on, and the copied columns."""
    settings = (*QUICK, *DEATHLESS, *CHILDLESS, "genome.neutral_count=1", "genome.action.initial_mean=2")
    columns = rule_columns(make_simulation(*settings).config, "agent")
    columns = tuple(column for column in columns if column not in (*left_out, "neutral_1"))
    body = RULES.split(f"def {name}(agent):\n")[1].split("\n\n")[0]
    copies = "".join(f"    agent.memory_{i + 4} = agent.{column}\n" for i, column in enumerate(columns))
    file.write_text(f"def both(agent):\n{copies}{body}\n")
    return paid(file, "both", *settings, memory=16), columns


def test_the_record_has_the_stores_of_the_species(file):
    names = ("nutrient_before", "nutrient", "toxin_before", "toxin")
    file.write_text(
        "def copy(agent):\n"
        + "".join(f"    agent.memory_{i} = agent.{n}\n" for i, n in enumerate(names, 1))
        + "    return agent.linear\n"
    )
    settings = (*QUICK, *DEATHLESS, *CHILDLESS, *FED, "food.normal.gives.toxin=5")
    simulation = paid(file, "copy", *settings, memory=4)
    simulation.run(30)
    world = simulation.worlds[0]
    before = world.agents()
    simulation.run(1)
    after, record = world.agents(), world.view("memory")[world.living].T
    for state, (then, now) in {"nutrient": record[:2], "toxin": record[2:]}.items():
        np.testing.assert_array_equal(then, before[state])
        np.testing.assert_array_equal(now, after[state])
    assert (after["toxin"] > before["toxin"]).any() or (before["toxin"] > 0).any()


PLACED = ("x", "y", "step", "alive")
MOVING = ("force_left", "force_right", "moved", "nearness")


@pytest.mark.parametrize("left_out", [PLACED, MOVING])
def test_the_record_matches_the_names_of_its_columns(file, left_out):
    """In two halves, since memory is too small for all columns."""
    simulation, columns = recording(file, "same", left_out)
    simulation.run(30)
    world = simulation.worlds[0]
    before = world.agents()
    simulation.run(1)
    after = world.agents()
    record = dict(zip(columns, world.view("memory")[world.living, 3 : 3 + len(columns)].T, strict=True))
    np.testing.assert_array_equal(record["energy_before"], before["energy"])
    np.testing.assert_array_equal(record["energy"], after["energy"])
    np.testing.assert_array_equal(record["age"], after["age"])
    np.testing.assert_array_equal(record["normal"], (after["eaten"] - before["eaten"])[:, 0])
    assert columns[2:5] == ("w_normal", "w_action", "age")
    for i, name in enumerate(columns[2:4]):
        np.testing.assert_array_equal(record[name], after["genome"][:, i])
    np.testing.assert_allclose(record["linear"], after["reward"] - before["reward"], rtol=1e-4, atol=1e-7)
    if left_out == MOVING:
        for name in ("x", "y"):
            np.testing.assert_array_equal(record[name], world.view(f"physics.bodies.{name}")[world.living])
        assert (record["step"] == 30).all()
        assert (record["alive"] == len(after["age"])).all()
        return
    np.testing.assert_allclose(record["moved"], after["distance"] - before["distance"], atol=1e-6)
    np.testing.assert_allclose(record["force_left"], after["force_left"] - before["force_left"], atol=1e-3)
    np.testing.assert_allclose(record["force_right"], after["force_right"] - before["force_right"], atol=1e-3)
    force = np.hypot(record["force_left"], record["force_right"])
    np.testing.assert_allclose(record["action"], force / (80 * np.sqrt(2)), rtol=1e-6)
    rays = world.view("observation")[world.living, 30, :96].copy().view(np.float32)  # reading + 1 of each ray
    np.testing.assert_allclose(record["nearness"], np.maximum(rays - 1, 0).mean(axis=1), rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("name", ["by_terms", "curious", "homeostatic"])
def test_plain_python_pays_the_same(file, name):
    simulation, columns = recording(file, name, PLACED)
    (rule,) = rules(simulation.config)
    known = [rule.columns.index(column) for column in columns]
    kept, wanted = np.zeros((50, 16)), np.zeros(50)
    for step in range(20):
        simulation.run(1)
        world = simulation.worlds[0]
        memory = world.view("memory")[world.living]
        records = np.zeros((50, len(rule.columns)))
        records[:, known], records[:, -16:] = memory[:, 3 : 3 + len(known)], kept
        wanted = rule.answers(records)
        kept = records[:, -16:]
        np.testing.assert_array_equal(memory, kept)
        np.testing.assert_array_equal(world.view("reward")[world.living, step], wanted.astype(np.float32))
    assert wanted.any()


def test_threads_and_checkpoints_change_nothing(file):
    """Two species, one of which has a rule with memory; newborns start with empty memory."""
    settings = (*LIVELY, "species.plain.body.radius=10", f'species.odd.reward.rule="{file}:curious"')
    settings = (*settings, "species.odd.reward.memory=3")
    once = make_simulation(*settings, seeds=(3,))
    once.run(150)
    first, second = (make_simulation(*settings, seeds=(3,), threads=threads) for threads in (2, 1))
    first.run(90)
    second.run(5)
    second.engine.restore(0, first.engine.save(0))
    second.run(60)
    assert second.worlds[0].digest() == once.worlds[0].digest()
    world = once.worlds[0]
    assert world.counters["births"] > 10
    agents, memory = world.agents(), world.view("memory")[world.living]
    assert (memory[agents["species"] == 0] == 0).all()
    assert (memory[(agents["species"] == 1) & (agents["age"] > 20), 0] > 0).any()
    assert (memory[agents["age"] == 0] == 0).all()


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("curios", r"has no function curios; did you mean curious\?"),
        ("wordy", r"it returns Literal.*: a rule returns one number"),
        ("curious", r"an agent has no memory_1: set reward.memory to 1 or more; it has normal"),
        ("untyped", r"an agent has no hungr; it has normal, action, w_normal, w_action, age"),
        ("marked", "it reads neutral_1, a neutral gene: .*; genes that it may read are w_normal, w_action, and what"),
        ("marked_item", r"it reads neutral_1, a neutral gene"),
    ],
)
def test_a_rule_that_cannot_be_used_is_named(file, name, says):
    with pytest.raises(RuleError, match=says):
        paid(file, name, *QUICK)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize(("name", "value"), [("bad", "inf"), ("raising", "-?nan"), ("huge", r"1e\+39")])
def test_a_rule_that_fails_stops_the_world(file, name, value):
    simulation = paid(file, name, *QUICK, *DEATHLESS)
    with pytest.raises(
        EngineError,
        match=rf"rule_not_finite: .* step 2, value {value}, agent 0, reward.rule of agent \(my_rules.py:{name}\)",
    ):
        simulation.run(10)


def test_memories_may_be_large(file):
    simulation = paid(file, "stuffed", *QUICK, *DEATHLESS, memory=2)
    simulation.run(10)
    assert simulation.worlds[0].step == 10


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_the_rule_of_the_species_that_failed_is_named(file):
    rules = {"prey": "raising", "predator": "same"}
    settings = [f'species.{name}.reward.rule="{file}:{rule}"' for name, rule in rules.items()]
    simulation = Simulation(load_config("predator", overrides=[*settings, *QUICK]), [1], threads=1)
    with pytest.raises(EngineError, match=r"agent \d+, reward.rule of prey \(my_rules.py:raising\), windows"):
        simulation.run(10)


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        (['reward.rule="curious"'], r"reward\.rule.*FILE\.py:NAME"),
        (["reward.memory=2"], r"reward\.memory.*give reward\.rule too"),
        (['reward.rule="a.py:b"', "food.age.gives.energy=1"], r"reward\.rule.*are called age"),
    ],
)
def test_a_wrong_setting_is_named(settings, says):
    with pytest.raises(ConfigError, match=says):
        load_config("baseline", overrides=settings)


def test_a_config_is_pinned_once(file):
    config = load_config("predator", overrides=[f'species.prey.reward.rule="{file}:same"'])
    found = rules(config)
    once = pinned(config, found)
    assert once.species["prey"].reward.rule == f"my_rules.py:same@{found[0].source.digest}"
    assert once.species["predator"].reward.rule == ""
    assert pinned(once, rules(once, [found[0].source])) == once


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("PAY = float(open('pay').read())", "line 1: it reads a file, which no run keeps"),
        ("from pathlib import Path\nPAY = float(Path('pay').read_text())", "line 2: it reads a file"),
        ("import numpy as np\nPAY = np.load('pay.npy')[0]", "line 2: it reads a file"),
        ("from helper import PAY", "line 1: it imports helper, a file of yours"),
        ("from numpy.random import *\nPAY = 1.0", "line 1: it imports \\* from numpy.random"),
    ],
)
def test_sources_that_no_run_keeps_are_refused(tmp_path, monkeypatch, text, message):
    """A run keeps the text of the rule's file; anything it takes from elsewhere could change unnoticed."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "helper.py").write_text("PAY = 1.0\n")
    rule = tmp_path / "rule.py"
    rule.write_text(f"{text}\n\ndef paid(agent):\n    return PAY\n")
    with pytest.raises(RuleError, match=message):
        make_simulation(*QUICK, f'reward.rule="{rule}:paid"')
