"""Windows on an emulated CUDA device give the same bits as AVX2: every preset, many worlds, difficult scenes.

The kernels sum in the same order as those of the CPU, so all state is equal after steps, learning and the audit.
"""

import numpy as np
import pytest
from cuda_emulation import emulate
from cuda_emulation import emulated as emulated
from two_stores import FED
from worlds import QUICK, RELEASED, make_simulation, set_scene

from hedon.error import EngineError
from hedon.experiment.simulation import Simulation

SHORT = ("world.rollout_steps=16", "learning.minibatch_size=8", "learning.update_epochs=2")
FEW = ("population.capacity=24", "population.initial_count=12")


def pair(emulated: str, *overrides: str, preset: str = "baseline", seeds: tuple[int, ...] = (1,)):
    return tuple(
        make_simulation(*overrides, preset=preset, seeds=seeds, backend=kernel) for kernel in ("avx2", emulated)
    )


def require_equal(one: Simulation, other: Simulation) -> None:
    """Fails with the names of the arrays that differ."""
    for index in range(len(one.seeds)):
        a, b = one.engine.save(index), other.engine.save(index)
        assert [name for name in a if a[name].tobytes() != b[name].tobytes()] == []
        assert one.worlds[index].digest() == other.worlds[index].digest()


PRESETS = ("baseline", "small", "poison", "relocation", "seasons", "predator", "prey-alone", "predator-square")


@pytest.mark.parametrize("preset", PRESETS)
def test_presets_have_the_same_bits(emulated: str, preset: str):
    """A window with its learning and the start of the next, in pieces that end within windows."""
    one, other = pair(emulated, *SHORT, preset=preset)
    for steps in (3, 14):
        one.run(steps)
        other.run(steps)
        require_equal(one, other)


MECHANISMS = {
    "smell": ('sensor.smells=["*"]', "sensor.noses=2", "reward.pay.smell_normal.coef=0.1"),
    "obstacles": ("obstacle.count=8", "obstacle.damage=0.5", "reward.pay.see_obstacle.channel=see_obstacle_max"),
    "stores": (
        *FED,
        "food.normal.needs.nutrient=1",
        *("reward.drive_reduction_coef=1", "reward.drive_exponent=3", "genome.set.reward.drive_root.initial_sd=0.1"),
        "sensor.mouth_spread=180",
    ),
    "channels": (
        *(
            "reward.pay.births.coef=1",
            "reward.pay.all_meals.coef=0.5",
            "reward.pay.touched.coef=0.1",
            "birth.kappa=0.5",
        ),
        *("reward.family=around", "reward.gate=grain_count", "reward.threshold=2", "sensor.observes.moved=1"),
        *("sensor.observes.energy_change=0.1", "sensor.observes.all_bearing=3", "sensor.observes.season_sine=1"),
        *("neighbor.all={}", 'neighbor.grain.of=["normal"]', "reward.pay.all_kin.coef=0.2"),
        "sensor.season_period=9",
    ),
    "births by stores": (
        *("store.milk={capacity=20, initial=8, child_share=0.5, birth_weight=0.8}", "food.normal.gives.milk=3"),
        *("energy.birth_weight=-0.2", "birth.kappa=0.5", "birth.logit_offset=2"),
    ),
    "fixed": ("learning.policy=fixed", "birth.network=initial", "birth.kappa=0.5"),
    "heredity": ("birth.network=learned", "birth.mating=pairs", "birth.kappa=0.5", "birth.mating_range=100"),
    "genes of numbers": (
        *(
            "birth.kappa=0.3",
            "genome.mutation_scale=0.1",
            "genome.set.energy.basic_cost={}",
            "genome.set.birth.kappa={}",
        ),
        *("genome.set.sensor.ray_length={}", "genome.set.sensor.mouth_spread={}", "genome.set.motor.force_scale={}"),
    ),
    "genes of bodies": (
        *("birth.kappa=0.3", "genome.mutation_scale=0.1", "genome.set.body.radius.initial_sd=0.1"),
        *("genome.set.body.density.initial_sd=0.2", "genome.mutation.g_body_radius.limit=0.2"),
    ),
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_mechanisms_have_the_same_bits(emulated: str, name: str):
    one, other = pair(emulated, *SHORT, *FEW, *MECHANISMS[name])
    one.run(35)
    other.run(35)
    require_equal(one, other)


def test_learners_of_two_species_that_scale_and_normalize_have_the_same_bits(emulated: str):
    sizes = ("species.prey.learning.reward_scaling=window", "species.predator.learning.advantage_normalization=window")
    one, other = pair(emulated, *SHORT, *sizes, preset="predator")
    one.run(35)
    other.run(35)
    require_equal(one, other)
    plain = make_simulation(*SHORT, preset="predator", seeds=(1,), backend="avx2")
    plain.run(35)
    assert plain.worlds[0].digest() != one.worlds[0].digest()


def test_queries_of_two_species_have_the_same_bits(emulated: str):
    settings = ("neighbor.foe={of=['predator'], range=90}", "neighbor.any={of=['normal', '*']}")
    settings += ("species.predator.neighbor.foe=false", "species.prey.reward.pay.foe_distance.coef=0.01")
    settings += ("reward.pay.any_meals={}", "reward.pay.any_kin={}", "sensor.observes.any_bearing=3")
    one, other = pair(emulated, *SHORT, *settings, preset="predator")
    one.run(20)
    other.run(20)
    require_equal(one, other)


def test_threads_that_run_at_the_same_time_have_the_same_bits(monkeypatch: pytest.MonkeyPatch):
    """A missing barrier shows here; fibers, which take turns, would hide it."""
    emulated = emulate(monkeypatch, 32, system_threads=True)
    short = ("world.rollout_steps=4", "learning.minibatch_size=4", "learning.update_epochs=1")
    one, other = pair(emulated, *short, "population.capacity=6", "population.initial_count=4")
    one.run(5)
    other.run(5)
    require_equal(one, other)


@pytest.mark.parametrize("worlds", [2, 16])
def test_any_number_of_worlds_has_the_same_bits(emulated: str, worlds: int):
    one, other = pair(emulated, *SHORT, *FEW, seeds=tuple(range(1, worlds + 1)))
    one.run(20)
    other.run(20)
    require_equal(one, other)


def test_the_released_rules_have_the_same_bits(emulated: str):
    one, other = pair(emulated, *RELEASED, *SHORT, *FEW)
    one.run(34)
    other.run(34)
    require_equal(one, other)


@pytest.mark.parametrize("weights", ["float32", "bfloat16"])
def test_minibatches_of_several_blocks_with_a_remainder(emulated: str, weights: str):
    """80 samples: a block of 64, and one of 16."""
    settings = ("world.rollout_steps=160", "learning.minibatch_size=80", "learning.update_epochs=1")
    acting = f'learning.acting_weights="{weights}"'
    one, other = pair(emulated, *settings, acting, "population.capacity=8", "population.initial_count=4")
    one.run(161)
    other.run(161)
    require_equal(one, other)


def crowd(rng: np.random.Generator, count: int, width: float) -> np.ndarray:
    """Agents so close together that all of them touch."""
    place = 240.0 + width * (rng.random((count, 2)) - 0.5)
    return np.column_stack([place, rng.uniform(0, 2 * np.pi, count)])


def outcome(simulation: Simulation, steps: int) -> str:
    """Runs, and returns the fault that ended the run, if any."""
    try:
        simulation.run(steps)
    except EngineError as error:
        return str(error)
    return ""


@pytest.mark.parametrize(("solver", "width", "fault"), [("sequential", 90.0, True), ("jacobi", 200.0, False)])
def test_crowds_at_walls_and_on_food_have_the_same_bits(emulated: str, solver: str, width: float, fault: bool):
    """Overlaps, rows of touching bodies, a corner and food in mouths take lists and islands to their limits, and beyond
    them in the narrower crowd."""
    rng = np.random.default_rng(3)
    row = np.column_stack([np.arange(20) * 19.0 + 30.0, np.full(20, 11.0), np.full(20, np.pi / 2)])
    agents = np.concatenate([crowd(rng, 30, width), row])
    foods = 240.0 + 120.0 * (rng.random((20, 2)) - 0.5)
    one, other = pair(emulated, *SHORT, f'physics.solver="{solver}"', "food.normal.capacity=40")
    ends = []
    for simulation in (one, other):
        set_scene(simulation, agents, foods)
        ends.append(outcome(simulation, 20))
    assert ends[0] == ends[1]
    assert bool(ends[0]) == fault
    require_equal(one, other)


def test_a_world_that_dies_out_does_not_stop_the_others(emulated: str):
    one, other = pair(emulated, *SHORT, *FEW, seeds=(1, 2, 3))
    for simulation in (one, other):
        set_scene(simulation, [[100.0, 100.0, 0.0]], energy=1e-3)
        simulation.engine.run(40)
    require_equal(one, other)
    assert [w.step for w in one.worlds] == [w.step for w in other.worlds]


def test_nan_is_found_where_the_processor_finds_it(emulated: str):
    """Huge weights make activations infinite; an infinite learning rate would be refused."""
    messages = []
    for simulation in pair(emulated, *SHORT, *FEW):
        saved = simulation.engine.save(0)
        saved["params"] = saved["params"].copy()
        saved["params"][3, 70] = 3e38  # finite, so it can be restored; its activations are not, and the audit fails
        saved["params"][3, -16:-13] = 3e38
        simulation.engine.restore(0, saved)
        with pytest.raises(EngineError, match="not_finite") as raised:
            simulation.run(64)
        messages.append(str(raised.value).split(", value")[0])
    assert messages[0] == messages[1]


def test_unsupported_settings_are_refused(emulated: str):
    with pytest.raises(EngineError, match="actions of a program"):
        make_simulation('learning.policy="external"', backend=emulated)
    many = [f"food.kind{i}.gives.energy=1" for i in range(6)]
    with pytest.raises(EngineError, match=r"have \d+ inputs, and device 'cuda-emulated' learns with at most \d+"):
        make_simulation(*many, "sensor.touch_sectors=14", backend=emulated)


def test_views_and_rows_of_a_device_match_those_of_the_processor(emulated: str):
    one, other = pair(emulated, *QUICK, *FEW, "hazard.alpha_age=0.005")
    for simulation in (one, other):
        simulation.run(64)
    for name in ("params", "observation", "physics.bodies.x", "life.energy", "genome"):
        np.testing.assert_array_equal(one.worlds[0].view(name), other.worlds[0].view(name))
    deaths, same = one.worlds[0].deaths(), other.worlds[0].deaths()
    assert len(deaths["agent_id"]) > 0
    for name, column in deaths.items():
        np.testing.assert_array_equal(column, same[name])
    for simulation in (one, other):
        simulation.run(10)
    np.testing.assert_array_equal(one.worlds[0].deaths()["agent_id"], other.worlds[0].deaths()["agent_id"])
