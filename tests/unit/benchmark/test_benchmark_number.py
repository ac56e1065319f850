"""The benchmark's own arithmetic: floors, scaled worlds, and what its checks reject."""

import itertools

import numpy as np
import pytest
from worlds import QUICK, make_simulation

from benchmarks import crowd, growth
from benchmarks.bench import DEFAULT_PARTS, PARTS, choose
from benchmarks.check import CheckError, check_same_lives, check_world
from benchmarks.floor import network_flop, step_floor
from benchmarks.machine import Calibration, drifts
from benchmarks.measure import spread
from benchmarks.plan import PlanError, make_plan
from benchmarks.scene import Scene, go_on_from_peopled, peopled, scene_of
from hedon.config.load import load_config
from hedon.experiment import memory
from hedon.experiment.simulation import Simulation

NO_RATES = Calibration({}, {}, 0.0)


def test_the_operations_of_a_sample_match_a_count_by_hand():
    # Rows of the first layer: 24 rays and 5 dense entries. (29·64 + 64·64 + 3·64) = 6,144 weights, 2 operations each;
    # the backward pass takes the same again, and 64·64 + 3·64 = 4,288 weights for the gradients of the units.
    assert network_flop(load_config("baseline")) == (12_288, 12_288 + 8_576)
    unit = load_config("baseline", overrides=("sensor.scaling=unit", "sensor.ray_count=8"))
    assert network_flop(unit)[0] == 2 * ((8 + 6) * 64 + 4_288)


def test_the_floor_is_the_work_divided_by_the_rates():
    floor = step_floor(
        load_config("baseline"), alive=150, learners=127, multiply_add_gflops=200, cache_read_gbytes_per_s=50
    )
    # 127 learners · 40 updates · 256 samples · 33,152 operations at 200e9/s, over 1,024 steps.
    assert floor.learning_seconds == pytest.approx(127 * 40 * 256 * 33_152 / 200e9 / 1024)
    # 150 agents read 29 · 64 + 64 · 64 weights of 2 bytes, and numbers of 4 bytes: 192 weights of the heads, 64 folded
    # biases, 64 biases of the square layer and 3 biases of the heads.
    assert floor.forward_seconds == pytest.approx(150 * (2 * 5_952 + 4 * 323) / 50e9)
    assert floor.seconds == pytest.approx(0.2105e-3 + 0.0396e-3, rel=1e-3)


def test_the_floor_of_acting_in_float32_counts_every_weight_in_full():
    exact = load_config("baseline", overrides=('learning.acting_weights="float32"',))
    floor = step_floor(exact, alive=150, learners=127, multiply_add_gflops=200, cache_read_gbytes_per_s=50)
    assert floor.forward_seconds == pytest.approx(150 * 4 * 6_275 / 50e9)


def test_acting_is_bound_by_operations_when_reads_are_fast():
    floor = step_floor(load_config("baseline"), 150, 0, multiply_add_gflops=10, cache_read_gbytes_per_s=500)
    assert floor.forward_seconds == pytest.approx(150 * 12_288 / 10e9)
    assert floor.learning_seconds == 0


def test_half_the_epochs_and_longer_windows_change_the_floor_as_they_should():
    changed = load_config("baseline", overrides=("learning.update_epochs=5", "world.rollout_steps=2048"))
    whole = step_floor(load_config("baseline"), 1, 100, 100, 100).learning_seconds
    assert step_floor(changed, 1, 100, 100, 100).learning_seconds == pytest.approx(whole / 2)


@pytest.mark.parametrize("preset", ["baseline", "poison"])
def test_a_scaled_world_has_the_same_density_of_everything(preset):
    plan = make_plan(preset, threads="1", kernel="portable")
    base, scaled = plan.config(), growth.scaled_config(plan, 2, 5, 99)
    area, scaled_area = (config.arena.width * config.arena.height for config in (base, scaled))
    assert scaled_area == 10 * area
    own, scaled_own = base.species["agent"], scaled.species["agent"]
    assert scaled_own.population.capacity / scaled_area == pytest.approx(own.population.capacity / area)
    for kind, food in base.food.items():
        for name in ("capacity", "growth_rate", "candidates"):
            assert getattr(scaled.food[kind], name) == pytest.approx(10 * getattr(food, name))
        assert scaled.food[kind].gives == food.gives
    assert scaled.world.rollout_steps == 100  # no window ends within the 99 steps
    assert scaled_own.energy == own.energy


@pytest.mark.parametrize(("across", "up"), growth.TILES)
def test_all_sizes_of_growth_are_valid_configs(across, up):
    plan = make_plan(threads="1")
    assert growth.scaled_config(plan, across, up, 10).species["agent"].population.capacity == 200 * across * up


@pytest.mark.parametrize("preset", ["centered", "relocation"])
def test_a_world_of_uneven_density_is_refused(preset):
    with pytest.raises(PlanError, match=f"{preset} has inner walls or food around centers"):
        growth.scaled_config(make_plan(preset), 2, 5, 10)


def test_tiles_repeat_a_scene_side_by_side():
    agents = {"x": [1, 2], "y": [3, 4], "angle": [0.1, 0.2], "energy": [5, 6]}
    foods = {"food_x": [7], "food_y": [8]}
    single = {name: np.array(values, np.float32) for name, values in (agents | foods).items()}
    scene = Scene(**single, species=np.array([0, 1], np.int32), food_kind=np.array([1], np.int32)).tiled(2, 4, 100, 50)
    expected = sorted(
        (x + 100 * i, y + 50 * j) for x, y in ((1, 3), (2, 4)) for i, j in itertools.product(range(2), range(4))
    )
    assert sorted(zip(scene.x.tolist(), scene.y.tolist(), strict=True)) == expected
    assert sorted(set(zip(scene.food_x.tolist(), scene.food_y.tolist(), strict=True)))[-1] == (107, 158)
    assert len(scene.food_kind) == 8
    assert scene.energy[scene.x % 100 == 2].tolist() == [6] * 8
    assert scene.species[scene.x % 100 == 2].tolist() == [1] * 8


def test_a_size_that_does_not_fit_in_memory_is_skipped_with_a_note(monkeypatch):
    monkeypatch.setattr(growth, "memory_bytes", lambda field: 49_000_000)
    rows = growth.measure(make_plan(threads="1", quick=True), NO_RATES)
    assert [row["slots"] for row in rows if "refused" in row] == [400]
    assert "needs 0.1 GB of memory, but only 0.0 GB are free" in rows[-1]["refused"]
    notes = growth.table(rows, NO_RATES).notes
    assert notes[0].startswith("400 slots: skipped, needs")


def test_a_crowd_is_a_window_in_which_all_learn(monkeypatch):
    rows = crowd.measure(make_plan(threads="1,2", quick=True), NO_RATES)
    assert [(row["slots"], row["threads"]) for row in rows] == [(200, 1), (200, 2), (400, 1), (400, 2)]
    for row in rows:
        assert 0.95 * row["slots"] < row["learners"] <= row["slots"]
    assert len(crowd.table(rows, NO_RATES).lines) == 4
    monkeypatch.setattr(memory, "memory_present", lambda: 105_000_000)
    rows = crowd.measure(make_plan(threads="1", quick=True), NO_RATES)
    assert ["refused" in row for row in rows] == [False, True]
    assert "400 agents: skipped: the run may need 0.1 GB" in crowd.table(rows, NO_RATES).notes[0]


def test_the_scene_of_a_world_can_be_put_into_another():
    plan = make_plan(threads="1", quick=True)
    copy = make_simulation(*QUICK)
    scene_of(peopled(plan)).put_into(copy)
    for name in ("x", "y", "angle"):
        assert np.array_equal(copy.worlds[0].agents()[name], peopled(plan).agents()[name])
    assert len(copy.worlds[0].foods()["x"]) == len(peopled(plan).foods()["x"])


def test_a_simulation_continues_from_the_peopled_world():
    plan = make_plan(threads="1", quick=True)
    copies = Simulation(plan.config(), [1, 2], 1, plan.kernel)
    go_on_from_peopled(plan, copies)
    assert {world.digest() for world in copies.worlds} == {peopled(plan).digest()}
    copies.run(1)
    assert copies.worlds[0].digest() != copies.worlds[1].digest()


def test_a_world_that_died_out_fails_its_check():
    simulation = make_simulation(*QUICK, "hazard.kappa=1", "hazard.alpha_energy=1e6", "energy.initial=0", seeds=(7,))
    check_world(simulation.worlds[0])
    simulation.run(20)
    with pytest.raises(CheckError, match=r"the world of seed 7 at step .* has died out"):
        check_world(simulation.worlds[0])


def test_an_agent_outside_of_the_walls_fails_its_check():
    simulation = make_simulation(*QUICK)
    one = {"x": -5, "y": 50, "angle": 0, "energy": 40}
    place = {name: np.array([value], np.float32) for name, value in one.items()}
    none = {"food_x": np.zeros(0, np.float32), "food_y": np.zeros(0, np.float32), "food_kind": np.zeros(0, np.int32)}
    out = Scene(**place, species=np.zeros(1, np.int32), **none)
    out.put_into(simulation)
    with pytest.raises(CheckError, match="1 agents outside its walls"):
        check_world(simulation.worlds[0])


def test_worlds_of_one_seed_that_differ_fail_their_check():
    simulations = [make_simulation(*QUICK), make_simulation(*QUICK, threads=2)]
    for simulation in simulations:
        simulation.run(70)
    check_same_lives(simulations)
    simulations[1].run(1)
    with pytest.raises(CheckError, match=r"seed 1 on .* differs between 1 and 2 threads"):
        check_same_lives(simulations)


def test_parts_and_their_nearest_names():
    assert choose(()) == DEFAULT_PARTS
    assert choose(("world", "rays", "world")) == ("world", "rays")
    assert set(DEFAULT_PARTS) == set(PARTS) - {"device", "growth", "crowd", "rule"}
    with pytest.raises(PlanError, match=r"'fysics' is not a part .*; did you mean physics\?"):
        choose(("rays", "fysics"))


def test_cases_are_the_product_or_one_world_per_thread():
    assert make_plan(threads="4,1,2").cases() == [(1, 1), (2, 1), (4, 1), (4, 4)]
    assert make_plan(threads="1").cases() == [(1, 1)]
    assert make_plan(threads="1,2", worlds="3,1").cases() == [(1, 1), (2, 1), (1, 3), (2, 3)]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"threads": "two"}, "--threads: 'two' is not a list of numbers from 1 to 1,024"),
        ({"worlds": "0"}, "--worlds: '0' is not a list"),
        ({"kernel": "portabel"}, r"--kernel: 'portabel' is not one of .*; did you mean portable\?"),
    ],
)
def test_arguments_that_cannot_be_used(arguments, message):
    with pytest.raises(PlanError, match=message):
        make_plan(**arguments)


def test_a_size_that_growth_does_not_have_is_refused():
    with pytest.raises(PlanError, match=r"--slots: 300 is not one of the sizes .*: 200, 2000, 20000, 100000"):
        growth.measure(make_plan(slots="300"), NO_RATES)


def test_a_machine_that_changes_is_noted():
    before = Calibration({"avx2": {1: 100.0, 2: 200.0}}, {1: 30.0}, 10.0)
    after = Calibration({"avx2": {1: 75.0, 2: 190.0}}, {1: 35.0}, 13.0)
    assert drifts(before, after) == ["multiply-add, avx2, 1 threads went from 100 to 75", "copy went from 10 to 13"]
    assert drifts(before, before) == []


def test_a_spread_is_the_median_with_quartiles():
    assert spread([5, 1, 2, 4, 3], 1, 10) == "30.0 (20.0-40.0)"
