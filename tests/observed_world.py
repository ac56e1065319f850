"""The state of a simulation and the actions of its agents, in the form that the reference model takes."""

from dataclasses import fields
from typing import Any

import numpy as np
from observed_touch import touch_bits
from reference.state import COUNTED, HARMED, HUNTED, Agent, Deed, Newborn, Stock, Vacancy, World

from hedon.config.layout import SpeciesLayout, layouts
from hedon.config.schema.arena import walls
from hedon.experiment.simulation import Simulation
from hedon.record.schema import CAUSES

FIRST, SECOND = 1, 2
"""Marks of a pair of bodies: the mouth of the first or the second touches the other, which it may eat."""


def read_world(simulation: Simulation) -> World:
    """The state to which the rules refer, copied from the engine."""
    world = simulation.worlds[0]
    foods, kinds, head = world.foods(), len(world.config.food), simulation.engine.head(0)
    supply = {name: world.view(f"food_stock.{name}").tolist() for name in ("number", "eaten", "center")}
    stocks = [Stock(**{name: column[k] for name, column in supply.items()}) for k in range(kinds)]
    for k in range(kinds):
        here = foods["kind"] == k
        stocks[k].foods = list(zip(foods["x"][here].tolist(), foods["y"][here].tolist(), strict=True))
        assert world.view("food_stock.present")[k] == len(stocks[k].foods)
    eaten_foods = [
        (*(world.view(f"eaten_food.{name}")[i].item() for name in ("x", "y", "kind")),)
        for i in range(head["eaten_food_count"])
    ]
    made = tuple(layouts(world.config).values())
    genes = [len(layout.genes) for layout in made]
    species, kept = len(world.config.species), world.view("eaten_by")
    width = world.view("eaten").size // len(world.view("alive"))
    meals = (kept if len(kept) else np.zeros((species, width), int)).reshape(species, width).tolist()
    numbers = {name: head[name] for name in ("step", "next_agent_id", "births_in_window", "births_before")}
    return World(
        **numbers,
        agents=_agents(world, made),
        stocks=stocks,
        sums=_sums(world),
        meals=meals,
        vacancies=_vacancies(world, genes),
        newborns=_newborns(world, genes, numbers["births_in_window"]),
        eaten_foods=eaten_foods,
    )


def _agents(world: Any, made: tuple[SpeciesLayout, ...]) -> list[Agent]:
    rows, living = world.agents(), world.living
    known = {each.name for each in fields(Agent)} & set(rows) - {"genome", "store"}
    columns = {name: rows[name].tolist() for name in known}
    for name in ("digestion", "ready_until", "births"):
        if len(world.view(name)):
            columns[name] = world.view(name)[living].tolist()
    if len(world.view("resident_slot")):
        columns["resident_slot"] = (world.view("resident_slot")[living] != 0).tolist()
    agents = []
    memory = world.view("memory").reshape(len(world.view("alive")), -1)[living]
    kept = [species.reward.memory for species in world.config.species.values()]
    last = world.view("last").reshape(len(world.view("alive")), -1)[living]
    genomes = rows["genome"].astype(float)
    stores = [list(species.store) for species in world.config.species.values()]
    for i in range(len(living)):
        held = {name: float(rows[name][i]) for name in stores[columns["species"][i]]}
        agent = Agent(**{name: column[i] for name, column in columns.items()}, genome=genomes[i], store=held)
        agent.genome = agent.genome[: len(made[agent.species].genes)]
        agent.births = agent.births if "births" in columns else None
        agent.memory = memory[i, : kept[agent.species]].tolist()
        agent.last = last[i, : len(made[agent.species].last)].tolist()
        agents.append(agent)
    return agents


def _sums(world: Any) -> list[dict[str, float]]:
    """Counters and ledger of each species; 0 for mechanisms that the world lacks."""
    more = [(f"hunt_counters.{name}", name) for name in HUNTED] + [(f"obstacle_counters.{n}", n) for n in HARMED]
    sums = []
    for s in range(len(world.config.species)):
        counters = world.counters_of(s)
        mine = {name: counters[name] for name in COUNTED}
        for path, name in more:
            column = world.view(path)
            mine[name] = column[s].item() if len(column) else 0
        sums.append(mine)
    return sums


def _vacancies(world: Any, genes: list[int]) -> list[list[Vacancy]]:
    genome = world.view("genome").reshape(len(world.view("alive")), -1).astype(float)
    old, first, found = world.view("resident_slot"), 0, []
    for s, (species, length) in enumerate(zip(world.config.species.values(), genes, strict=True)):
        free = world.view("free")[first : first + world.view("free_count")[s]].tolist()
        found.append([Vacancy(genome[slot, :length], bool(len(old) and old[slot])) for slot in free])
        first += species.population.capacity
    return found


def _newborns(world: Any, genes: list[int], births: int) -> list[Newborn]:
    if world.config.world.inheritance != "at_window_end":
        return []
    waiting = world.view("newborn_genome").reshape(len(world.view("newborn.parent")), -1).astype(float)
    species = world.view("newborn_species")
    newborns = []
    for i in range(births):
        s = int(species[i]) if len(species) else 0
        parent = world.view("newborn.parent")[i].item()
        newborns.append(Newborn(world.view("newborn.agent_id")[i].item(), s, parent, waiting[i, : genes[s]]))
    return newborns


def food_slots(simulation: Simulation) -> dict[int, tuple[int, int]]:
    """Kind, and index within that kind, of the food in each circle slot of the physics."""
    slots = np.flatnonzero(simulation.worlds[0].view("physics.circles.present")).tolist()
    kinds = simulation.worlds[0].foods()["kind"].tolist()
    return {slot: (k, kinds[:n].count(k)) for n, (slot, k) in enumerate(zip(slots, kinds, strict=True))}


def rollout_rows(simulation: Simulation, before: World, slots: list[int], name: str, width: int = 1) -> np.ndarray:
    """Rollout entries that the step after `before` wrote for the agents in `slots`, (agents, width) or (agents,)."""
    world = simulation.worlds[0]
    table = world.view(name).reshape(len(world.view("alive")), -1, width)
    learns = [species.learning.policy == "ppo" for species in world.config.species.values()]
    t = before.step % world.config.world.rollout_steps
    rows = np.array([table[slot, t * learns[agent.species]] for slot, agent in zip(slots, before.agents, strict=True)])
    return rows if width > 1 else rows.reshape(len(slots))


def read_deeds(simulation: Simulation, before: World, slots: list[int], foods: dict, seen: list) -> list[Deed]:
    """What the agents in `slots` did in the last step; touches come from the physics' lists of pairs."""
    view = simulation.worlds[0].view
    bodies = view("physics.neighbors.head.bodies")[0]
    at = view("physics.neighbors.slot").tolist()

    def marked(what: str) -> list[tuple[int, int, int]]:
        count = view(f"physics.neighbors.{what}.start")[bodies]
        first, second, mark = (view(f"physics.neighbors.{what}.{n}")[:count] for n in ("first", "second", "mark"))
        here = np.flatnonzero(mark)
        return list(zip(first[here].tolist(), second[here].tolist(), mark[here].tolist(), strict=True))

    mouthfuls: dict[int, list[tuple[int, int]]] = {slot: [] for slot in slots}
    prey: dict[int, list[int]] = {slot: [] for slot in slots}
    obstacles: dict[int, set[int]] = {slot: set() for slot in slots}
    ids = {slot: agent.agent_id for slot, agent in zip(slots, before.agents, strict=True)}
    for place, circle, _ in marked("circles"):
        mouthfuls[at[place]].append(foods[circle])
    for one, other, mark in marked("bodies"):
        if mark & FIRST:
            prey[at[one]].append(ids[at[other]])
        if mark & SECOND:
            prey[at[other]].append(ids[at[one]])
    corners = simulation.config.obstacle.corners
    first_side = len(walls(simulation.config.arena))
    for place, wall, _ in marked("walls"):
        obstacles[at[place]].add((wall - first_side) // corners)
    actions = rollout_rows(simulation, before, slots, "action", 2).astype(float)
    deeds = []
    places = np.stack([view(f"physics.bodies.{name}")[slots] for name in ("x", "y", "angle")], axis=1).tolist()
    names = ("velocity_x", "velocity_y", "angular_velocity")
    motions = np.stack([view(f"physics.bodies.{name}")[slots] for name in names], axis=1).tolist()
    felt = touch_bits(simulation.worlds[0], slots)
    now = view("life.agent_id")[slots].tolist()
    deaths = simulation.engine.head(0)["death_log_count"]
    eaten = view("death_log.agent_id")[:deaths][view("death_log_cause")[:deaths] == CAUSES.index("eaten")]
    for i, (slot, agent, place) in enumerate(zip(slots, before.agents, places, strict=True)):
        if now[i] != agent.agent_id:  # it died, and a newborn has its slot
            place = [agent.x, agent.y, agent.angle]
        gone = now[i] != agent.agent_id and agent.agent_id in eaten
        met = (mouthfuls[slot], prey[slot], sorted(obstacles[slot]), seen[i], tuple(motions[i]), felt[i])
        left, right = actions[i]
        x, y, angle = place
        deeds.append(Deed((left, right), x, y, angle, *met, now[i] != agent.agent_id, gone))
    return deeds
