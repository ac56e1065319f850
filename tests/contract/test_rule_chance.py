"""Python rules for death and birth, compared with the formulas they replace and with the same rules in plain Python."""

from functools import partial

import numpy as np
import pytest
from reference.draw import PURPOSES, fine_uniform, philox
from worlds import CHILDLESS, DEATHLESS, QUICK, RELEASED, make_simulation

from hedon import EngineError, RunPlan, load_config, open_run, resume, run
from hedon.config import ConfigError
from hedon.config.layout import rule_columns
from hedon.demography.forecast import setting_warnings
from hedon.experiment.rule import rules

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

LIVELY = (*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01", "population.capacity=60", "population.initial_count=40")
SEASON = ("hazard.schedule.scale.period=30", "hazard.schedule.scale.points=[[0,0.5],[15,3.0]]")
RULES = """
import math

def same(agent):
    return agent.chance

def hazard(agent):
    x = 0.02 * math.exp(-0.2 * agent.energy)
    return 0.01 * (1.0 - 1.0 / (1.0 + x)) + 0.01 * math.exp(4e-6 * agent.age)

def birth(agent):
    return 0.05 / (1.0 + math.exp(-0.1 * agent.energy))

def noting(agent):
    agent.memory_1 = agent.x
    agent.memory_2 = agent.energy
    return agent.linear

def crowded(agent):
    return 0.5 if agent.alive < 30 else 0.0

def swamp(agent):
    wet = agent.x < 200.0
    return 0.1 + 0.002 * min(agent.energy, 100.0) if wet else 0.0

def above(agent):
    return 1.5 if agent.age > 2.0 else 0.0

def below(agent):
    return 1.5 - agent.age

def nothing(agent):
    return 0.0 * math.log(agent.age - 2.0)

def raising(agent):
    return 1.0 / len("x" * 0) if agent.age < 0.0 else [0.0][int(agent.age) - 1]

def writing(agent):
    agent.memory_1 = agent.age
    return 0.0
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "my_rules.py"
    path.write_text(RULES)
    return path


def living(file, *settings, threads=1, seeds=(3,), preset="baseline", **chosen):
    """A simulation with the rule given for each use."""
    named = (f'{use}.rule="{file}:{name}"' for use, name in chosen.items())
    return make_simulation(*settings, *named, threads=threads, seeds=seeds, preset=preset)


@pytest.mark.parametrize("settings", [SEASON, RELEASED, ("world.birth_order=after_deaths",)])
def test_rules_that_repeat_the_formulas_change_nothing(file, settings):
    """Births, deaths and learning have the same bits. A parent's hazard is computed again with its remaining energy."""
    plain = make_simulation(*LIVELY, *settings, seeds=(3,))
    ruled = living(file, *LIVELY, *settings, hazard="same", birth="same")
    for simulation in (plain, ruled):
        simulation.run(200)
    counters = plain.worlds[0].counters
    assert min(counters["births"], counters["deaths"]) > 10
    assert plain.worlds[0].digest() == ruled.worlds[0].digest()


def test_prey_with_rules_are_eaten_as_before(file):
    settings = (*QUICK, "species.prey.birth.kappa=0.01")
    plain = make_simulation(*settings, preset="predator", seeds=(3,))
    ruled = make_simulation(
        *settings,
        *(f'species.prey.{use}.rule="{file}:same"' for use in ("hazard", "birth")),
        preset="predator",
        seeds=(3,),
    )
    for simulation in (plain, ruled):
        simulation.run(300)
    assert plain.worlds[0].digest() == ruled.worlds[0].digest()


def test_the_formulas_written_in_python_give_the_same_lives(file):
    """Chances differ by the rounding of `exp`, 1e-16; to matter, a draw would have to fall between them."""
    plain, ruled = make_simulation(*LIVELY, seeds=(3,)), living(file, *LIVELY, hazard="hazard", birth="birth")
    for simulation in (plain, ruled):
        simulation.run(200)
    assert plain.worlds[0].counters["deaths"] > 10
    assert plain.worlds[0].digest() == ruled.worlds[0].digest()


def draws(seed, agent, step):
    """An agent's draws in a step: for a birth and for death."""
    words = philox((0, PURPOSES.index("life_and_death"), agent, step), (seed & 0xFFFFFFFF, seed >> 32))
    return fine_uniform(*words[:2]), fine_uniform(*words[2:])


def test_agents_that_draw_less_than_plain_python_returns_die(file):
    simulation = living(file, *QUICK, *CHILDLESS, "reward.memory=2", reward="noting", hazard="swamp")
    world = simulation.worlds[0]
    swamp = next(rule for rule in rules(simulation.config) if rule.use == "hazard")
    died = 0
    for step in range(8):
        before = world.agents()["agent_id"]
        slots = world.living.copy()
        simulation.run(1)
        records = np.zeros((len(before), len(swamp.columns)))
        for i, column in enumerate(("x", "energy")):
            records[:, swamp.columns.index(column)] = world.view("memory")[slots, i]
        chances = swamp.answers(records)
        left = [agent for agent, chance in zip(before, chances, strict=True) if draws(3, int(agent), step)[1] >= chance]
        assert left == list(world.agents()["agent_id"])
        died += len(before) - len(left)
    assert died > 5


def test_a_birth_rule_knows_how_many_agents_are_alive(file):
    simulation = living(
        file, *QUICK, *DEATHLESS, "population.capacity=60", "population.initial_count=20", birth="crowded"
    )
    alive = [20]
    while alive[-1] < 30:
        simulation.run(1)
        alive.append(simulation.worlds[0].alive)
    simulation.run(100)
    assert 30 <= simulation.worlds[0].alive == alive[-1] < 60


def test_threads_and_checkpoints_change_nothing(file):
    make = partial(living, file, *LIVELY, "reward.memory=2", reward="noting", hazard="hazard", birth="birth")
    once = make()
    once.run(150)
    first, second = (make(threads=threads) for threads in (2, 1))
    first.run(90)
    second.run(5)
    second.engine.restore(0, first.engine.save(0))
    second.run(60)
    assert second.worlds[0].digest() == once.worlds[0].digest()
    assert once.worlds[0].counters["births"] > 10


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("use", ["hazard", "birth"])
@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("above", "rule_no_chance: .* step 2, value 1.5, agent"),
        ("below", "rule_no_chance: .* step 1, value -0.5, agent"),
        ("nothing", "rule_no_chance: .* step 0, value -?nan, agent 0"),
        ("raising", "rule_no_chance: .* step 1, value -?nan, agent 0"),
    ],
)
def test_an_invalid_chance_stops_the_world(file, use, name, says):
    other = {"hazard": CHILDLESS, "birth": DEATHLESS}[use]
    simulation = living(file, *QUICK, *other, **{use: name})
    with pytest.raises(EngineError, match=rf"{says}.*, {use}\.rule of agent \(my_rules\.py:{name}\), windows"):
        simulation.run(10)


def test_only_a_reward_rule_may_write_memory(file):
    simulation = living(file, *QUICK, "reward.memory=2", reward="noting", hazard="writing")
    where = r"agent 0, hazard\.rule of agent \(my_rules\.py:writing\), windows"
    with pytest.raises(EngineError, match=rf"rule_wrote: .* value 1, {where}"):
        simulation.run(10)


def test_a_run_is_resumed_with_the_rules_that_it_keeps(file, tmp_path):
    overrides = [*LIVELY, f'hazard.rule="{file}:hazard"', f'birth.rule="{file}:birth"']
    plan = RunPlan(load_config("baseline", overrides=overrides), seeds=(1,), steps=64, out=tmp_path / "run", threads=1)
    run(plan)
    sources = open_run(plan.out).manifest.rules
    assert [source.name for source in sources] == ["hazard", "birth"]
    assert plan.config.species["agent"].birth.rule == f"my_rules.py:birth@{sources[1].digest}"
    whole = RunPlan(load_config("baseline", overrides=overrides), seeds=(1,), steps=128, out=tmp_path / "w", threads=1)
    wanted = run(whole).world_digests
    file.write_text(RULES.replace("def ", "def _"))
    assert resume(plan.out, steps=128, threads=1).world_digests == wanted


def test_a_forecast_says_what_it_cannot_know(file):
    config = load_config("baseline", overrides=[f'hazard.rule="{file}:swamp"'])
    assert any("death comes from a rule" in warning for warning in setting_warnings(config))
    assert not any("rule" in warning for warning in setting_warnings(load_config("baseline")))


def test_a_wrong_setting_is_named():
    with pytest.raises(ConfigError, match=r"birth\.rule.*FILE\.py:NAME"):
        load_config("baseline", overrides=['birth.rule="crowded"'])
    assert "chance" in rule_columns(load_config("baseline"), "agent", "birth")
