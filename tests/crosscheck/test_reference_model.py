"""Every decision of the engine about life and death against the rules in plain Python, step by step.

Why the tolerances: the engine holds places, forces and rewards in float32, the reference in float64.
"""

from dataclasses import fields

import numpy as np
import ppo_reference
import pytest
from acting_weights import as_read
from reference_draw import normals
from reference_model import COUNTED, Agent, Deed, Model, Newborn, Stock, Vacancy, World
from worlds import set_scene

from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation

PLACE = 1e-4
"""Places below 1000 u round by 3e-5 u, and so do the products and normals that they are made of."""
ANGLE = 1e-6
"""Angles below 2π round by 2.4e-7 rad, twice."""
FORCE = 5e-5
"""Forces below 114 round by 4e-6, four times on the way to their norm."""
WEIGHT = 1e-6
"""Weights below 10 round by 5e-7; noise of up to 20 once more."""
OUTPUT = 2e-5
"""Sums of a hundred products, of which the energy's are as large as 40, in another order, and tanh to 1e-6."""

AGENT_FIELDS = tuple(each.name for each in fields(Agent) if each.name != "old_slot")
REACH = 0.5 * np.hypot(10, 10)
"""Furthest that a body moves in a step of 0.5 s at the speed cap [u]."""

SHORT = ("learning.rollout_steps=32", "learning.minibatch_size=16", "learning.update_epochs=1")
LIVELY = (
    *SHORT,
    "energy.initial=3",
    "energy.basic_cost=0.02",
    "energy.action_cost=2e-4",
    "birth.kappa=0.05",
    "hazard.kappa=0.4",
    "hazard.alpha_age=2e-4",
    "hazard.beta_age=0.01",
    'food."*".gene.initial_mean=1',
    "motor.max_force=160",
    "genome.mutation_scale=0.5",
)
CASES = {
    "baseline": ("baseline", "corrected", ("food.normal.growth_rate=1.7", "population.capacity=70")),
    "small, crowded": (
        "small",
        "corrected",
        ("birth.distance_sd=30", "food.normal.growth_rate=9", "hazard.kappa=0.2", "energy.capacity=3.5"),
    ),
    "relocation": (
        "relocation",
        "corrected",
        ("food.normal.placement.switch_after=3", "food.normal.growth_rate=2", "food.normal.placement.sd=[90, 90]"),
    ),
    "poor, starvation kills": ("poor", "corrected", ('energy.starvation="death"', 'food."*".growth_rate=1.3')),
    "poison, released": ("poison", "released", ("food.poison.initial_count=40", "food.poison.growth_rate=0.9")),
    "released, one by one": (
        "baseline",
        "corrected",
        (
            'genome.mutation_noise="frozen"',
            'birth.parents="old_slots"',
            'birth.order="after_deaths"',
            "population.capacity=60",
            "food.normal.growth_rate=1.7",
        ),
    ),
    "text": ("baseline", "text", ("food.normal.growth_rate=1.5", "genome.neutral_count=3")),
    "inner walls, unit scale": (
        "baseline",
        "corrected",
        ("arena.inner_walls=[[120, 60, 360, 300], [240, 50, 240, 120]]", 'sensor.scaling="unit"'),
    ),
}
EXPECTED: dict[str, dict[str, float]] = {
    "baseline": {"births_failed_full": 10},
    "small, crowded": {"energy_capped": 0.1},
    "relocation": {},
    "poor, starvation kills": {"energy_forgiven": 1},
    "poison, released": {"energy_forgiven": 10},
    "released, one by one": {"births_failed_full": 10},
    "text": {},
    "inner walls, unit scale": {},
}
STEPS = 200
SEED = 2**63 + 17


def read_world(simulation: Simulation) -> World:
    """The state that the rules speak of, copied from the engine."""
    world = simulation.worlds[0]
    rows, foods, kinds = world.agents(), world.foods(), len(world.config.food)
    columns = {name: rows[name].tolist() for name in AGENT_FIELDS if name != "genome"}
    columns["genome"] = list(rows["genome"].astype(float))
    agents = [Agent(**{name: column[i] for name, column in columns.items()}) for i in range(world.alive)]
    supply = {name: world.view(f"food_stock.{name}").tolist() for name in ("number", "eaten", "center")}
    stocks = [Stock(**{name: column[k] for name, column in supply.items()}) for k in range(kinds)]
    for k in range(kinds):
        here = foods["kind"] == k
        stocks[k].foods = list(zip(foods["x"][here].tolist(), foods["y"][here].tolist(), strict=True))
        assert world.view("food_stock.present")[k] == len(stocks[k].foods)
    head = simulation.engine.head(0)
    counters = {name: world.counters[name] for name in COUNTED}
    genome, old = world.view("genome").reshape(-1, rows["genome"].shape[1]).astype(float), np.zeros(0, bool)
    free = world.view("free")[: world.view("free_count")[0]].tolist()
    vacancies = [Vacancy(genome[slot]) for slot in free]
    if world.config.birth.parents == "old_slots":
        old = world.view("old_slot") != 0
        for agent, slot in zip(agents, world.living.tolist(), strict=True):
            agent.old_slot = bool(old[slot])
        for vacancy, slot in zip(vacancies, free, strict=True):
            vacancy.old_slot = bool(old[slot])
    newborns = []
    if world.config.birth.inheritance == "at_window_end":
        waiting = world.view("newborn_genome").reshape(-1, genome.shape[1]).astype(float)
        newborns = [
            Newborn(world.view("newborn.agent_id")[i], world.view("newborn.parent")[i], waiting[i])
            for i in range(head["births_in_window"])
        ]
    ghosts = [(world.view("ghost.x")[i], world.view("ghost.y")[i]) for i in range(head["ghost_count"])]
    numbers = {name: head[name] for name in ("step", "next_agent_id", "births_in_window", "births_before")}
    return World(
        **numbers,
        agents=agents,
        stocks=stocks,
        counters=counters,
        vacancies=vacancies,
        newborns=newborns,
        ghosts=ghosts,
    )


def food_slots(simulation: Simulation) -> dict[int, tuple[int, int]]:
    """Kind and index within the kind of the food in each slot of the physics' circles."""
    slots = np.flatnonzero(simulation.worlds[0].view("physics.circles.present")).tolist()
    kinds = simulation.worlds[0].foods()["kind"].tolist()
    return {slot: (k, kinds[:n].count(k)) for n, (slot, k) in enumerate(zip(slots, kinds, strict=True))}


def read_deeds(simulation: Simulation, slots, actions, foods) -> list[Deed]:
    """What those in `slots` did in the last step. Which mouth met which food is noted in the physics' list of pairs."""
    view = simulation.worlds[0].view
    count = view("physics.neighbors.circles.start")[view("physics.neighbors.head.bodies")[0]]
    first, second, mark = (view(f"physics.neighbors.circles.{name}")[:count] for name in ("first", "second", "mark"))
    met: dict[int, list[tuple[int, int]]] = {slot: [] for slot in slots}
    for place, circle in zip(first[mark == 1].tolist(), second[mark == 1].tolist(), strict=True):
        met[int(view("physics.neighbors.slot")[place])].append(foods[circle])
    body = np.stack([view(f"physics.bodies.{name}")[slots] for name in ("x", "y", "angle")], axis=1).astype(float)
    both = zip(slots, actions.astype(float).tolist(), body.tolist(), strict=True)
    return [Deed((left, right), x, y, angle, met[slot]) for slot, (left, right), (x, y, angle) in both]


def assert_mouths_agree_with_touch(touch, agents, deeds, stocks):
    """A food is in the mouth only where that kind is felt within ±60°, which is sectors 0 and 5, and the reverse; what
    lay in the mouth as the step began is in it, and what is in it lay near."""
    for bits, agent, deed in zip(touch.tolist(), agents, deeds, strict=True):
        felt = {k for k in range(len(stocks)) if bits >> (6 * (1 + k)) & 0b100001}
        assert {k for k, _ in deed.mouthfuls} == felt
        ahead = np.array([-np.sin(agent.angle), np.cos(agent.angle)])
        for k, stock in enumerate(stocks):
            apart = np.reshape(stock.foods, (-1, 2)) - (agent.x, agent.y)
            distance = np.hypot(*apart.T)
            inside = (distance < 14 - 1e-3) & (apart @ ahead > (0.5 + 1e-3) * distance)
            mouthful = {f for kind, f in deed.mouthfuls if kind == k}
            assert set(np.flatnonzero(inside)) <= mouthful <= set(np.flatnonzero(distance < 14 + REACH))


def assert_same_world(actual: World, expected: World, costs: float) -> None:
    for name in ("step", "next_agent_id", "births_in_window", "births_before"):
        assert getattr(actual, name) == getattr(expected, name), name
    exact = ("agent_id", "parent_id", "generation", "birth_step", "children", "eaten", "old_slot")
    assert [[getattr(a, n) for n in exact] for a in actual.agents] == [
        [getattr(a, n) for n in exact] for a in expected.agents
    ]
    if expected.agents:
        assert_close([a.energy for a in actual.agents], [a.energy for a in expected.agents], costs)
        assert_close([(a.x, a.y) for a in actual.agents], [(a.x, a.y) for a in expected.agents], PLACE)
        assert_close([a.genome for a in actual.agents], [a.genome for a in expected.agents], WEIGHT)
        angle, wanted = (np.array([a.angle for a in world.agents]) for world in (actual, expected))
        assert np.all((angle >= 0) & (angle < 2 * np.pi))
        assert_close((angle - wanted + np.pi) % (2 * np.pi), np.full(len(angle), np.pi), ANGLE)
    assert [v.old_slot for v in actual.vacancies] == [v.old_slot for v in expected.vacancies]
    assert [(n.agent_id, n.parent) for n in actual.newborns] == [(n.agent_id, n.parent) for n in expected.newborns]
    if expected.newborns:
        assert_close([v.genome for v in actual.vacancies], [v.genome for v in expected.vacancies], WEIGHT)
        older = [i for i, n in enumerate(expected.newborns) if n.parent < 0]
        for each in older:
            assert_close(actual.newborns[each].genome, expected.newborns[each].genome, WEIGHT)
    assert_close(
        np.sort(np.reshape(actual.ghosts, (-1, 2)), 0), np.sort(np.reshape(expected.ghosts, (-1, 2)), 0), PLACE
    )
    for a, e in zip(actual.stocks, expected.stocks, strict=True):
        assert (a.eaten, a.center, len(a.foods)) == (e.eaten, e.center, len(e.foods))
        assert a.number == pytest.approx(e.number, abs=1e-12)
        assert_close(sorted(a.foods), sorted(e.foods), PLACE)
    for name in COUNTED:
        slack = (len(expected.agents) + 50) * costs if name.startswith("energy") else 0
        assert actual.counters[name] == pytest.approx(expected.counters[name], rel=1e-12, abs=slack), name


def assert_close(actual, expected, tolerance):
    np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=tolerance)


def assert_policy(model, before, observations, params, rows):
    """Actions, their log-probabilities and the values follow from the observations and the networks."""
    for agent, observation, weights, action, log_prob, value in zip(
        before.agents, observations.astype(float), as_read(params).astype(float), *rows, strict=True
    ):
        layers = ppo_reference.split(weights, len(observation))
        output = ppo_reference.forward(weights, observation[None, :])[2][0]
        noise = np.array(normals(*model.draw("action", agent.agent_id, before.step)[:2]))
        np.testing.assert_allclose(action, output[:2] + np.exp(layers["log_sd"]) * noise, rtol=0, atol=OUTPUT)
        expected = (-0.5 * noise**2 - layers["log_sd"] - 0.5 * np.log(2 * np.pi)).sum()
        assert log_prob == pytest.approx(expected, abs=5e-6)
        assert value == pytest.approx(output[2], abs=OUTPUT)


def compare_step(simulation: Simulation, model: Model) -> int:
    """Makes one step and asserts that it followed the rules; returns how many mouths met a food that another got."""
    world, config = simulation.worlds[0], simulation.config
    costs = 2e-12 + FORCE * config.energy.action_cost
    steps = config.learning.rollout_steps
    before, slots, t = read_world(simulation), world.living.tolist(), world.step % steps
    observations, params, foods = world.observations(), world.view("params")[slots], food_slots(simulation)
    simulation.run(1)
    rows = [world.view("action").reshape(-1, steps, 2)[slots, t]]
    rows += [world.view(name)[slots, t] for name in ("log_prob", "value")]
    deeds = read_deeds(simulation, slots, rows[0], foods)
    if t % 5 == 0:
        assert_policy(model, before, observations, params, rows)
    # A newborn may lie where an agent died in this step; what that one touched is not known any more.
    ids = world.view("life.agent_id")[slots].tolist()
    kept = [i for i, agent in enumerate(before.agents) if ids[i] == agent.agent_id]
    touch = world.view("touch")[slots][kept]
    assert_mouths_agree_with_touch(touch, [before.agents[i] for i in kept], [deeds[i] for i in kept], before.stocks)

    expected = model.advance(before, deeds)
    assert_same_world(read_world(simulation), expected.world, costs)
    rewards = [expected.rewards[agent.agent_id] for agent in before.agents]
    np.testing.assert_allclose(world.view("reward")[slots, t], rewards, rtol=1e-6, atol=1e-6)
    dead = simulation.engine.take_rows(0)
    assert dead["agent_id"].tolist() == [agent.agent_id for agent in expected.dead]
    assert_close(dead["energy"], [agent.energy for agent in expected.dead], costs)
    assert np.all(dead["death_step"] == world.step)
    met = [food for deed in deeds for food in deed.mouthfuls]
    return len(met) - len(set(met))


@pytest.mark.parametrize("case", CASES)
def test_every_step_follows_the_rules(case):
    preset, fidelity, overrides = CASES[case]
    config = load_config(preset, fidelity, (*LIVELY, *overrides))
    simulation, model = Simulation(config, [SEED], threads=1), Model(config, SEED)
    world = simulation.worlds[0]
    assert_same_world(read_world(simulation), model.found(), 0.0)
    while world.step < STEPS and not world.extinct:
        compare_step(simulation, model)
    # What the case is there for did happen.
    happened = {**world.counters, "eaten": world.view("food_stock.eaten").sum()}
    for name, least in {"births": 50, "deaths": 30, "births_failed_space": 1, "eaten": 10, **EXPECTED[case]}.items():
        assert happened[name] >= least, (name, happened)


def test_rivals_for_one_food_are_judged_by_the_rules():
    config = load_config("baseline", None, LIVELY)
    simulation, model = Simulation(config, [SEED], threads=1), Model(config, SEED)
    rng, rivals = np.random.default_rng(0), 0
    x, y = (axis.ravel() for axis in np.meshgrid(60.0 + 90 * np.arange(5), 60.0 + 80 * np.arange(4)))
    for _ in range(10):
        away = rng.uniform(0, 2 * np.pi, 20)[:, None] + 2 * np.pi / 3 * np.arange(3)  # three around each food
        reach = rng.uniform(13.5, 14.2, away.shape)
        places = (x[:, None] + reach * np.sin(away), y[:, None] - reach * np.cos(away))
        set_scene(simulation, np.stack([*places, away % (2 * np.pi)], -1), np.column_stack([x, y]), energy=2.0)
        rivals += sum(compare_step(simulation, model) for _ in range(2))
    assert rivals > 100
