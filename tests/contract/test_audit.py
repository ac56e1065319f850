"""The invariants of a world are audited at the end of each window, and every violation is named."""

from contextlib import nullcontext

import numpy as np
import pytest
from memory import overwrite
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.error import EngineError
from hedon.experiment.simulation import Simulation

WINDOW = 64
SAFE = (*QUICK, *STILL, *DEATHLESS, *CHILDLESS, "food.normal.growth_rate=0", "energy.basic_cost=0.001")
PLACES = [(100, 100, 0.0), (200, 100, 1.0), (300, 100, 2.0), (240, 180, 3.0), (100, 300, 4.0)]


@pytest.fixture
def world() -> Simulation:
    """Five agents that hardly move and one food item, one step before the end of a window."""
    simulation = make_simulation(*SAFE)
    set_scene(simulation, PLACES, [(400, 300)])
    simulation.run(WINDOW - 1)
    return simulation


def slot_of(world: Simulation, agent: int) -> int:
    return int(world.worlds[0].living[agent])


def poke(world: Simulation, path: str, index: int, value: float) -> None:
    overwrite(world, 0, path, index, value)


def test_a_sound_world_passes(world):
    world.run(3 * WINDOW)


def test_a_body_inside_another_is_named(world):
    for axis, value in (("x", 200.0), ("y", 106.0)):
        poke(world, f"physics.bodies.{axis}", slot_of(world, 4), value)
    with pytest.raises(
        EngineError, match=r"overlap_too_deep.*World 0, step 64, value 1\d(\.\d+)?, agent 1, with agent 4"
    ):
        world.run(1)


def test_a_body_inside_a_food_is_named(world):
    for axis, value in (("x", 400.5), ("y", 300.0)):
        poke(world, f"physics.bodies.{axis}", slot_of(world, 2), value)
        poke(world, "physics.bodies.angle", slot_of(world, 2), 1.5 * np.pi)  # its mouth is on the other side
    with pytest.raises(EngineError, match=r"overlap_too_deep.*value 1\d\.\d+, agent 2, windows completed: 1"):
        world.run(1)


def test_a_body_in_the_place_of_an_eaten_food_is_sound():
    """The food is seen for one more step although it is gone, so a child may be born in its place."""
    world = make_simulation(*SAFE, 'world.eaten_food="seen"')
    set_scene(world, PLACES, [(400, 300)])
    world.run(WINDOW - 1)
    for axis, value in (("x", 400.5), ("y", 300.0)):
        poke(world, f"physics.bodies.{axis}", slot_of(world, 2), value)
        poke(world, "physics.bodies.angle", slot_of(world, 2), 0.5 * np.pi)  # its mouth is on this side
    world.run(1)
    assert world.worlds[0].view("head.eaten_food_count")[0] == 1
    world.run(WINDOW)


@pytest.mark.parametrize("apart", [4.9, 5.1])
def test_the_jacobi_solver_may_leave_deep_overlaps(apart):
    """Jams cause them. The bound is a quarter of the contact distance; nothing corrects the overlap here."""
    world = make_simulation(*SAFE, 'physics.solver="jacobi"', "physics.correction_rate=0")
    set_scene(world, [(100, 100, 0.0), (100 + apart, 100, 1.0)])
    too_deep = pytest.raises(EngineError, match=r"overlap_too_deep.*step 64, value 15\.[01]")
    with too_deep if apart < 5 else nullcontext():
        world.run(WINDOW)


@pytest.mark.parametrize(("axis", "value"), [("x", -30.0), ("y", 1e4)])
def test_a_body_beyond_the_walls_is_outside(world, axis, value):
    poke(world, f"physics.bodies.{axis}", slot_of(world, 3), value)
    with pytest.raises(EngineError, match=r"outside_arena.*agent 3.*max_speed"):
        world.run(1)


def test_a_body_in_a_corner_is_outside(world):
    """Inside the rectangle, but beyond the chords of a rounded corner."""
    for axis in ("x", "y"):
        poke(world, f"physics.bodies.{axis}", slot_of(world, 3), 1.0)
    with pytest.raises(EngineError, match=r"outside_arena.*value -\d\.\d+, agent 3"):
        world.run(1)


@pytest.mark.parametrize("path", ["genome", "first_moment", "second_moment"])
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_number_that_is_not_finite_is_named(path, value):
    world = make_simulation(*SAFE, "learning.update_epochs=0")  # the numbers are not even used
    set_scene(world, PLACES)
    world.run(WINDOW - 1)
    poke(world, path, (slot_of(world, 1) + 1) * len(world.worlds[0].view(path)[0]) - 1, value)
    with pytest.raises(EngineError, match=r"not_finite.*step 64.*agent 1,"):
        world.run(1)


def test_a_slot_held_twice_is_named(world):
    poke(world, "living", 1, slot_of(world, 0))
    with pytest.raises(EngineError, match=r"slots_inconsistent.*check RUN --fault"):
        world.run(1)
    with pytest.raises(EngineError, match="slots are inconsistent"):
        world.engine.save(0)


@pytest.mark.parametrize(("path", "index", "value"), [("free", 0, 0), ("alive", 150, 1), ("free_count", 0, 3)])
def test_inconsistent_slots_are_named(world, path, index, value):
    poke(world, path, index, value)
    with pytest.raises(EngineError, match="slots_inconsistent"):
        world.run(1)


@pytest.mark.parametrize(
    ("path", "agent", "value"),
    [("agent_id", 2, 0), ("agent_id", 4, 99), ("parent_id", 3, 3), ("birth_step", 1, 65), ("death_step", 1, 5)],
)
def test_impossible_ids_are_named(world, path, agent, value):
    poke(world, f"life.{path}", slot_of(world, agent), value)
    with pytest.raises(EngineError, match=r"ids_inconsistent.*agent"):
        world.run(1)


@pytest.mark.parametrize(
    ("path", "value"), [("counters.deaths", 1), ("counters.births", 99), ("food_stock.present", 2)]
)
def test_counts_that_do_not_add_up_are_named(world, path, value):
    poke(world, path, 0, value)
    with pytest.raises(EngineError, match="counts_inconsistent"):
        world.run(1)


@pytest.mark.parametrize("path", ["life.energy", "counters.energy_eaten", "counters.energy_lost"])
def test_energy_from_nowhere_is_named(world, path):
    index = slot_of(world, 2) if path == "life.energy" else 0
    poke(world, path, index, world.worlds[0].view(path)[index] + 1e-6)
    with pytest.raises(EngineError, match=r"ledger_open.*value -?1e-06"):
        world.run(1)


def test_lists_beyond_their_capacity_are_named(world):
    bodies = int(world.worlds[0].view("physics.neighbors.head.bodies")[0])
    poke(world, "physics.neighbors.circles.start", bodies, -1)
    with pytest.raises(EngineError, match="neighbor_overflow"):
        world.run(1)


@pytest.mark.parametrize(("path", "count"), [("head.death_log_count", 10**6), ("head.death_log_lost", -1)])
def test_more_deaths_than_the_buffer_holds_are_named(world, path, count):
    poke(world, path, 0, count)
    with pytest.raises(EngineError, match="counts_inconsistent"):
        world.run(1)
    assert len(world.engine.take_rows(0)["agent_id"]) <= 16 * 200


def test_a_crowd_overlaps_far_less_than_the_bound():
    """In a full small arena, contacts leave less than a tenth of the overlap that counts as an error."""
    crowd = ("population.initial_count=140", "birth.kappa=0.02", "birth.attempts=100", *QUICK, *DEATHLESS)
    simulation = make_simulation(*crowd, preset="small")
    deepest = 0.0
    for _ in range(10):
        simulation.run(WINDOW)
        agents = simulation.worlds[0].agents()
        place = np.stack([agents["x"], agents["y"]], axis=1)
        apart = np.linalg.norm(place[:, None] - place[None], axis=2) + 1e9 * np.eye(len(place))
        deepest = max(deepest, 20.0 - apart.min())
    assert simulation.worlds[0].alive == 200
    assert 0.0 < deepest < 1.0
