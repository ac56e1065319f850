"""What depends on time: growth, capacity and hazard, and where food appears."""

import math

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation

from hedon.config import ConfigError, load_config
from hedon.config.schema.schedule import ScheduleConfig
from hedon.demography.schedule import factor_at, mean_factor

FOOD = "food.normal.schedule."
ALONE = (*QUICK, *STILL, *DEATHLESS, *CHILDLESS, "population.initial_count=1")


def supply(steps: int, *settings: str) -> np.ndarray:
    """The internal number of foods after each step of a world in which no agent eats."""
    simulation = make_simulation(*ALONE, "food.normal.initial_count=0", "sensor.mouth_spread=1e-3", *settings)
    numbers = []
    for _ in range(steps):
        simulation.run(1)
        numbers.append(float(simulation.worlds[0].view("food_stock.number")[0]))
    return np.array(numbers)


SCHEDULES = [
    ScheduleConfig(((0, 1.0), (10, 0.25), (30, 3.0)), "steps", 0),
    ScheduleConfig(((5, 1.0), (10, 0.25), (30, 3.0)), "linear", 0),
    ScheduleConfig(((5, 1.0), (10, 0.0), (30, 3.0)), "steps", 40),
    ScheduleConfig(((5, 1.0), (10, 0.0), (30, 3.0)), "linear", 40),
]


@pytest.mark.parametrize("schedule", SCHEDULES, ids=lambda s: f"{s.form}-{s.period}")
def test_growth_follows_the_schedule(schedule):
    points = [list(point) for point in schedule.points]
    numbers = supply(
        100,
        f"{FOOD}growth_rate={{points={points}, form='{schedule.form}', period={schedule.period}}}",
        "food.normal.capacity=1000",
    )
    factors = factor_at({"growth_rate": schedule}, "growth_rate", np.arange(100))
    assert numbers == pytest.approx(0.2 * np.cumsum(factors), rel=1e-6)
    assert np.ptp(factors) > 2


def test_factors_by_hand():
    yearly = {"growth_rate": SCHEDULES[3]}
    assert factor_at(yearly, "growth_rate", [5, 7, 10, 20, 35, 40, 0, 81]) == pytest.approx(
        [1.0, 0.6, 0.0, 1.5, 3 - 2 * 5 / 15, 3 - 2 * 10 / 15, 3 - 2 * 10 / 15, 3 - 2 * 11 / 15]
    )
    assert mean_factor(yearly, "growth_rate") == pytest.approx((5 * 0.5 + 20 * 1.5 + 15 * 2.0) / 40, rel=1e-3)
    assert mean_factor(yearly, "capacity") == 1.0


def test_a_capacity_that_falls_stops_growth():
    numbers = supply(60, f"{FOOD}capacity={{points=[[0, 0.1], [30, 0.05]]}}", "food.normal.growth_rate=1")
    assert numbers[[20, 40, 59]] == pytest.approx([10, 5, 5])
    assert numbers[4] == 5


def test_the_hazard_follows_its_schedule():
    def deaths(*settings: str) -> int:
        common = ("hazard.alpha_age=0.01", "hazard.kappa=0", "hazard.beta_age=0")
        simulation = make_simulation(*QUICK, *CHILDLESS, *common, *settings)
        simulation.run(64)
        return int(simulation.worlds[0].counters["deaths"])

    calm, plain = deaths("hazard.schedule.scale.points=[[0, 0.0]]"), deaths()
    late = deaths("hazard.schedule.scale.points=[[0, 0.0], [32, 1.0]]")
    assert calm == 0
    assert 0 < late < plain
    expected = 50 * (1 - math.exp(-0.01 * 64))
    assert abs(plain - expected) < 4 * math.sqrt(expected)


def places(*settings: str, steps: int = 60) -> np.ndarray:
    simulation = make_simulation(
        *ALONE, "food.normal.initial_count=0", "food.normal.growth_rate=3", "food.normal.capacity=500", *settings
    )
    simulation.run(steps)
    foods = simulation.worlds[0].foods()
    return np.column_stack([foods["x"], foods["y"]])


def test_a_rectangle_holds_all_food():
    found = places(
        "food.normal.placement={form='rectangle', centers=[[200.0, 150.0]], sd=[120.0, 60.0]}",
    )
    assert len(found) > 100
    assert (np.abs(found - [200, 150]) <= [120, 60]).all()
    assert (np.ptp(found, axis=0) > [200, 100]).all()


def test_a_mixture_uses_every_center():
    centers = np.array([[100.0, 100.0], [380.0, 100.0], [240.0, 260.0]])
    found = places(f"food.normal.placement={{form='mixture', centers={centers.tolist()}, sd=[8.0, 8.0]}}")
    near = np.linalg.norm(found[:, None] - centers, axis=2).argmin(axis=1)
    assert np.bincount(near, minlength=3).min() > 10
    assert np.linalg.norm(found - centers[near], axis=1).max() < 50


def test_centers_drift_to_the_end_of_the_arena():
    found = places(
        "food.normal.placement={form='gaussian', centers=[[100.0, 180.0]], sd=[1.0, 60.0], drift=[5.0, 0.0]}",
        steps=90,
    )
    assert found[:, 0].min() < 110
    assert 440 < found[:, 0].max() <= 480


def test_foods_keep_their_distance():
    found = places("food.normal.placement.spacing=30")
    apart = np.linalg.norm(found[:, None] - found, axis=2)[~np.eye(len(found), dtype=bool)]
    assert len(found) > 40
    assert apart.min() >= 30


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        (f"{FOOD}growthrate.points=[[0, 1.0]]", "this cannot follow a schedule here.*did you mean growth_rate"),
        (f"{FOOD}growth_rate.points=[[10, 1.0], [10, 2.0]]", "steps must rise"),
        (f"{FOOD}growth_rate={{points=[[10, 1.0]], period=10}}", "steps must lie below period = 10"),
        (f"{FOOD}capacity.points=[[0, 1.5]]", "factors must be from 0 to 1"),
        (f"{FOOD}growth_rate.form=linear", "must have at least one point"),
        ("hazard.schedule.kappa.points=[[0, 1.0]]", "this cannot follow a schedule here"),
        ("food.normal.placement={form='mixture', centers=[[9.0, 9.0]], sd=[1.0, 1.0]}", "at least two centers"),
    ],
)
def test_meaningless_settings_are_refused(setting, message):
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=[setting])
