"""The neighbor list misses nothing, and neither the list nor slots nor threads change a bit."""

import numpy as np
import pytest
from physics_scene import CIRCLE_RADIUS, RADIUS, arena_walls, crowd, make_scene, positions, random_drive, read

BODIES = 120


def run(steps=120, threads=1, slots=None, rebuild_every=0, seed=1, **settings):
    """State bits and contacts of a driven crowd after some steps, in canonical order, and its counters."""
    scene = crowd(seed, BODIES, 60, slots, **settings)
    slots = np.arange(BODIES) if slots is None else slots
    for step in random_drive(scene, steps, seed + 1, slots):
        if rebuild_every and step % rebuild_every == 0:
            scene.set_stale()
        scene.step(1, threads)
    place = {slot: rank for rank, slot in enumerate(slots)}
    contacts = sorted(
        (row[0], place[row[1]], place[row[2]] if row[0] == 0 else row[2], *row[3:]) for row in scene.contacts()
    )
    return read(scene, slots).view(np.int32), contacts, scene.counters()


@pytest.fixture(scope="module", params=["sequential", "jacobi"])
def solver(request):
    return request.param


@pytest.fixture(scope="module")
def reference(solver):
    state, contacts, counters = run(solver=solver)
    assert len(contacts) > 100
    assert counters["batches"] > 1
    return state, contacts, counters


@pytest.mark.parametrize(
    "change",
    [
        {"threads": 2},
        {"threads": 3},
        {"rebuild_every": 1},
        {"rebuild_every": 7},
        {"neighbor_skin": 0.5},
        {"neighbor_skin": 20.0},
        {"slots": np.random.default_rng(5).permutation(BODIES + 30)[:BODIES], "capacity": BODIES + 30},
        {"slots": np.arange(BODIES)[::-1], "threads": 2, "neighbor_skin": 9.0},
    ],
    ids=str,
)
def test_irrelevant_settings_change_no_bit(reference, solver, change):
    state, contacts, _ = run(**change, solver=solver)
    np.testing.assert_array_equal(state, reference[0])
    assert contacts == reference[1]


def test_the_order_does_matter(reference, solver):
    """Otherwise, the test of permuted slots would prove nothing: the order decides what is solved or added first."""
    scene = crowd(1, BODIES, 60, solver=solver)
    scene.set_order(list(range(BODIES))[::-1])
    for _ in random_drive(scene, 120, 2, np.arange(BODIES)):
        scene.step()
    assert (read(scene).view(np.int32) != reference[0]).any()


def test_the_list_is_reused_while_it_is_valid(reference):
    assert 10 < reference[2]["builds"] < 80


def drifting(spacing=45.0, **settings):
    """Bodies in rows that all drift at 5 u per step, too far from walls to meet one, and do not push one another."""
    places = [[100.0 + spacing * column, 100.0 + spacing * row] for row in range(8) for column in range(8)]
    settings |= {"linear_damping": 0.0, "velocity_passes": 0, "position_passes": 0}
    scene = make_scene(places, size=(4800.0, 3600.0), **settings)
    scene.array("velocity_x")[:] = 10.0
    scene.step(8)
    return scene


def pairs_within(spacing, gap):
    """How many pairs of those bodies are closer than `gap` between their surfaces."""
    places = spacing * np.argwhere(np.ones((8, 8)))
    apart = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
    return (np.count_nonzero(apart < 2 * RADIUS + gap) - len(places)) // 2


def test_a_list_that_has_room_lasts_for_two_steps():
    scene = drifting()
    assert lists_in(scene, 20) == 10
    assert scene.counters()["skin"] == pytest.approx(4.5 * 5.0)


def test_a_list_without_room_for_the_pairs_of_two_steps_lasts_for_one():
    # The first step needs a skin of 16 u: it begins with 4 u and doubles that.
    first, one, two = (pairs_within(17.0, skin) for skin in (16.0, 2.5 * 5.0, 4.5 * 5.0))
    room = (first + two) // 2
    assert one < first < room < two
    scene = drifting(17.0, pair_limit=room)
    assert lists_in(scene, 20) == 20
    assert scene.counters()["skin"] == pytest.approx(2.5 * 5.0)


def lists_in(scene, steps):
    """How many lists the steps build, none of which is repeated."""
    before = scene.counters()
    scene.step(steps)
    after = scene.counters()
    assert after["repeats"] == before["repeats"]
    return after["builds"] - before["builds"]


def test_a_list_that_would_not_last_anyway_is_not_wide():
    scene = drifting()
    skins = []
    for _ in range(8):
        scene.set_stale()
        scene.step()
        skins.append(scene.counters()["skin"])
    assert skins == pytest.approx([2.5 * 5.0] * 8)
    scene.step(8)
    assert scene.counters()["skin"] == pytest.approx(4.5 * 5.0)


def test_list_holds_every_overlap_of_a_crowd():
    """Compared with all pairs in float64, in each of 500 steps of 200 bodies."""
    scene = crowd(11, 200, 60)
    circles = np.column_stack([scene.array("circle_x"), scene.array("circle_y")]).astype(float)
    walls = arena_walls().astype(np.float32).astype(float)
    starts, along = walls[:, :2], walls[:, 2:] - walls[:, :2]
    seen = np.zeros(3, int)
    for _ in random_drive(scene, 500, 12, np.arange(200)):
        scene.step()
        place = positions(scene)
        apart = np.hypot(*(place[:, None] - place[None]).transpose(2, 0, 1))
        bodies = {(i, j) for i, j in np.argwhere(apart < 2 * RADIUS) if i < j}
        reach = np.hypot(*(place[:, None] - circles[None]).transpose(2, 0, 1))
        foods = {tuple(pair) for pair in np.argwhere(reach < RADIUS + CIRCLE_RADIUS)}
        offset = place[:, None] - starts[None]
        t = np.clip((offset * along).sum(2) / (along**2).sum(1), 0, 1)
        distance = np.linalg.norm(offset - t[..., None] * along, axis=2)
        sides = {tuple(pair) for pair in np.argwhere(distance < RADIUS)}
        listed = {kind: {tuple(row[:2]) for row in scene.pairs(kind)} for kind in ("body", "circle", "wall")}
        assert bodies <= {(min(pair), max(pair)) for pair in listed["body"]}
        assert foods <= listed["circle"]
        assert sides <= listed["wall"]
        seen += [len(bodies), len(foods), len(sides)]
    assert (seen > 1000).all()


@pytest.mark.parametrize("wall", [[5.0, 140.0, 470.0, 147.0], [300.0, 20.0, 310.0, 340.0], [60.0, 300.0, 420.0, 40.0]])
def test_walls_in_the_arena_are_found_along_their_whole_length(wall):
    rng = np.random.default_rng(2)
    places = rng.uniform([1.0, 1.0], [479.0, 359.0], (400, 2))
    places[:200] = np.array(wall[:2]) + rng.uniform(0, 1, (200, 1)) * np.subtract(wall[2:], wall[:2])
    places[:200] += rng.normal(0, 12, (200, 2))
    scene = make_scene(places, walls=[wall], substeps=1, position_passes=0, velocity_passes=0, pair_limit=20000)
    scene.step()
    start, along = np.array(wall[:2]), np.subtract(wall[2:], wall[:2])
    t = np.clip((places - start) @ along / (along @ along), 0, 1)
    distance = np.linalg.norm(places - start - t[:, None] * along, axis=1)
    listed = {row[0] for row in scene.pairs("wall")}
    assert set(np.flatnonzero(distance < RADIUS + 3.99)) <= listed <= set(np.flatnonzero(distance < RADIUS + 4.01))


def test_a_body_that_outruns_the_skin_repeats_the_step():
    """A fast body hits a resting one: the contact is found with the same bits, however narrow the skin."""

    def collide(skin):
        scene = make_scene([[100.0, 100.0], [126.0, 100.0], [160.0, 104.0]], neighbor_skin=skin, linear_damping=0.0)
        scene.step(2)
        scene.array("velocity_x")[0] = 10.0
        scene.step(6)
        return read(scene), scene.counters()

    narrow, counters = collide(0.5)
    wide, wide_counters = collide(60.0)
    np.testing.assert_array_equal(narrow, wide)
    assert counters["repeats"] > 0
    assert wide_counters["repeats"] == 0
    assert narrow[3, 2] > 0.5  # the third was hit through the second


def test_a_body_thrown_far_by_a_jam_fills_no_list():
    """With the Jacobi solver, pushes add up, and a body may fly so far in a substep that nearly all pairs of a full
    arena are listed. The default solver has no room for these and needs none."""

    def throw(solver):
        lattice = np.stack(np.meshgrid(np.arange(14.0), np.arange(14.0)), -1).reshape(-1, 2)
        foods = 110.5 + 21.0 * lattice[:80]
        scene = make_scene(100.0 + 21.0 * lattice, foods, size=(480.0, 480.0), solver=solver, max_speed=1e4)
        scene.array("velocity_x")[0], scene.array("velocity_y")[0] = -200.0, -200.0
        scene.step()
        return scene

    scene = throw("jacobi")
    assert scene.counters()["repeats"] > 4
    assert len(scene.pairs("body")) > 10_000
    assert len(scene.pairs("circle")) > 10_000
    with pytest.raises(RuntimeError, match="neighbor_overflow"):
        throw("sequential")


@pytest.mark.parametrize("solver", ["sequential", "jacobi"])
def test_a_body_may_cross_the_arena_in_a_step(solver):
    scene = make_scene([[20.0, 100.0], [400.0, 300.0]], solver=solver, max_speed=1e4)
    scene.step()
    scene.array("velocity_x")[0] = 900.0
    scene.step()
    assert scene.array("x")[0] > 300.0
    assert scene.counters()["repeats"] > 8


@pytest.mark.parametrize("threads", [1, 2])
def test_a_full_list_is_a_fault_that_ends_all_threads_and_leaves_the_bodies_unchanged(threads):
    """Tried often, since threads may notice the fault at different moments."""
    scene = crowd(1, BODIES, 0, pair_limit=20)
    before = read(scene)
    for _ in range(50):
        with pytest.raises(RuntimeError, match="neighbor_overflow"):
            scene.step(5, threads)
    np.testing.assert_array_equal(read(scene), before)


def test_a_number_that_is_not_finite_is_a_fault():
    scene = crowd(1, 30, 0)
    scene.step()
    scene.array("velocity_x")[7] = np.nan
    with pytest.raises(RuntimeError, match="not_finite"):
        scene.step(1, 2)


def test_newcomers_are_seen_by_queries_at_once_and_act_in_the_next_step():
    scene = make_scene([[100.0, 100.0]], circles=[[300.0, 300.0], [0.0, 0.0]])
    scene.array("circle_present")[1] = 0
    scene.step()
    assert 1 not in scene.near("circle", 100.0, 113.0, 1.0)
    scene.add_circle(1, 100.0, 113.0)
    assert 1 in scene.near("circle", 100.0, 113.0, 1.0)
    scene.step()
    assert (1, 0, 1) in {row[:3] for row in scene.contacts()}


def test_circles_may_come_and_go_in_one_slot():
    """Eaten and regrown between two steps, in the same place or elsewhere: each query sees what is there."""
    scene = make_scene([[400.0, 300.0]], circles=[[100.0, 100.0], [102.0, 109.0], [109.0, 102.0]])
    scene.step()
    scene.add_circle(1, 101.0, 110.0)
    assert sorted(scene.near("circle", 105.0, 105.0, 10.0)) == [0, 1, 2]
    for slot in (2, 0, 1):
        scene.remove_circle(slot)
    assert scene.near("circle", 105.0, 105.0, 10.0) == []
    scene.add_circle(1, 300.0, 300.0)
    scene.add_circle(2, 100.0, 100.0)
    scene.add_circle(1, 101.0, 101.0)
    assert sorted(scene.near("circle", 105.0, 105.0, 10.0)) == [1, 2]
    assert scene.near("circle", 300.0, 300.0, 5.0) == []
    scene.remove_circle(0)
    scene.step()
    assert sorted(scene.near("circle", 105.0, 105.0, 10.0)) == [1, 2]


def test_queries_give_all_items_within_reach_once():
    scene = crowd(2, 150, 100)
    for _ in random_drive(scene, 7, 3, np.arange(150)):
        scene.step()
    place = positions(scene)
    for x, y, reach in [(240.0, 180.0, 50.0), (0.0, 0.0, 30.0), (480.0, 360.0, 200.0), (-50.0, 400.0, 120.0)]:
        near = scene.near("body", x, y, reach)
        assert len(near) == len(set(near))
        within = np.flatnonzero(np.hypot(*(place - [x, y]).T) < reach)
        assert set(within) <= set(near)


def test_a_step_with_an_empty_order_does_nothing():
    scene = make_scene([[100.0, 100.0], [115.0, 100.0]], circles=[[300.0, 300.0]], walls=arena_walls())
    scene.step()
    assert len(scene.pairs("body")) == 1
    scene.set_order([])
    scene.step(3, 2)
    assert scene.pairs("body") == []
    assert scene.near("circle", 300.0, 300.0, 1.0) == [0]


def test_impulses_survive_a_change_of_the_order():
    """A death far away leaves a resting stack unchanged, and a reversed order nearly so."""

    def stack(order):
        places = [[300.0, 300.0], [100.0, 109.9], [100.0, 129.8]]
        scene = make_scene(places, walls=[[0.0, 100.0, 200.0, 100.0]], substeps=1)
        scene.array("force_y")[1:] = -100.0
        scene.step(40)
        carried = scene.pairs("body")[0][2]
        scene.set_order(order)
        scene.array("force_y")[:] = 0.0
        scene.step()
        return carried, read(scene)[:, 1:]

    carried, unchanged = stack([0, 1, 2])
    assert carried > 5.0
    np.testing.assert_array_equal(stack([1, 2])[1], unchanged)
    np.testing.assert_allclose(stack([2, 1])[1], unchanged, atol=1e-5)
    # Without a warm start, the stack would stay at rest; with it, the old impulses push it first.
    cold = make_scene(unchanged[:2].T, walls=[[0.0, 100.0, 200.0, 100.0]], substeps=1)
    cold.step()
    assert np.abs(cold.array("velocity_y")).max() < 1e-6 < np.abs(unchanged[4]).max()
