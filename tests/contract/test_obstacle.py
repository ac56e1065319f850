"""Obstacles: their places, their effect on rays and bodies, and the damage they do."""

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config import ConfigError, load_config

ONE = (*QUICK, *DEATHLESS, *CHILDLESS, "obstacle.count=1", "food.normal.initial_count=0", "food.normal.growth_rate=0")
DAMAGE = "obstacle.damage=0.5"


def side_of(world, side: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Midpoint of a side of the only obstacle, unit vector along it, and outward unit normal."""
    corners = world.obstacles[0].astype(float)
    a, b = corners[side], corners[(side + 1) % len(corners)]
    along = (b - a) / np.linalg.norm(b - a)
    out = np.array([-along[1], along[0]])  # the sides run clockwise
    return (a + b) / 2, along, out


def heading_to(direction: np.ndarray) -> float:
    """The heading along a direction."""
    return float(np.arctan2(-direction[0], direction[1]) % (2 * np.pi))


def beside(simulation, distance: float, towards: bool = True) -> None:
    """Puts the center of one agent at a distance from the midpoint of a side."""
    middle, _, out = side_of(simulation.worlds[0])
    x, y = middle + distance * out
    set_scene(simulation, [(x, y, heading_to(-out if towards else out))])


def distance_to(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance of points (p, 2) from the sides of a polygon (c, 2)."""
    a, b = corners[None], np.roll(corners, -1, axis=0)[None]
    t = ((points[:, None] - a) * (b - a)).sum(-1) / ((b - a) ** 2).sum(-1)
    nearest = a + np.clip(t, 0, 1)[..., None] * (b - a)
    return np.linalg.norm(points[:, None] - nearest, axis=-1).min(axis=1)


def within(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Whether points (p, 2) lie in a polygon (c, 2) whose corners run clockwise."""
    side = np.roll(corners, -1, axis=0) - corners
    from_corner = points[:, None] - corners[None]
    turn = from_corner[..., 0] * side[:, 1] - from_corner[..., 1] * side[:, 0]
    return np.array([row.min() >= 0 for row in turn])


def test_obstacles_are_regular_apart_and_inside():
    simulation = make_simulation(
        *QUICK, "obstacle.count=12", "obstacle.corners=5", "obstacle.min_side=10", "obstacle.max_side=25", seeds=[1, 2]
    )
    every = [world.obstacles for world in simulation.worlds]
    assert every[0].shape == (12, 5, 2)
    assert not np.allclose(every[0], every[1])
    again = make_simulation(*QUICK, "obstacle.count=12", "obstacle.corners=5", "obstacle.min_side=10", seeds=[2])
    assert again.worlds[0].obstacles.shape == every[1].shape
    for obstacles in every:
        sides = np.linalg.norm(obstacles - np.roll(obstacles, 1, axis=1), axis=-1)
        assert np.ptp(sides, axis=1) == pytest.approx(np.zeros(12), abs=1e-3)
        assert sides.min() >= 10
        assert sides.max() <= 25
        assert np.ptp(sides.mean(axis=1)) > 5
        assert obstacles.min() > 0
        assert (obstacles.max(axis=(0, 1)) < [480, 360]).all()
        for i, corners in enumerate(obstacles):
            others = np.delete(obstacles, i, axis=0).reshape(-1, 2)
            assert not within(corners, others).any()


def test_nothing_appears_in_or_on_an_obstacle():
    simulation = make_simulation(*QUICK, "obstacle.count=12", "food.normal.growth_rate=5", *STILL)
    simulation.run(256)
    world = simulation.worlds[0]
    agents, foods = world.agents(), world.foods()
    assert len(foods["x"]) > 80
    for corners in world.obstacles.astype(float):
        for things, radius in ((agents, 10.0), (foods, 4.0)):
            places = np.stack([things["x"], things["y"]], axis=1).astype(float)
            assert not within(corners, places).any()
            assert distance_to(corners, places).min() > radius - 0.01


def test_a_ray_reads_an_obstacle_as_a_separate_type():
    simulation = make_simulation(*ONE, "sensor.ray_count=1")
    beside(simulation, 70.0)
    world = simulation.worlds[0]
    (reading,) = world.rays()[0]
    assert reading.tolist() == pytest.approx([-1, -1, -1, 1 - 60 / 200], abs=1e-5)  # agent, food, wall, obstacle
    beside(simulation, 70.0, towards=False)
    assert world.rays()[0][0, 3] == -1.0


def test_touch_costs_once_per_obstacle_and_step_and_is_felt():
    simulation = make_simulation(*ONE, *STILL, DAMAGE, "energy.basic_cost=0")
    corners = simulation.worlds[0].obstacles[0].astype(float)
    outward = corners[0] - corners.mean(axis=0)
    x, y = corners[0] + 9.5 * outward / np.linalg.norm(outward)  # touches the two sides that meet at the corner
    set_scene(simulation, [(x, y, 0.0)])
    simulation.run(1)
    world = simulation.worlds[0]
    assert world.view("life.energy")[world.living] == pytest.approx([39.5], abs=1e-6)
    assert world.view("obstacle_counters.obstacles_touched").tolist() == [1]
    assert world.view("obstacle_counters.energy_damage").tolist() == [0.5]
    felt = world.observations()[0][4 * 24 : 4 * 24 + 4 * 6].reshape(4, 6)  # (type, sector)
    assert felt[3].sum() == 1
    assert felt[:3].sum() == 0


def test_no_harm_without_touch():
    simulation = make_simulation(*ONE, *STILL, DAMAGE, "energy.basic_cost=0")
    beside(simulation, 10.5)
    simulation.run(5)
    world = simulation.worlds[0]
    assert world.view("obstacle_counters.obstacles_touched").tolist() == [0]
    assert world.view("life.energy")[world.living] == pytest.approx([40.0], abs=1e-6)


def test_the_schedule_sets_how_many_do_harm_from_which_step():
    simulation = make_simulation(
        *QUICK,
        "obstacle.count=8",
        DAMAGE,
        "obstacle.schedule.harmful.points=[[0, 0.0], [128, 1.0]]",
    )
    simulation.run(128)
    world = simulation.worlds[0]
    assert world.view("obstacle_counters.obstacles_touched").tolist() == [0]
    simulation.run(128)
    (touched,) = world.view("obstacle_counters.obstacles_touched").tolist()
    assert touched > 0
    assert world.view("obstacle_counters.energy_damage").tolist() == [0.5 * touched]


def test_damage_is_in_the_ledger_of_energy():
    simulation = make_simulation(*QUICK, "obstacle.count=8", DAMAGE)
    simulation.run(640)  # the audit at the end of every window would find an open ledger
    world = simulation.worlds[0]
    c = world.counters
    (damage,) = world.view("obstacle_counters.energy_damage")
    flow = c["energy_initial"] + c["energy_eaten"] + c["energy_forgiven"] - c["energy_basic"] - c["energy_action"]
    flow -= c["energy_capped"] + c["energy_lost"] + damage
    assert damage > 0
    assert world.agents()["energy"].sum() == pytest.approx(flow, rel=1e-12)


def test_bodies_do_not_enter_and_are_slowed_by_the_obstacles_friction():
    def slid(friction: float) -> float:
        """How far an agent slides along a side that it pushes against at an angle."""
        simulation = make_simulation(
            *ONE,
            "obstacle.min_side=120",
            "obstacle.max_side=120",
            f"obstacle.friction={friction}",
            "learning.policy=external",
            "physics.max_angular_speed=1e-3",
        )
        world = simulation.worlds[0]
        middle, along, out = side_of(world)
        x, y = middle + 10.05 * out
        set_scene(simulation, [(x, y, heading_to(along - out))])
        start = np.array([x, y])
        capacity = len(world.view("alive"))
        simulation.engine.set_actions(0, np.full((1, capacity, 2), 10.0, np.float32))
        simulation.run(50)
        end = np.array([world.agents()["x"][0], world.agents()["y"][0]], dtype=float)
        assert (end - middle) @ out > 9.5
        return float((end - start) @ along)

    smooth, rough = slid(0.0), slid(0.6)
    assert smooth > 10
    assert 0 < rough < 0.6 * smooth  # it pushes at 45°, so friction removes 0.6 of the force along the side


def test_threads_and_pieces_change_nothing():
    settings = (*QUICK, "obstacle.count=10", DAMAGE)
    one = make_simulation(*settings, seeds=[5])
    two = make_simulation(*settings, seeds=[5], threads=2)
    one.run(256)
    for _ in range(16):
        two.run(16)
    assert one.worlds[0].digest() == two.worlds[0].digest()


def test_the_wrong_channel_pays_for_food():
    """The setting that follows the sequel's program, whose rays for obstacles are in fact those for food."""
    common = ("reward.action_coef=0", "reward.meal_coef=0", "reward.pay.see_obstacle.gene.initial_mean=1")

    def paid(channel: str) -> float:
        simulation = make_simulation(*ONE, *STILL, *common, f'reward.pay.see_obstacle.channel="{channel}"')
        beside(simulation, 60.0)
        simulation.run(1)
        world = simulation.worlds[0]
        return float(world.view("life.reward")[world.living[0]])

    assert paid("") > 0
    assert paid("see_normal") == 0.0


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("obstacle.corners=2", "obstacle.corners"),
        ("obstacle.min_side=50", "at most obstacle.max_side = 40"),
        ("obstacle.count=200", "too many to place: the arena has room for"),
        ("obstacle.schedule.harmless.points=[[0, 1.0]]", "did you mean harmful"),
        ("obstacle.schedule.harmful.points=[[0, 1.5]]", "factors must be from 0 to 1"),
        ("reward.pay.see_obstacle.coef=0.1", "no channel 'see_obstacle' here; sensor.sees says what it sees"),
        ('reward.pay.see_wall.channel="see_food"', "there is no channel 'see_food' here; .*see_normal"),
    ],
)
def test_contradictions_are_refused_by_name(setting, message):
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=[setting])
