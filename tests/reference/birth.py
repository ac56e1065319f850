"""Which agents have a child, with whom and where, and what the child gets."""

import math
from collections.abc import Callable

import numpy as np
from reference.channel import kept_names
from reference.draw import normals, uniform
from reference.heredity import mutated, recombined
from reference.place import overlaps
from reference.rule_book import memory_of
from reference.setting import Rules, Species
from reference.state import Agent, Newborn, Turn, World


def is_free(rules: Rules, world: World, x: float, y: float, radius: float) -> bool:
    """Whether a disc is inside the arena and touches no living agent and no food."""
    agents = ((agent.x, agent.y, rules.of(agent).body.radius) for agent in world.agents)
    foods = ((fx, fy, rules.food_radius) for stock in world.stocks for fx, fy in stock.foods)
    return (
        not overlaps(x, y, radius, agents) and not overlaps(x, y, radius, foods) and rules.arena.is_inside(x, y, radius)
    )


def breed(rules: Rules, world: World, turns: list[Turn], has_given: Callable[[Turn], None]) -> None:
    """Lets those drawn as parents breed, in random order. `has_given` is called with each that gave energy."""
    for agent in world.agents:
        agent.births = 0
    here = {agent.agent_id for agent in world.agents}
    turn_of = {turn.agent.agent_id: turn for turn in turns if turn.agent.agent_id in here}
    breeding = [turn for turn in turn_of.values() if turn.breeds]
    if rules.resident_slots_only:
        breeding = [turn for turn in breeding if turn.agent.resident_slot]
    for turn in sorted(breeding, key=lambda each: rules.draw("parent_order", each.agent.agent_id, world.step)[0]):
        parent, species = turn.agent, rules.of(turn.agent)
        mate = None
        if species.birth.mating == "pairs":
            mate = find_mate(rules, world, turn_of, parent)
            parent.ready_until = world.step + species.birth.mating_window
            if mate is None:
                continue
        sums = world.sums[species.number]
        parents = [parent, mate] if mate else [parent]
        place = child_place(rules, world, parents) if world.vacancies[species.number] else None
        if not world.vacancies[species.number]:
            sums["births_failed_full"] += 1
        elif place is None:
            sums["births_failed_space"] += 1
        else:
            bear(rules, world, parents, place)
            for each in filter(None, (parent, mate)):
                has_given(turn_of[each.agent_id])


def find_mate(rules: Rules, world: World, turn_of: dict[int, Turn], parent: Agent) -> Agent | None:
    """The nearest waiting agent of its species within range; of equally near ones, the oldest."""
    species = rules.of(parent)
    waiting = [
        turn.agent
        for turn in turn_of.values()
        if turn.agent is not parent
        and turn.agent.species == parent.species
        and turn.agent.ready_until >= world.step
        and not turn.starved
    ]
    apart = {mate.agent_id: math.hypot(mate.x - parent.x, mate.y - parent.y) for mate in waiting}
    range_of = {mate.agent_id: species.body.radius + rules.of(mate).body.radius for mate in waiting}
    near = [mate for mate in waiting if apart[mate.agent_id] <= range_of[mate.agent_id] + species.birth.mating_range]
    return min(near, key=lambda mate: (apart[mate.agent_id], mate.agent_id), default=None)


def child_place(rules: Rules, world: World, parents: list[Agent]) -> tuple[float, float] | None:
    """A free place for a child, whose genes may set its radius."""
    parent, species = parents[0], rules.of(parents[0])
    radius = species.body.radius
    if species.genome.set and not rules.inherits_late:
        radius = rules.with_genes(parent.species, next_genome(rules, world, parents)).body.radius
    for i in range(species.birth.attempts):
        aside, along = normals(*rules.draw("child_place", parent.agent_id, world.step, i)[:2])
        x, y = parent.x + species.distance_sd * aside, parent.y + species.distance_sd * along
        if is_free(rules, world, x, y, radius):
            return x, y
    return None


def bear(rules: Rules, world: World, parents: list[Agent], place: tuple[float, float]) -> None:
    first, species, child_id = parents[0], rules.of(parents[0]), world.next_agent_id
    sums = world.sums[species.number]
    energy, store = 0.0, dict.fromkeys(species.store, 0.0)
    for parent in parents:
        share = rules.of(parent).energy.child_share / len(parents)
        energy += share * parent.energy
        sums["energy_shared"] += share * parent.energy
        parent.energy *= 1 - share
        for name, own in rules.of(parent).store.items():
            part = own.child_share / len(parents)
            store[name] += part * parent.store[name]
            parent.store[name] *= 1 - part
        parent.children += 1
        parent.births = (parent.births or 0) + 1
        parent.ready_until = -1
    vacancy = world.vacancies[species.number].pop()
    child = Agent(
        child_id,
        species.number,
        *place,
        child_heading(rules, world, child_id),
        energy,
        child_genome(rules, world, parents, vacancy.genome),
        store,
        parent_id=first.agent_id,
        mate_id=parents[1].agent_id if len(parents) == 2 else -1,
        generation=1 + max(parent.generation for parent in parents),
        birth_step=world.step + 1,
        eaten=[0] * len(first.eaten),
        memory=memory_of(species),
        last=[0.0] * len(kept_names(species)),
        birth_energy=energy,
        resident_slot=vacancy.resident_slot,
    )
    world.agents.append(child)
    world.next_agent_id += 1
    world.births_in_window += 1
    sums["births"] += 1


def child_heading(rules: Rules, world: World, child_id: int) -> float:
    of, step = (0, world.step) if rules.shared_heading else (child_id, 0)
    return 2 * math.pi * uniform(rules.draw("child_heading", of, step)[0])


def child_genome(rules: Rules, world: World, parents: list[Agent], before: np.ndarray) -> np.ndarray:
    """The genome of the next child. If newborns inherit late, it is the one that was in its slot `before`."""
    first, species, child_id = parents[0], rules.of(parents[0]), world.next_agent_id
    if rules.inherits_late:
        among = [newborn.agent_id for newborn in world.newborns]
        at = among.index(first.agent_id) if first.agent_id in among else -1
        world.newborns.append(Newborn(child_id, species.number, at, first.genome))
        return before
    return next_genome(rules, world, parents)


def next_genome(rules: Rules, world: World, parents: list[Agent]) -> np.ndarray:
    """The genome of the next child if it inherits at birth."""
    first, species, child_id = parents[0], rules.of(parents[0]), world.next_agent_id
    genome = first.genome
    if len(parents) == 2:
        genome = recombined(rules, genome, parents[1].genome, child_id)
    return mutated(rules, species, genome, child_id, world.births_before, world.births_in_window)


def open_window(rules: Rules, world: World) -> None:
    """Waiting newborns inherit, births are counted from 0 again, and occupied slots become resident slots."""
    for index, newborn in enumerate(world.newborns):
        parent = newborn.genome if newborn.parent < 0 else world.newborns[newborn.parent].genome
        species: Species = rules.species[newborn.species]
        newborn.genome = mutated(rules, species, parent, newborn.agent_id, world.births_in_window, index)
        for agent in world.agents:
            if agent.agent_id == newborn.agent_id:
                agent.genome = newborn.genome
    world.newborns = []
    world.births_before, world.births_in_window = world.births_in_window, 0
    for agent in world.agents:
        agent.resident_slot = rules.resident_slots_only
    for vacancy in (vacancy for each in world.vacancies for vacancy in each):
        vacancy.resident_slot = False
