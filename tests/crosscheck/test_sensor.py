"""Senses compared with readings of the paper's program or, where there are none, with geometry."""

import math
from pathlib import Path

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, STILL, make_simulation, set_scene

SCENES = sorted((Path(__file__).parents[1] / "data" / "sensors").glob("*.npz"))
AGENT, FOOD, WALL = 0, 1, 2


def _simulation_for(scene):
    width, height = (float(v) for v in scene["size"])
    two_kinds = scene["sensor"].shape[2] == 4
    foods = ("food.normal.capacity=200",) + (("food.poor.capacity=200",) if two_kinds else ())
    size = (f"arena.width={width}", f"arena.height={height}")
    return make_simulation(*foods, *size, preset="poor" if two_kinds else "baseline")


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_rays_match_the_released_code(path):
    scene = np.load(path)
    simulation = _simulation_for(scene)
    agents = np.column_stack([scene["agent_xy"], scene["agent_angle"]])
    set_scene(simulation, agents, scene["food_xy"], scene["food_kind"])
    np.testing.assert_allclose(simulation.worlds[0].rays(), scene["sensor"], atol=1e-4)


def test_there_are_scenes():
    assert len(SCENES) == 8


def test_a_ray_that_starts_inside_another_body_reads_one():
    simulation = make_simulation()
    # The other body's surface is 5 u ahead of our center: every ray starts within it or sees nothing nearer.
    set_scene(simulation, [(240, 180, 0.0), (240, 195, 0.0)])
    rays = simulation.worlds[0].rays()[0]
    assert rays[12, AGENT] == 1.0
    assert rays[12, FOOD] == -1.0


def test_a_ray_that_starts_beyond_a_wall_reads_one():
    simulation = make_simulation()
    set_scene(simulation, [(240, 355, 0.0)])
    rays = simulation.worlds[0].rays()[0]
    assert np.all(rays[8:16, WALL] == 1.0)


def test_under_the_released_rule_a_ray_reads_what_is_behind_the_body_it_starts_in():
    simulation = make_simulation('sensor.ray_inside="behind"')
    set_scene(simulation, [(240, 180, 0.0), (240, 195, 0.0)], [(240, 250)])
    rays = simulation.worlds[0].rays()[0]
    assert rays[11:13, AGENT].tolist() == [-1.0, -1.0]
    # The middle two of 24 rays are 2.6 degrees off the heading, so they meet the food's rim somewhat later.
    np.testing.assert_allclose(rays[11:13, FOOD], 1 - (250 - 4 - 190) / 200, atol=0.02)
    # From outside, nothing changes: a body ahead is seen as usual.
    set_scene(simulation, [(240, 180, 0.0), (240, 230, 0.0)])
    assert simulation.worlds[0].rays()[0, 12, AGENT] == pytest.approx(1 - 30 / 200, abs=2e-3)


def test_under_the_released_rule_a_ray_that_starts_beyond_a_wall_misses_it():
    simulation = make_simulation('sensor.ray_inside="behind"')
    set_scene(simulation, [(240, 355, 0.0)])
    rays = simulation.worlds[0].rays()[0]
    assert np.all(rays[8:16, WALL] == -1.0)
    set_scene(simulation, [(240, 345, 0.0)])  # the ray starts 5 u in front of it
    assert simulation.worlds[0].rays()[0, 12, WALL] == pytest.approx(1 - 5 / 200, abs=2e-3)


@pytest.mark.parametrize(("rule", "seen"), [("gone", [-1.0, -1.0]), ("seen", [1.0, -1.0])])
def test_eaten_food_is_seen_for_one_more_step_under_the_released_rule(rule, seen):
    simulation = make_simulation(
        *STILL, *DEATHLESS, *CHILDLESS, f"world.eaten_food={rule}", "food.normal.growth_rate=0"
    )
    set_scene(simulation, [(240, 180, 0.0)], [(240, 193)])
    world = simulation.worlds[0]
    assert world.rays()[0, 12, FOOD] == 1.0
    simulation.run(1)
    assert world.view("food_stock.eaten")[0] == 1
    after = [world.observations()[0, :72].reshape(24, 3)[12, FOOD]]
    simulation.run(1)
    after.append(world.observations()[0, :72].reshape(24, 3)[12, FOOD])
    # The contact pushed it away a little before it ate.
    np.testing.assert_allclose(after, seen, atol=5e-3)


@pytest.mark.parametrize(("rule", "meals"), [("nearest", [1, 0]), ("all", [1, 1])])
def test_two_mouths_at_one_food(rule, meals):
    simulation = make_simulation(*STILL, *DEATHLESS, *CHILDLESS, f"world.mouths={rule}", "food.normal.growth_rate=0")
    set_scene(simulation, [(240, 180, 0.0), (240, 207, math.pi)], [(240, 193.2)])
    before = simulation.worlds[0].view("food_stock.number")[0]
    simulation.run(1)
    world = simulation.worlds[0]
    assert world.agents()["eaten"].ravel().tolist() == meals
    assert world.view("food_stock.present")[0] == 0
    assert world.view("food_stock.number")[0] == before - 1


def test_a_food_inside_the_mouth_does_not_hide_behind_the_start_of_the_ray():
    simulation = make_simulation()
    set_scene(simulation, [(240, 180, 0.0)], [(240, 189)])
    rays = simulation.worlds[0].rays()[0]
    assert rays[12, FOOD] == 1.0


def test_what_lies_behind_is_not_seen():
    simulation = make_simulation()
    set_scene(simulation, [(240, 180, 0.0), (240, 150, 0.0)], [(240, 165)])
    rays = simulation.worlds[0].rays()[0]
    assert np.all(rays[:, [AGENT, FOOD]] == -1.0)


def test_only_the_nearest_hit_is_seen_and_distance_scales_linearly():
    simulation = make_simulation("sensor.ray_count=1")
    set_scene(simulation, [(100, 180, -math.pi / 2)], [(150, 180), (200, 180)])
    rays = simulation.worlds[0].rays()[0]
    # The only ray looks straight ahead, along +x: it starts at 110 and meets the first food at 146.
    np.testing.assert_allclose(rays[0], [-1.0, 1.0 - 36.0 / 200.0, -1.0], atol=1e-6)


def test_a_ray_reaches_exactly_its_length():
    simulation = make_simulation("sensor.ray_count=1")
    set_scene(simulation, [(100, 180, -math.pi / 2)], [(314, 180)])
    assert simulation.worlds[0].rays()[0, 0, FOOD] == pytest.approx(0.0, abs=1e-6)
    set_scene(simulation, [(100, 180, -math.pi / 2)], [(314.1, 180)])
    assert simulation.worlds[0].rays()[0, 0, FOOD] == -1.0


def test_a_dense_crowd_is_all_seen():
    crowd = ("population.capacity=2000", "population.initial_count=1", "food.normal.capacity=2000")
    simulation = make_simulation(*crowd, "sensor.ray_count=32")
    angles = np.linspace(-1.0, 1.0, 60)
    ring = [(240 + r * math.sin(a), 100 + r * math.cos(a)) for r in np.linspace(190, 30, 20) for a in angles]
    set_scene(simulation, [(240, 100, 0.0)], ring)
    rays = simulation.worlds[0].rays()[0]
    assert np.all(rays[2:-2, FOOD] > 1.0 - 20.0 / 200.0)


def test_unit_scaling_of_the_observation():
    raw, unit = make_simulation(), make_simulation('sensor.scaling="unit"')
    for simulation in (raw, unit):
        set_scene(simulation, [(240, 180, 0.5)])
        simulation.run(3)
    a, b = raw.worlds[0].observations()[0], unit.worlds[0].observations()[0]
    assert a.shape == (95,)
    assert b.shape == (96,)
    # The two worlds differ from the first step on, since their networks do: compare each with its own state.
    for simulation, tail in ((raw, a[90:]), (unit, b[90:])):
        agents = simulation.worlds[0].agents()
        v, heading = [agents["velocity_x"][0], agents["velocity_y"][0]], agents["angle"][0]
        omega, energy = agents["angular_velocity"][0], agents["energy"][0]
        if simulation is raw:
            expected = [*v, heading, omega, energy]
        else:
            expected = [
                v[0] / 1.5,
                v[1] / 1.5,
                math.sin(heading),
                math.cos(heading),
                omega / 0.2,
                energy / 100,
            ]
        np.testing.assert_allclose(tail, expected, rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("sector", range(6))
def test_touch_is_felt_in_its_sector_and_type(sector):
    simulation = make_simulation("motor.min_force=-1e-6", "motor.max_force=1e-6")
    heading = 0.7
    direction = heading + math.radians(60 * sector + 30)  # counter-clockwise from the heading; 0 is along +y
    place = (240 - 13 * math.sin(direction), 180 + 13 * math.cos(direction))
    set_scene(simulation, [(240, 180, heading)], [place])
    simulation.run(1)
    touch = simulation.worlds[0].observations()[0, 72:90].reshape(3, 6)
    expected = np.zeros((3, 6))
    expected[FOOD, sector] = 1
    np.testing.assert_array_equal(touch, expected)


def test_touching_a_wall_is_felt_where_the_wall_is():
    simulation = make_simulation("motor.min_force=-1e-6", "motor.max_force=1e-6")
    set_scene(simulation, [(8, 180, 0.0)])
    simulation.run(1)
    touch = simulation.worlds[0].observations()[0, 72:90].reshape(3, 6)
    # The left wall is at +90° from a heading along +y: sector 1.
    np.testing.assert_array_equal(np.argwhere(touch), [[WALL, 1]])


def test_two_agents_feel_one_another():
    simulation = make_simulation("motor.min_force=-1e-6", "motor.max_force=1e-6")
    set_scene(simulation, [(240, 180, 0.3), (240, 199, 0.3)])
    simulation.run(1)
    touch = simulation.worlds[0].observations()[:, 72:90].reshape(2, 3, 6)
    np.testing.assert_array_equal(np.argwhere(touch), [[0, AGENT, 5], [1, AGENT, 2]])
