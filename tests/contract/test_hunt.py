"""Agents that eat agents: who eats whom, what the eater gains, and that no energy goes missing."""

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation

PREY, PREDATOR, TOP = 0, 1, 2
SMALL = 10.0
SHARE = 0.6


def make(*overrides: str, top: bool = False) -> Simulation:
    """Prey and predators of the same size that hardly move; with `top`, a third species that eats predators."""
    third = (f'species.top.diet.eats=[["predator", {SHARE}]]',) if top else ()
    return make_simulation(
        *QUICK,
        *STILL,
        *DEATHLESS,
        *CHILDLESS,
        "food.normal.growth_rate=0",
        "food.normal.initial_count=0",
        "energy.basic_cost=0.001",
        "species.prey.energy.basic_cost=0.5",
        f'species.predator.diet.eats=[["prey", {SHARE}]]',
        "species.predator.diet.digestion_steps=10",
        *third,
        *overrides,
    )


def facing(x: float, y: float, target: tuple[float, float]) -> tuple[float, float, float]:
    """An agent at (x, y) that faces a point; heading 0 is along +y."""
    return x, y, float(np.arctan2(x - target[0], target[1] - y))


def step(simulation: Simulation, steps: int = 1) -> dict[str, np.ndarray]:
    """Runs some steps; returns their deaths, and (species, energy) of the living as `alive`."""
    simulation.run(steps)
    agents = simulation.worlds[0].agents()
    return simulation.worlds[0].deaths() | {"alive": np.column_stack([agents["species"], agents["energy"]])}


def test_prey_at_the_mouth_is_eaten_for_a_share_of_its_remaining_energy():
    simulation = make()
    set_scene(simulation, [(100, 100, 0.0), facing(100, 81, (100, 100))], species=[PREY, PREDATOR])
    after = step(simulation)
    assert after["species"].tolist() == [PREY]
    assert after["cause"].tolist() == [2]
    assert after["energy"][0] == pytest.approx(40 - 0.5, abs=1e-4)  # after its own costs
    assert after["alive"].tolist() == [[PREDATOR, pytest.approx(40 - 0.001 + SHARE * 39.5, abs=1e-4)]]
    world = simulation.worlds[0]
    assert world.view("hunt_counters.deaths_eaten").tolist() == [1, 0]
    assert world.view("hunt_counters.energy_prey")[PREY] == pytest.approx(39.5, abs=1e-4)
    assert world.view("hunt_counters.energy_hunted")[PREDATOR] == pytest.approx(SHARE * 39.5, abs=1e-4)
    assert world.agents()["eaten"].tolist() == [[0, 1, 0]]


def test_only_the_mouth_eats():
    simulation = make()
    set_scene(simulation, [(100, 100, 0.0), facing(100, 81, (100, 0))], species=[PREY, PREDATOR])  # looks away
    assert len(step(simulation, 3)["cause"]) == 0


def test_prey_eats_neither_predators_nor_prey():
    simulation = make()
    set_scene(simulation, [facing(100, 100, (100, 81)), facing(100, 81, (100, 100))], species=[PREY, PREY])
    assert len(step(simulation, 3)["cause"]) == 0


def test_the_nearer_of_two_is_eaten():
    simulation = make()
    near, far = (100, 99.0, 0.0), (113, 94.9, 0.0)
    set_scene(simulation, [far, near, facing(100, 81, (102, 100))], species=[PREY, PREY, PREDATOR])
    assert step(simulation)["agent_id"].tolist() == [1]


def test_all_prey_at_one_mouth_are_eaten_if_a_setting_says_so():
    for sharing in ("one", "each"):
        simulation = make('world.prey_at_mouth="all"', f'world.prey_sharing="{sharing}"')
        set_scene(
            simulation, [(100, 99, 0.0), (113, 94.9, 0.0), facing(100, 81, (102, 100))], species=[PREY, PREY, PREDATOR]
        )
        after = step(simulation)
        assert sorted(after["agent_id"].tolist()) == [0, 1]
        assert after["alive"].tolist() == [[PREDATOR, pytest.approx(40 - 0.001 + 2 * SHARE * 39.5, abs=1e-4)]]
        assert simulation.worlds[0].agents()["eaten"].tolist() == [[0, 2, 0]]


def test_prey_can_be_worth_what_it_had_before_the_step():
    simulation = make('world.prey_energy="before_step"')
    set_scene(simulation, [(100, 100, 0.0), facing(100, 81, (100, 100))], species=[PREY, PREDATOR])
    assert step(simulation)["alive"].tolist() == [[PREDATOR, pytest.approx(40 - 0.001 + SHARE * 40, abs=1e-4)]]


def test_a_digesting_predator_eats_nothing_else():
    simulation = make("species.predator.sensor.mouth_spread=180")
    around = [(100, 119.5, 0.0), (100, 80.5, 0.0)]
    set_scene(simulation, [*around, (100, 100, 0.0)], species=[PREY, PREY, PREDATOR])
    assert len(step(simulation)["cause"]) == 1
    assert len(step(simulation, 10)["cause"]) == 0
    assert len(step(simulation)["cause"]) == 1


@pytest.mark.parametrize(("sharing", "gains"), [("one", [0, 1]), ("each", [1, 1])])
def test_two_eaters_of_one_agent(sharing, gains):
    won = set()
    for seed in range(8):
        simulation = make(f'world.prey_sharing="{sharing}"')
        simulation = Simulation(simulation.config, [seed], 1)
        both = [facing(81, 100, (100, 100)), facing(119, 100, (100, 100))]
        set_scene(simulation, [(100, 100, 0.0), *both], species=[PREY, PREDATOR, PREDATOR])
        after = step(simulation)
        assert after["cause"].tolist() == [2]
        eaten = simulation.worlds[0].agents()["eaten"][:, 1].tolist()
        assert sorted(eaten) == gains
        won.add(tuple(eaten))
    assert len(won) == (2 if sharing == "one" else 1)  # the draw favors neither


def test_an_agent_that_is_eaten_eats_nothing():
    simulation = make(top=True)
    chain = [(100, 100, 0.0), facing(100, 81, (100, 100)), facing(100, 62, (100, 81))]
    set_scene(simulation, chain, species=[PREY, PREDATOR, TOP])
    after = step(simulation)
    assert after["species"].tolist() == [PREDATOR]
    assert sorted(after["alive"][:, 0].tolist()) == [PREY, TOP]


def test_the_starved_are_not_eaten():
    simulation = make('energy.at_zero="death"', "species.prey.energy.basic_cost=50")
    set_scene(simulation, [(100, 100, 0.0), facing(100, 81, (100, 100))], species=[PREY, PREDATOR])
    after = step(simulation)
    assert after["cause"].tolist() == [1]
    assert after["alive"][:, 1].tolist() == [pytest.approx(40 - 0.001, abs=1e-4)]


@pytest.mark.parametrize("fidelity", ["corrected", "released"])
def test_a_world_of_prey_and_predators_keeps_its_ledger_and_its_bits(fidelity):
    """The audit of each window checks the ledger of each species; threads and a restore change no bit."""

    def lived(threads: int) -> Simulation:
        many = ("hazard.kappa=0.02", "species.predator.population.initial_count=45")
        config = load_config("predator", fidelity, [*QUICK, *many])
        simulation = Simulation(config, [3], threads)
        simulation.run(5 * 64 + 7)
        return simulation

    one, two = lived(1), lived(2)
    assert one.worlds[0].view("hunt_counters.deaths_eaten")[PREY] >= 3
    assert one.worlds[0].digest() == two.worlds[0].digest()
    two.run(20)
    two.engine.restore(0, one.engine.save(0))
    for simulation in (one, two):
        simulation.run(100)
    assert one.worlds[0].digest() == two.worlds[0].digest()
