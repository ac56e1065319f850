"""What agents eat before they learn, and the equilibria: closed forms, and directions that must hold."""

import math

import numpy as np
import pytest

from hedon.config import Config, load_config
from hedon.config.schema.life import HazardConfig
from hedon.demography.encounter import encounter_rates
from hedon.demography.food_place import draw_food_places, food_places, missing_at_start, throw
from hedon.demography.forecast import forecast
from hedon.demography.intake import FORECAST_STEPS
from hedon.demography.life import generation_time, survival
from hedon.demography.motion import unlearned_walk
from hedon.experiment.simulation import Simulation


def setting(*overrides: str) -> Config:
    return load_config("baseline", overrides=overrides)


def around(sd: float, *overrides: str) -> Config:
    """Food around the middle of the arena."""
    law = f'food.normal.placement={{form="gaussian", centers=[[240, 180]], sd=[{sd}, {sd}]}}'
    return setting(law, *overrides)


def test_where_food_grows_decides_how_much_is_eaten() -> None:
    """A world with sd 2 and one initial food eats 20 to 25 times less than one with sd 200."""
    narrow, wide = (forecast(around(sd, "food.normal.initial_count=1")).intake[0] for sd in (2.0, 200.0))
    assert narrow.places < 5
    assert wide.places == 100
    assert 10 < wide.eaten / narrow.eaten < 50
    assert narrow.growth == wide.growth == pytest.approx(0.2)


def test_a_world_that_has_no_room_for_its_first_foods_cannot_start() -> None:
    found = forecast(around(2.0))
    assert found.warnings[0].startswith("A run cannot start")
    assert "of 20 foods of the kind normal find a place" in found.warnings[0]
    assert found.intake == found.equilibria == ()
    apart = setting("food.normal.placement.spacing=150")
    assert "of 20 foods of the kind normal find a place" in missing_at_start(apart, np.random.default_rng(1))
    assert missing_at_start(setting(), np.random.default_rng(1)) == ""


def test_the_walk_of_unlearned_agents_agrees_with_the_engine() -> None:
    """In an arena without food: the mean distance of agents from the nearest wall at several times."""
    alone = ("food.normal.growth_rate=0", "food.normal.initial_count=0", "birth.kappa=0", "hazard.kappa=0")
    config = setting(*alone, "hazard.alpha_age=0", "learning.policy=random", "population.initial_count=12")
    size = np.array([480.0, 360.0])

    def depth(x: np.ndarray, y: np.ndarray) -> float:
        return float(np.minimum(np.minimum(x, size[0] - x), np.minimum(y, size[1] - y)).mean())

    simulation, measured = Simulation(config, seeds=range(20), threads=1), []
    for _ in range(4):
        simulation.run(512)
        agents = [world.agents() for world in simulation.worlds]
        x, y = (np.concatenate([each[axis] for each in agents]) for axis in "xy")
        measured.append(depth(x, y))
    rng = np.random.default_rng(1)
    start = 10 + rng.random((400, 2)) * (size - 20)
    walk = unlearned_walk(config, config.species["agent"], start[:, 0] + 1j * start[:, 1], 2048, rng)
    found = [depth(place.real, place.imag) for step, (place, _) in enumerate(walk, 1) if step % 512 == 0]
    np.testing.assert_allclose(found, measured, rtol=0.35)


def test_agents_in_the_open_sweep_the_width_of_their_mouth() -> None:
    """In a wide arena walls do not matter: the rate is speed times mouth width divided by area."""
    config = setting("arena.width=6000", "arena.height=6000", "food.normal.capacity=1000")
    own, rng = config.species["agent"], np.random.default_rng(1)
    places = rng.uniform(500, 5500, (1500, 2))
    rates = encounter_rates(config, own, [places], 1024, rng)[0]
    force, drag = 2 * (-20 + 100 * 0.5), math.exp(-0.8 * 0.1)
    kick = force * 0.1 / (0.1 * math.pi * 10**2)
    speed = 0.1 * kick * sum(drag**i for i in range(1, 6)) / (1 - drag**5)
    width = 2 * (10 + 4) * math.sin(math.radians(60))
    assert rates[1:].mean() == pytest.approx(speed * width / 6000**2, rel=0.3)


@pytest.mark.parametrize("form", ["gaussian", "rectangle", "switching", "mixture"])
def test_places_follow_their_law(form: str) -> None:
    centers = "[[100, 100]]" if form in ("gaussian", "rectangle") else "[[100, 100], [300, 200]]"
    config = setting(f'food.normal.placement={{form="{form}", centers={centers}, sd=[6, 12], drift=[0.01, 0]}}')
    food, rng = config.food["normal"], np.random.default_rng(1)
    drawn = draw_food_places(config, food, 20_000, 500, rng)
    shrink = 3.0 if form == "rectangle" else 1.0
    spread = np.array([36 / shrink, 144 / shrink])
    middle = np.array([105.0, 100.0])
    if form == "mixture":
        middle, spread = middle + np.array([100, 50]), spread + np.array([100**2, 50**2])
    np.testing.assert_allclose(drawn.mean(axis=0), middle, atol=2.5)
    np.testing.assert_allclose(drawn.var(axis=0), spread, rtol=0.08)
    second = draw_food_places(config, food, 1000, 0, rng, turn=1) if form == "switching" else middle[None] + [200, 100]
    assert second.mean(axis=0)[0] > 200


def test_as_many_foods_fit_as_do_not_touch() -> None:
    row = 'food.normal.placement={form="rectangle", centers=[[240, 180]], sd=[40, 0.0001]}'
    config = setting(row, "food.normal.initial_count=0")
    limit = food_places(config, config.food["normal"], FORECAST_STEPS, np.random.default_rng(1)).limit
    assert limit == pytest.approx(0.7476 * 80 / 8 + 0.75, abs=1), "random parking on a line"
    spaced = setting(row, "food.normal.initial_count=0", "food.normal.placement.spacing=200")
    assert food_places(spaced, spaced.food["normal"], FORECAST_STEPS, np.random.default_rng(1)).limit == 1
    nowhere = throw(lambda n: np.zeros((n, 2)), lambda places: np.zeros(len(places), bool), 1.0, 3, tries=1000)
    assert nowhere.shape == (0, 2)


def test_idle_agents_eat_nothing() -> None:
    found = forecast(setting("learning.policy=idle"))
    assert found.intake[0].eaten == found.intake[0].high == 0.0


def test_a_generation_is_the_mean_age_of_the_living() -> None:
    gompertz = HazardConfig(form="gompertz", alpha_age=1e-4, beta_age=2e-3)
    age = np.arange(0, 20_000.0)
    weight = survival(gompertz, age, 0.0)
    assert generation_time(gompertz, 0.0) == pytest.approx((age @ weight) / weight.sum(), rel=1e-3)
    constant = HazardConfig(form="constant", kappa=1e-3)
    assert generation_time(constant, np.zeros(2)) == pytest.approx(1000.0)


def test_worlds_have_as_many_generations_as_forecast() -> None:
    """Short lives without learning: generations per step in the second half, and the number alive."""
    config = setting("hazard.kappa=0.1", "hazard.alpha_age=2e-6", "birth.kappa=4e-3", "learning.policy=random")
    unlearned, _, full = forecast(config).equilibria
    simulation = Simulation(config, seeds=[1, 2, 3], threads=1)
    mean = []
    for steps in (4096, 4096):
        simulation.run(steps)
        mean.append(np.mean([world.agents()["generation"].mean() for world in simulation.worlds]))
    assert 4096 / (mean[1] - mean[0]) == pytest.approx(unlearned.generation, rel=0.6)
    assert np.mean([world.alive for world in simulation.worlds]) == pytest.approx(unlearned.alive, rel=0.6)
    assert unlearned.generation < full.generation


def test_equilibria_stay_within_bounds() -> None:
    for overrides in (("food.normal.growth_rate=50.0",), ("food.normal.growth_rate=0.0", "energy.at_zero=death")):
        config = setting(*overrides)
        for each in forecast(config).equilibria:
            assert 0 <= each.alive <= config.species["agent"].population.capacity
            assert math.isnan(each.energy) == (each.alive == 0)
            assert not each.energy < 0
            assert not each.energy > config.species["agent"].energy.capacity
