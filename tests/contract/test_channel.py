"""Channels that are paid for, observed or used as a gate by name, and the names that are refused."""

import math

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon import _engine
from hedon.config import ConfigError, load_config
from hedon.config.engine import engine_input
from hedon.config.layout import layouts, observation_columns
from hedon.error import EngineError
from hedon.experiment.simulation import Simulation

ALIKE = ("genome.mutation_scale=0", "reward.meal_coef=0", "reward.action_coef=0")
FERTILE = (*QUICK, *DEATHLESS, *ALIKE, "birth.kappa=0.2", "birth.beta=100", "population.initial_count=20")


def pay(channel: str, name: str = "it") -> tuple[str, ...]:
    """A term whose weight is 1 for every agent."""
    gene = f"reward.pay.{name}.gene"
    return (f"reward.pay.{name}.channel={channel}", f"{gene}.initial_mean=1", f"{gene}.initial_sd=0")


def rewards(simulation: Simulation, step: int) -> np.ndarray:
    """The reward of each living agent in a step of the first window."""
    world = simulation.worlds[0]
    return world.view("reward").reshape(len(world.view("alive")), -1)[world.living, step].astype(float)


def observed(simulation: Simulation, *names: str) -> np.ndarray:
    world = simulation.worlds[0]
    columns = observation_columns(world.config, "agent")
    return world.observations(0)[:, [columns.index(name) for name in names]]


def test_a_parent_is_paid_for_its_child_one_step_later() -> None:
    simulation = make_simulation(*FERTILE, *pay("births"))
    world, before, paid = simulation.worlds[0], {}, 0
    for step in range(20):
        bred = dict(zip(world.agents()["agent_id"].tolist(), world.view("births")[world.living].tolist(), strict=True))
        simulation.run(1)
        found = dict(zip(world.agents()["agent_id"].tolist(), rewards(simulation, step).tolist(), strict=True))
        assert {key: found[key] for key in bred} == bred
        children = dict(zip(world.agents()["agent_id"].tolist(), world.agents()["children"].tolist(), strict=True))
        now = dict(zip(world.agents()["agent_id"].tolist(), world.view("births")[world.living].tolist(), strict=True))
        assert now == {key: count - before.get(key, 0) for key, count in children.items()}
        before, paid = children, paid + sum(bred.values())
    assert paid > 20


def test_the_results_of_a_step_are_observed_in_the_next_one_and_as_0_by_newborns() -> None:
    simulation = make_simulation(*FERTILE, "sensor.observes.moved=0.5", "sensor.observes.energy_change=0.1")
    world = simulation.worlds[0]
    assert not observed(simulation, "moved", "energy_change").any()
    newborns = 0
    for _ in range(10):
        before = world.agents()
        simulation.run(1)
        now, seen = world.agents(), observed(simulation, "moved", "energy_change")
        born = now["birth_step"] == world.step
        assert not seen[born].any()
        newborns += born.sum()
        assert now["agent_id"][: len(before["x"])].tolist() == before["agent_id"].tolist()
        moved = np.hypot(*(now[axis][: len(before["x"])] - before[axis] for axis in ("x", "y")))
        assert seen[~born, 0] == pytest.approx(moved / 0.5, rel=1e-3, abs=1e-4)
        assert seen[~born, 1].any()
    assert newborns > 10


@pytest.mark.parametrize(("channel", "array", "wrong"), [("births", "births", -1), ("moved", "last", np.nan)])
def test_values_kept_from_a_step_survive_a_checkpoint(channel: str, array: str, wrong: float) -> None:
    settings = (*FERTILE, f"sensor.observes.{channel}=1", *pay(channel))
    one, two = make_simulation(*settings), make_simulation(*settings)
    for simulation in (one, two):
        simulation.run(9)
    assert observed(one, channel).any()
    two.engine.restore(0, two.engine.save(0))
    for simulation in (one, two):
        simulation.run(60)
    assert one.worlds[0].digest() == two.worlds[0].digest()
    saved = dict(two.engine.save(0))
    saved[array] = np.full_like(saved[array], wrong)
    with pytest.raises(ValueError, match=f"{array} holds"):
        two.engine.restore(0, saved)


def test_threads_and_other_worlds_do_not_change_channels() -> None:
    settings = (*FERTILE, *pay("all_kin"), *pay("all_meals", "shared"), "sensor.observes.food_distance=5")
    settings += ("sensor.observes.touched=6", "sensor.observes.all_meals=1")
    settings += ("neighbor.all.range=80", 'neighbor.food.of=["normal"]')
    alone = make_simulation(*settings, seeds=[3])
    together = make_simulation(*settings, seeds=[2, 3], threads=2)
    for simulation in (alone, together):
        simulation.run(100)
    assert alone.worlds[0].digest() == together.worlds[1].digest()
    assert alone.worlds[0].agents()["reward"].any()


def test_only_neighbors_within_the_range_are_near() -> None:
    plain = (*QUICK, *STILL, *DEATHLESS, *CHILDLESS, *ALIKE, "food.normal.growth_rate=0", "neighbor.close.range=50")
    of = ('neighbor.grain.of=["normal"]', "neighbor.grain.range=50", 'neighbor.all.of=["normal", "*"]')
    names = ("close_count", "grain_count", "all_count", "grain_distance", "grain_bearing", "all_distance")
    simulation = make_simulation(
        *plain, *of, *pay("all_count"), "neighbor.all.range=50", *(f"sensor.observes.{each}=1" for each in names)
    )
    agents = [(100, 100, 0.0), (149.9, 100, 1.0), (150.1, 100.0, 2.0), (100, 300, 0.0)]
    set_scene(simulation, agents, [(100, 140), (100, 151), (70, 70)])
    ahead, behind = 0.0, math.atan2(30, -30)  # bearings of the grains at (100, 140) and (70, 70)
    seen = observed(simulation, *names)
    assert seen[:, :3].tolist() == [[1, 2, 3], [2, 0, 2], [1, 0, 1], [0, 0, 0]]
    np.testing.assert_allclose(seen[:, 3], [40, 50, 50, 50])
    np.testing.assert_allclose(seen[:, 4], [ahead, 0, 0, 0], atol=1e-6)
    np.testing.assert_allclose(seen[:, 5], [40, 0.2, 0.2, 50], atol=1e-4)
    set_scene(simulation, agents, [(70, 70)])
    np.testing.assert_allclose(observed(simulation, *names)[0, 3:5], [math.hypot(30, 30), math.pi / 2 + behind / 3])
    simulation.run(1)
    assert rewards(simulation, 0).tolist() == [2, 2, 1, 0]


def test_the_year_is_set_by_the_first_schedule_or_by_its_own_setting() -> None:
    year = "food.normal.schedule.growth_rate={points=[[0, 1.0], [5, 2.0]], period=40}"
    for settings, period in ((year,), 40), ((year, "sensor.season_period=16"), 16):
        names = ("season_sine", "season_cosine")
        simulation = make_simulation(*QUICK, *settings, *(f"sensor.observes.{name}=1" for name in names))
        for step in (0, 7, 23):
            simulation.run(step - simulation.worlds[0].step)
            angle = 2 * np.pi * (step % period) / period
            assert observed(simulation, *names)[0] == pytest.approx([np.sin(angle), np.cos(angle)], abs=1e-6)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (['reward.gate="enrgy"'], r"reward\.gate: there is no channel 'enrgy' here.* did you mean energy\?"),
        (["reward.pay.movd={}"], r"reward\.pay\.movd: there is no channel 'movd' here.* did you mean moved\?"),
        (['reward.pay.a.channel="damage"'], r"reward\.pay\.a\.channel: there is no channel 'damage' here"),
        (["reward.pay.A={}"], r"reward\.pay\.A: a name must have only a-z"),
        (["reward.pay.x={}", 'sensor.observes={"x" = 0}'], r"sensor\.observes\.x = 0"),
        (["sensor.observes.energy=1"], r"sensor\.observes\.energy = 1.*: it observes this already"),
        (["sensor.observes.sight=1"], r"sensor\.observes\.sight: there is no channel"),
        (['reward.gate="season_sine"'], r"sensor\.season_period gives a year where no schedule does"),
        (['reward.gate="waits"'], r"reward\.gate: there is no channel 'waits' here"),
        (["store.moved.capacity=1", "reward.pay.moved={}"], r"2 channels are called moved: rename a food"),
        (["reward.pay.normal.channel=age"], "two genes would have the name w_normal"),
        (["store.eaten_normal.capacity=1"], "a store's name must not begin with eaten_"),
        (
            [f"sensor.observes.{name}=1" for name in ("age", "moved", "step", "alive", "x", "y", "births", "touched")]
            + [f"sensor.observes.{name}=1" for name in ("effort", "force", "nearness", "one", "see_wall", "see_agent")]
            + ["sensor.observes.force_left=1"],
            r"sensor\.observes = .*: must have at most 14 channels beside 1 stores",
        ),
    ],
)
def test_invalid_names_are_refused(settings: list[str], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=settings)


def test_a_rule_gets_a_paid_channel_only_once() -> None:
    layout = layouts(load_config("baseline", overrides=["reward.pay.moved={}", "reward.pay.spent.channel=moved"]))
    names = [channel.name for channel in layout["agent"].recorded]
    assert "moved" not in names
    assert [term.name for term in layout["agent"].terms] == ["normal", "action", "moved", "spent"]


@pytest.mark.parametrize(
    ("source", "index"),
    [
        ("meals", 1),
        ("damage", 0),
        ("waits", 0),
        ("neighbor_count", 0),
        ("neighbor_meals", 0),
        ("last", 0),
        ("contacts", 3),
    ],
)
def test_the_engine_refuses_an_index_that_a_source_does_not_have(source: str, index: int) -> None:
    native = engine_input(load_config("baseline", overrides=["reward.pay.moved={}"]))
    native.settings["layout"][0]["terms"][-1]["channel"] |= {"source": source, "index": index}
    with pytest.raises(
        EngineError, match=r"layout\[0\]\.terms\[2\]\.channel\.index = \d+: must be a number of its source"
    ):
        _engine.Simulation(native.settings, native.walls, native.outer_walls, [1])
