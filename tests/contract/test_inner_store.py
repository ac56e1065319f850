"""Stores other than energy, compared with their equations in NumPy."""

import math

import numpy as np
import polars as pl
import pytest
from two_stores import STORES
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config import ConfigError, load_config
from hedon.config.layout import observation_columns
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.reader import open_run
from hedon.record.schema import CAUSES

NUTRIENT = (
    *STORES[:3],
    "food.normal.gives.nutrient=1",
    "store.nutrient.basic_cost=0.05",
    "store.nutrient.action_cost=1e-3",
)
TOXIN = (*STORES[3:], "food.normal.gives.toxin=10")
ALL_EAT = ("sensor.mouth_spread=180",)
ALONE = (*QUICK, *DEATHLESS, *CHILDLESS, "food.normal.growth_rate=0")


def sigmoid(x: float) -> float:
    return 1 / (1 + math.exp(-x))


def test_the_stores_follow_their_equations():
    settings = (*QUICK, *DEATHLESS, *CHILDLESS, *ALL_EAT, *NUTRIENT, *TOXIN, "store.nutrient.capacity=40.5")
    simulation = make_simulation(
        *settings, "food.normal.growth_rate=3", "store.toxin.basic_cost=0.3", "food.normal.initial_count=100"
    )
    world = simulation.worlds[0]
    nutrient, toxin = np.full(world.alive, 40.0), np.zeros(world.alive)
    before = now = world.agents()
    capped = 0
    for _ in range(150):
        simulation.run(1)
        now = world.agents()
        eaten = now["eaten"][:, 0] - before["eaten"][:, 0]
        force = np.hypot(now["force_left"] - before["force_left"], now["force_right"] - before["force_right"])
        wanted = nutrient + eaten - 1e-3 * force - 0.05
        capped += (wanted > 40.5).sum()
        nutrient = np.clip(wanted, 0, 40.5)
        toxin = np.maximum(0, toxin + 10 * eaten - 0.3)
        before = now
        assert now["nutrient"] == pytest.approx(nutrient, abs=1e-5)
        assert now["toxin"] == pytest.approx(toxin, abs=1e-5)
    assert toxin.max() > 5
    assert np.ptp(nutrient) > 1
    assert capped > 0
    assert (now["nutrient"] >= 0).all()


def test_toxin_takes_its_share_of_the_force():
    simulation = make_simulation(*ALONE, *ALL_EAT, *TOXIN, "learning.policy=external", "store.toxin.basic_cost=0")
    set_scene(simulation, [(100, 100, 0.0)], [(100, 110)])
    world = simulation.worlds[0]
    capacity = len(world.view("alive"))
    simulation.engine.set_actions(0, np.full((1, capacity, 2), 2.0, np.float32))
    full = -20 + 100 * sigmoid(2.0)
    forces = []
    for _ in range(2):
        before = world.agents()["force_left"][0]
        simulation.run(1)
        forces.append(float(world.agents()["force_left"][0] - before))
    assert world.agents()["toxin"][0] == 10.0
    left = (1 - sigmoid(10 - 5)) / (1 - sigmoid(-5))
    assert forces == pytest.approx([full, full * left], rel=1e-5)


def test_an_empty_store_raises_the_hazard():
    """Deaths among many agents with energy but no nutrient, compared with the probability in closed form."""

    def died(share: float) -> int:
        settings = ("population.capacity=150", "population.initial_count=150", "arena.width=900", "arena.height=900")
        hazard = ("hazard.alpha_age=0", "hazard.kappa=0.05", "energy.basic_cost=0", "store.nutrient.initial=0")
        simulation = make_simulation(
            *QUICK, *STILL, *CHILDLESS, *settings, *hazard, *NUTRIENT, f"store.nutrient.hazard_weight={share}"
        )
        simulation.run(64)
        return 150 - simulation.worlds[0].alive

    x = 0.02
    chance = 0.2 * 5 * 0.05 * x / (1 + x)  # the hazard of an empty store at a weight of 1
    expected = 150 * (1 - (1 - chance) ** 64)
    assert abs(died(1.0) - expected) < 4 * math.sqrt(expected)
    assert died(0.0) <= 1  # with 40 units of energy, the hazard is nearly 0


def test_a_child_gets_its_share_and_no_toxin():
    settings = (
        "birth.kappa=1",
        "birth.beta=10",
        *NUTRIENT,
        *TOXIN,
        "store.nutrient.basic_cost=0",
        "store.nutrient.action_cost=0",
    )
    simulation = make_simulation(*QUICK, *STILL, *DEATHLESS, *settings, "food.normal.growth_rate=0")
    set_scene(simulation, [(200, 200, 0.0)])
    simulation.run(1)
    world = simulation.worlds[0]
    assert world.alive == 2
    assert world.agents()["nutrient"].tolist() == pytest.approx([24.0, 16.0])
    assert world.agents()["toxin"].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("scaling", "factors"), [("raw", (1, 1)), ("unit", (0.01, 0.1))])
def test_stores_are_observed(scaling, factors):
    simulation = make_simulation(
        *ALONE, *ALL_EAT, *NUTRIENT, *TOXIN, 'sensor.smells=["normal"]', f"sensor.scaling={scaling}"
    )
    set_scene(simulation, [(100, 100, 0.0)], [(100, 110)])
    simulation.run(1)
    world = simulation.worlds[0]
    columns = observation_columns(world.config, "agent")
    assert columns[-4:] == ("energy", "nutrient", "toxin", "smell_normal_0")
    seen = dict(zip(columns, world.observations()[0].tolist(), strict=True))
    lives = world.agents()
    assert seen["nutrient"] == pytest.approx(lives["nutrient"][0] * factors[0], rel=1e-6)
    assert seen["toxin"] == pytest.approx(9.99 * factors[1], rel=1e-6)
    blind = load_config("baseline", overrides=[*NUTRIENT, *TOXIN, "store.toxin.observed=false"])
    assert "toxin" not in observation_columns(blind, "agent")
    assert "nutrient" in observation_columns(blind, "agent")


def test_drive_reduction_counts_all_stores():
    """Homeostasis of energy, nutrient and toxin: the need before minus the need after, with genes as set points."""
    settings = ("reward.drive_reduction_coef=1", "reward.meal_coef=0", "reward.action_coef=0", "energy.basic_cost=0.5")
    points = {"energy": 0.3, "store.nutrient": 0.5, "store.toxin": 0.1}
    genes = [f"{name}.set_point.initial_{what}" for name in points for what in ("mean", "sd")]
    values = [value for mean in points.values() for value in (mean, 0.0)]
    simulation = make_simulation(
        *ALONE, *ALL_EAT, *NUTRIENT, *TOXIN, *settings, *(f"{g}={v}" for g, v in zip(genes, values, strict=True))
    )
    set_scene(simulation, [(100, 100, 0.0)], [(100, 110)])
    world = simulation.worlds[0]

    def need() -> float:
        lives = world.agents()
        held = [
            lives["energy"][0] / 400,
            lives["nutrient"][0] / 400 if "nutrient" in lives else 0,
            lives["toxin"][0] / 5,
        ]
        return math.dist(list(points.values()), held)

    before = need()
    simulation.run(1)
    paid = world.view("life.reward")[world.living[0]]
    assert paid == pytest.approx(before - need(), rel=1e-5)
    assert abs(paid) > 0.5  # it has eaten toxin


def test_records_and_checkpoints_hold_the_stores(tmp_path):
    from hedon.record.schema import columns_of

    config = load_config("baseline", overrides=[*NUTRIENT, *TOXIN])
    assert columns_of(config).stores == ("nutrient", "toxin")
    assert columns_of(load_config("baseline")).stores == ()
    one, two = (make_simulation(*QUICK, *ALL_EAT, *NUTRIENT, *TOXIN, threads=threads) for threads in (1, 2))
    one.run(192)
    two.run(100)
    two.engine.restore(0, two.engine.save(0))
    two.run(92)
    assert one.worlds[0].digest() == two.worlds[0].digest()
    assert one.worlds[0].agents()["toxin"].max() > 0


def test_a_species_without_a_store_holds_none_of_it(tmp_path):
    small = ("population.capacity=20", "population.initial_count=6")
    species = (
        "species.grazer.body.radius=10",
        "species.moth.diet.eats=[]",
        "species.moth.store.nutrient=false",
        *DEATHLESS,
        "birth.kappa=0.02",
    )
    config = load_config("baseline", overrides=(*QUICK, *small, *STORES[:3], "food.normal.gives.nutrient=1", *species))
    run(RunPlan(config, (1,), 128, tmp_path / "run", 1))
    simulation = make_simulation(*QUICK, *small, *STORES[:3], "food.normal.gives.nutrient=1", *species)
    simulation.run(128)
    agents = simulation.worlds[0].agents()
    assert set(agents["species"]) == {0, 1}
    assert (agents["nutrient"] > 0).tolist() == (agents["species"] == 0).tolist()
    rows = open_run(tmp_path / "run").population()
    for name, known in (("grazer", True), ("moth", False)):
        means = rows.filter(pl.col("species") == name)["nutrient_mean"]
        assert means.is_not_null().to_list() == [known] * len(means)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["store.water.basic_cost=1"], r"store\.water: there is no such store \(known: none\); .* its capacity"),
        ([*STORES, "store.toxn.basic_cost=1"], r"store\.toxn: .*known: nutrient, toxin.*did you mean toxin"),
        (["food.normal.gives.watr=1", "store.water.capacity=3"], r"food\.normal\.gives\.watr: .*did you mean water"),
        (["food.normal.needs.water=-1", "store.water.capacity=3"], r"food\.normal\.needs.water = -1.*from 0"),
        (["store.water={capacity=3, initial=4}"], r"store\.water\.initial = 4\.0: must be at most its capacity = 3"),
        (["store.alive.capacity=3"], r"store\.alive: .*not be one of energy"),
        (["store.age.capacity=3"], r"store\.age: .*not be one of energy, age"),
        ([f"store.s{i}.capacity=3" for i in range(8)], "at most 8 stores with energy, not 9"),
        ([f"store.s{i}.capacity=3" for i in range(7)] + ["sensor.smells=['*']", "sensor.noses=2"], None),
        (
            ["species.a.store.water.capacity=3", "species.b={}", "food.normal.needs.water=1"],
            r"species\.b\.diet\.eats: it needs water, which it could never hold",
        ),
        (["food.normal.nutrient=1"], r"food\.normal\.nutrient: is called food\.normal\.gives\.nutrient now"),
        (["nutrient.initial=1"], r"nutrient\.initial: is called store\.nutrient\.initial now"),
    ],
)
def test_contradictions_are_refused_by_name(settings, message):
    if message is None:
        load_config("baseline", overrides=settings)
        return
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=settings)


def test_an_agent_that_lacks_what_a_food_needs_leaves_it():
    settings = ("store.salt={capacity=9, initial=1.0, basic_cost=0.25}", "food.normal.gives.salt=0.1")
    for need, eats in ((1.0, True), (1.001, False)):
        simulation = make_simulation(*ALONE, *ALL_EAT, *STILL, *settings, f"food.normal.needs.salt={need}")
        set_scene(simulation, [(100, 100, 0.0)], [(100, 110)])
        simulation.run(1)
        world = simulation.worlds[0]
        assert world.agents()["eaten"][0, 0] == eats
        assert len(world.foods()["x"]) == 1 - eats
        assert world.agents()["salt"][0] == pytest.approx(0.75 + 0.1 * eats, rel=1e-6)


def test_a_store_can_decay_and_kill():
    settings = ("store.air={capacity=9, initial=8.0, decay=0.5, basic_cost=0.1, at_zero='death'}",)
    simulation = make_simulation(*ALONE, *STILL, *settings)
    set_scene(simulation, [(100, 100, 0.0)])
    world, air = simulation.worlds[0], 8.0
    while air * 0.5 - 0.1 >= 0:
        simulation.run(1)
        air = air * 0.5 - 0.1
        assert world.agents()["air"] == pytest.approx([air])
    simulation.run(1)
    assert world.alive == 0
    assert world.deaths()["cause"].tolist() == [CAUSES.index("starved")]
