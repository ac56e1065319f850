"""How weights follow from genes, and drive reduction: the reward of a step, compared with closed forms."""

import math

import numpy as np
import pytest
from worlds import DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config import ConfigError, load_config
from hedon.config.layout import layouts

ENERGY = 40.0


def paid(*settings: str, steps: int = 1) -> np.ndarray:
    """The reward per step of one agent that starts with 40 units of energy and finds no food."""
    exact = ("genome.action.initial_sd=0", "genome.second.initial_sd=0", "energy.set_point.initial_sd=0")
    simulation = make_simulation(*QUICK, *DEATHLESS, "birth.kappa=0", *exact, *settings)
    set_scene(simulation, [(100, 100, 0.0)], energy=ENERGY)
    simulation.run(steps)
    world = simulation.worlds[0]
    return np.array(world.view("reward")[world.living[0], :steps], np.float64)


def weight(w: float, *settings: str, steps: int = 1) -> np.ndarray:
    """The weight of action in each step: the reward divided by the reward for a weight of 1."""
    return paid(f"genome.action.initial_mean={w}", *settings, steps=steps) / paid(
        "genome.action.initial_mean=1", steps=steps
    )


def sigmoid(x: float) -> float:
    return 1.0 / (1.0 + math.exp(-x))


@pytest.mark.parametrize("w", [-1.5, 0.01, 0.7])
def test_sinh_grows_with_the_weight(w):
    assert weight(w, "reward.family=sinh") == pytest.approx(math.sinh(2.5 * w), rel=1e-5)


def test_scaled_weights_are_multiplied_by_a_power_of_ten():
    scale = weight(0.5, "reward.family=scaled", "genome.second.initial_mean=1.2")
    assert scale == pytest.approx(0.5 * 10**1.2, rel=1e-5)


@pytest.mark.parametrize(("family", "sign"), [("above", 1), ("below", -1)])
def test_weights_that_depend_on_energy(family, sign):
    cheap = ("energy.basic_cost=0", "energy.action_cost=0")
    found = weight(2.0, f"reward.family={family}", "reward.threshold=30", "reward.threshold_width=8", *cheap)
    assert found == pytest.approx(2.0 * sigmoid(sign * (ENERGY - 30) / 8), rel=1e-5)


def test_weights_that_change_with_age():
    young, old, turn, width = 1.0, -3.0, 12.0, 4.0
    found = weight(
        young,
        "reward.family=between",
        "reward.gate=age",
        f"genome.second.initial_mean={old}",
        f"reward.threshold={turn}",
        f"reward.threshold_width={width}",
        steps=30,
    )
    expected = [young + (old - young) * sigmoid((age - turn) / width) for age in range(1, 31)]
    assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(("set_point", "sign"), [(0.9, -1), (0.05, 1)])
def test_drive_reduction_is_how_much_closer_energy_comes_to_the_set_point(set_point, sign):
    cost, capacity = 2.0, load_config("baseline").species["agent"].energy.capacity
    found = paid(
        *STILL,
        "reward.drive_reduction_coef=3",
        f"energy.set_point.initial_mean={set_point}",
        f"energy.basic_cost={cost}",
        "energy.action_cost=0",
        "reward.action_coef=0",
    )
    assert found == pytest.approx(sign * 3 * cost / capacity, rel=1e-5)


@pytest.mark.parametrize(("exponent", "root"), [(4, 3), (1, 1), (3, 2), (2, 1)])
def test_the_drive_has_the_exponent_and_the_root_of_its_settings(exponent, root):
    """As in Keramati and Gutkin (2014), who call them n and m."""
    energy, water = load_config("baseline").species["agent"].energy.capacity, 8.0
    found = paid(
        *STILL,
        "reward.drive_reduction_coef=1000",
        f"reward.drive_exponent={exponent}",
        f"reward.drive_root={root}",
        "energy.set_point.initial_mean=0.9",
        "energy.basic_cost=2",
        f"store.water={{capacity={water}, initial={water}, basic_cost=0.5}}",
        *("store.water.set_point.initial_mean=0.6", "store.water.set_point.initial_sd=0"),
        *("energy.action_cost=0", "reward.action_coef=0"),
        steps=3,
    )

    def drive(step: int) -> float:
        apart = (abs(0.9 - (ENERGY - 2 * step) / energy), abs(0.6 - (water - 0.5 * step) / water))
        return sum(each**exponent for each in apart) ** (1 / root)

    assert found == pytest.approx([1000 * (drive(step) - drive(step + 1)) for step in range(3)], rel=1e-3)


def test_the_exponents_of_a_drive_are_refused_as_genes_without_a_drive():
    with pytest.raises(ConfigError, match=r"there is no drive: give reward\.drive_reduction_coef"):
        load_config("baseline", overrides=["genome.set.reward.drive_exponent={}"])
    with pytest.raises(ConfigError, match=r"no gene can set this: .* and its weights are genes"):
        load_config("baseline", overrides=["genome.set.reward.meal_coef={}"])


def test_the_cost_of_a_birth_is_not_drive_reduction():
    capacity = load_config("baseline").species["agent"].energy.capacity
    simulation = make_simulation(
        *QUICK,
        *DEATHLESS,
        *STILL,
        "birth.kappa=1",
        "birth.beta=100",
        "reward.action_coef=0",
        "reward.drive_reduction_coef=1",
        "energy.set_point.initial_sd=0",
        "energy.basic_cost=0.1",
        "energy.action_cost=0",
    )
    set_scene(simulation, [(100, 100, 0.0)], energy=ENERGY)
    simulation.run(4)
    world = simulation.worlds[0]
    assert world.counters["births"] >= 4
    assert np.abs(world.view("reward")[world.living[0], :4]) == pytest.approx(0.1 / capacity, rel=1e-4)


def test_second_genes_follow_their_weights():
    by_age = "reward.gate=age"
    for family, ending, more in (("scaled", "_scale", []), ("between", "_old", [by_age]), ("between", "_above", [])):
        names = layouts(load_config("baseline", overrides=[f"reward.family={family}", *more]))["agent"].gene_names
        assert names[:4] == ("w_normal", f"w_normal{ending}", "w_action", f"w_action{ending}")


def test_exponents_have_a_limit():
    limited = {
        gene.name: gene.mutation.limit
        for settings in (["reward.family=sinh"], ["reward.family=scaled", "genome.learning.gamma.initial_sd=0.1"])
        for gene in layouts(load_config("baseline", overrides=settings))["agent"].genes
    }
    assert [limited[name] for name in ("w_normal_scale", "g_gamma", "w_normal", "neutral_1")] == [2, 2, 10, 10]


def test_a_gene_mutates_by_its_own_law():
    simulation = make_simulation(
        *QUICK,
        *DEATHLESS,
        "birth.kappa=0.05",
        "birth.beta=100",
        "genome.mutation.w_action.scale=0",
        "genome.mutation.neutral_1={law='uniform', scale=0.5}",
        "genome.mutation.neutral_2.limit=0.01",
    )
    simulation.run(64)
    world = simulation.worlds[0]
    lives, names = world.agents(), layouts(load_config("baseline"))["agent"].gene_names
    genome = dict(zip(names, lives["genome"].T, strict=True))
    place = {agent_id: i for i, agent_id in enumerate(lives["agent_id"])}
    child = np.flatnonzero(lives["parent_id"] >= 0)
    parent = np.array([place[agent_id] for agent_id in lives["parent_id"][child]])
    assert len(child) > 30
    changes = {name: np.abs(genome[name][child] - genome[name][parent]) for name in names}
    assert changes["w_action"].max() == 0
    assert 0.3 < changes["neutral_1"].max() <= 0.5001
    assert np.abs(genome["neutral_2"]).max() == pytest.approx(0.01)
    assert changes["neutral_3"].min() < 0.02


def test_what_a_gene_does_not_set_comes_from_its_species():
    config = load_config(
        "predator",
        overrides=[
            "genome.mutation_df=5",
            "species.prey.genome.mutation.w_action.scale=0.7",
            "species.prey.genome.mutation_scale=0.3",
            "species.prey.genome.mutation.w_normal.law=normal",
        ],
    )
    laws = {gene.name: gene.mutation for gene in layouts(config)["prey"].genes}
    assert (laws["w_action"].scale, laws["w_action"].law, laws["w_action"].df) == (0.7, "student_t", 5)
    assert (laws["w_normal"].scale, laws["w_normal"].law) == (0.3, "normal")
    assert laws["neutral_1"].scale == 0.3


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("genome.mutation.w_acton.scale=1", r"genome\.mutation\.w_acton: there is no such gene.*did you mean w_action"),
        ("genome.learning.gama.initial_sd=1", r"genome\.learning\.gama: no gene can set this.*did you mean gamma"),
        ("reward.family=cosh", r"reward\.family"),
    ],
)
def test_wrong_names_are_refused(setting, message):
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=[setting])


def test_two_genes_cannot_have_one_name():
    with pytest.raises(ConfigError, match="two genes would have the name w_normal_old"):
        load_config(
            "baseline", overrides=["reward.family=between", "reward.gate=age", "food.normal_old.gives.energy=1"]
        )


def test_genes_cannot_set_the_learning_of_agents_that_do_not_learn():
    with pytest.raises(ConfigError, match="there is no learning that genes could set"):
        load_config("baseline", overrides=["genome.learning.gamma.initial_sd=0.1", 'learning.policy="random"'])


def test_a_gene_cannot_multiply_nothing():
    for name, value in (("gamma", 1.0), ("learning_rate", 0.0), ("entropy_coef", 0.0)):
        settings = [f"genome.learning.{name}.initial_sd=0.1", f"learning.{name}={value}"]
        with pytest.raises(ConfigError, match=rf"learning\.{name}"):
            load_config("baseline", overrides=settings)
