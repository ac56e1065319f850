import math

import numpy as np
import pytest
from matplotlib.path import Path as Polygon
from two_stores import FED

from hedon.config import Config, load_config
from hedon.config.schema.arena import outline
from hedon.config.schema.body import MotorConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.demography.forecast import forecast, setting_warnings
from hedon.demography.life import birth_rate, expected_lifetime, hazard
from hedon.demography.motion import fresh_force
from hedon.demography.placement import is_free, placement_success
from hedon.demography.schedule import birth_of, factor_at, mean_factor, scaled_hazard


def setting(*overrides: str) -> Config:
    return load_config("baseline", overrides=overrides)


def warnings(*overrides: str) -> str:
    return " ".join(setting_warnings(setting(*overrides)))


def test_the_papers_setting_lives_without_eating() -> None:
    found = forecast(setting())
    assert (found.levels[0].energy, round(found.levels[0].r0, 2)) == (0.0, 1.02)
    assert found.levels[0].lifetime == pytest.approx(5095, abs=1)
    assert found.levels[0].refusal == pytest.approx(1 - 1 / found.levels[0].r0)
    assert found.fed == pytest.approx(0.2 / found.need)
    assert found.warnings == setting_warnings(setting())
    assert len(found.warnings) == 1
    assert "R0 is 1.02 at energy 0" in found.warnings[0]
    populations = [level.population for level in found.levels]
    assert populations == sorted(populations)
    assert populations[-1] == 200


def test_births_that_follow_another_store_are_forecast_for_agents_full_of_it() -> None:
    water = ("store.water={capacity=20, basic_cost=0.01}", "food.normal.gives.water=1", "energy.birth_weight=0")
    by_water = setting(*water, "store.water.birth_weight=2").species["agent"]
    energy = np.array([0.0, 7.0])
    np.testing.assert_allclose(
        birth_rate(birth_of(by_water), energy), birth_rate(by_water.birth, np.array([40.0, 40.0]))
    )
    against = setting(*water, "store.water.birth_weight=-2").species["agent"]
    np.testing.assert_array_equal(birth_rate(birth_of(against), energy), birth_rate(against.birth, np.zeros(2)))
    lively = warnings(*water, "store.water.birth_weight=2", "birth.form=threshold", "birth.logit_offset=3")
    assert "Births follow water too: R0 here is that of agents full of water." in lively
    assert "cannot live" not in lively
    assert "without eating" not in lively, "an agent that eats nothing has no water"
    assert "agents without water." in warnings(*water, "store.water.birth_weight=-2")


def test_room_and_refusals_meet() -> None:
    """At the population that room allows, the chance of finding a place is 1/R0."""
    found = forecast(setting())
    level = found.levels[2]
    alive, success = zip(*((room.alive, room.success) for room in found.room), strict=True)
    assert np.interp(level.population, alive, success) == pytest.approx(1 / level.r0, abs=0.02)


def test_settings_that_cannot_live_or_die() -> None:
    assert "cannot live: R0 is 0.00" in warnings("birth.kappa=0.0")
    assert "cannot die" in warnings("hazard.kappa=0.0", "hazard.alpha_age=0.0")
    assert "need not die" in warnings("hazard.alpha_age=0.0", "hazard.beta_energy=100.0")
    assert "cannot" not in warnings()
    assert "without eating" not in warnings('energy.at_zero="death"')
    assert "without eating" not in warnings("birth.kappa=3e-4")  # R0 0.76 at energy 0
    assert "stand still: food pays for 511 agents" in warnings("food.normal.growth_rate=1.0")
    assert "10 of 50 founders; once the supply is used up, the others starve." in warnings(
        "food.normal.growth_rate=0.02"
    )
    free = forecast(setting("energy.basic_cost=0.0", "energy.action_cost=0.0"))
    assert math.isinf(free.fed)
    assert "any number of agents" in free.warnings[-1]


def test_poison_is_no_supply() -> None:
    assert forecast(load_config("poison")).supply == pytest.approx(0.2)


def test_the_force_of_a_fresh_policy() -> None:
    rng = np.random.default_rng(1)
    force = -20 + 100 / (1 + np.exp(-rng.normal(size=(400_000, 2))))
    assert fresh_force(MotorConfig()) == pytest.approx(np.linalg.norm(force, axis=1).mean(), rel=2e-3)


def test_one_parent_in_the_open_has_a_closed_form() -> None:
    """A Gaussian place misses the parent's own body with probability exp(−(2r)²/(2·sd²))."""
    open_air = ("arena.width=1e5", "arena.height=1e5", "food.normal.initial_count=0", "birth.attempts=1")
    config = setting(*open_air, "birth.distance_sd=20.0", "population.initial_count=1")
    rng = np.random.default_rng(2)
    once = placement_success(config, "agent", [1], rng, scenes=4000)[0]
    assert once == pytest.approx(math.exp(-0.5), abs=0.025)  # three standard errors
    thrice = setting(*open_air[:3], "birth.attempts=3", "birth.distance_sd=20.0", "population.initial_count=1")
    found = placement_success(thrice, "agent", [1], rng, 4000)[0]
    assert found == pytest.approx(1 - (1 - math.exp(-0.5)) ** 3, abs=0.015)


def rim(count: int) -> np.ndarray:
    """Points on a circle of radius 1 around 0."""
    angle = np.linspace(0, 2 * math.pi, count)
    return np.column_stack([np.cos(angle), np.sin(angle)])


def test_free_places_follow_the_engines_rules() -> None:
    config = setting("arena.inner_walls=[[200.0, 100.0, 200.0, 200.0]]")
    rng = np.random.default_rng(3)
    places = rng.uniform(-20, 500, (3000, 2))
    nothing = np.empty((0, 2))
    free = is_free(config, 10.0, places, nothing, nothing)
    polygon = Polygon(outline(config.arena))
    for (x, y), found in zip(places.tolist(), free.tolist(), strict=True):
        clear = math.hypot(x - 200, y - min(max(y, 100), 200)) >= 10
        if found:
            assert clear
            assert polygon.contains_points([x, y] + 9.999 * rim(73)).all()
        elif clear:
            assert not polygon.contains_points([x, y] + 10.02 * rim(721)).all()
    at = np.array([[240.0, 180.0], [259.9, 180.0], [260.1, 180.0], [240.0, 193.9], [240.0, 194.1]])
    assert is_free(config, 10.0, at, at[:1], nothing).tolist() == [False, False, True, False, False]
    assert is_free(config, 10.0, at, nothing, at[:1]).tolist() == [False, True, True, False, True]


def test_a_hazard_on_a_schedule_is_forecast_at_its_mean_and_range() -> None:
    """The mean over a period is exact; at each end of the range, lifetimes are those at that factor."""
    year = "hazard.schedule.scale={points=[[0, 0.5], [300, 2.0]], period=1000}"
    config, plain = load_config("baseline", overrides=[year]), load_config("baseline")
    mean = 0.3 * 0.5 + 0.7 * 2.0
    found = forecast(config)
    for level in found.levels:
        scaled = scaled_hazard(plain.species["agent"].hazard, mean)
        assert level.lifetime == pytest.approx(float(expected_lifetime(scaled, level.energy)), rel=1e-12)
    text = next(each for each in found.warnings if each.startswith("The chance of death follows a schedule"))
    assert "from 0.5 to 2 times what is set" in text
    assert f"the mean over a period, {mean:g}" in text
    for factor in (0.5, 2.0):
        hazard = scaled_hazard(plain.species["agent"].hazard, factor)
        assert f"{float(expected_lifetime(hazard, 400.0)):,.0f} steps" in text


def test_what_a_store_adds_to_the_hazard_follows_its_schedule() -> None:
    def higher(*overrides: str) -> float:
        config = load_config("baseline", overrides=[*FED, *overrides])
        (said,) = [each for each in forecast(config).warnings if each.startswith("Without nutrient the chance")]
        return float(said.split(" is ")[1].split(" per step")[0])

    assert higher("hazard.schedule.scale.points=[[0, 10.0]]") == pytest.approx(10.0 * higher(), rel=0.01)


def test_scaled_chances_are_the_hazard_times_the_factor() -> None:
    config = load_config("baseline").species["agent"].hazard
    for age, energy in ((0.0, 0.0), (50_000.0, 5.0), (900_000.0, 100.0)):
        expected = 3.0 * float(hazard(config, age, energy))
        assert float(hazard(scaled_hazard(config, 3.0), age, energy)) == pytest.approx(expected)


@pytest.mark.parametrize("form", ["steps", "linear"])
@pytest.mark.parametrize("period", [0, 997])
def test_the_mean_of_a_schedule_is_the_mean_over_its_steps(form: str, period: int) -> None:
    points = ((0, 0.3), (100, 1.7), (613, 0.9))
    schedules = {"scale": ScheduleConfig(points=points, form=form, period=period)}  # pyright: ignore[reportArgumentType]
    expected = factor_at(schedules, "scale", np.arange(period)).mean() if period else 0.9
    assert mean_factor(schedules, "scale") == pytest.approx(expected, rel=1e-12)


def test_growth_on_a_schedule_is_reported_with_its_range() -> None:
    growth = "food.normal.schedule.growth_rate={points=[[0, 0.1], [500, 2.0]], period=1000}"
    found = forecast(load_config("baseline", overrides=[growth]))
    plain = forecast(load_config("baseline"))
    assert found.supply == pytest.approx(1.05 * plain.supply)
    text = next(each for each in found.warnings if each.startswith("Growth follows a schedule"))
    assert f"food pays for {0.1 * plain.fed:,.0f} to {2 * plain.fed:,.0f} agents" in text
    short = next(each for each in found.warnings if each.startswith("At first"))
    assert f"is enough for {0.1 * plain.fed:,.0f} of" in short, "at the start growth is at its lowest"


def test_warnings_fit_what_a_species_eats() -> None:
    config = load_config("predator")
    said = {name: " ".join(setting_warnings(config, name)) for name in config.species}
    assert "It eats no food, but prey" in said["predator"]
    assert "pays for" not in said["predator"]
    assert "It is eaten by predator" in said["prey"]
    assert math.isnan(forecast(config, "predator").fed)


def test_a_fresh_force_scales_with_the_motors() -> None:
    assert fresh_force(MotorConfig(force_scale=1.5)) == pytest.approx(1.5 * fresh_force(MotorConfig()))
