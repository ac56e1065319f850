"""The rules of a world again, in plain, slow Python: `found` makes a world, `advance` takes it to the next step.

This folder is written from docs/model.md, not from the engine, but with the same counter-based random numbers, so it
can predict every decision of the engine. Physics, rays and the learning of networks have separate tests.
`advance` takes a world at the start of a step, what its agents did and where physics moved them, and returns the world
after the step.
"""

from collections.abc import Callable, Sequence

import numpy as np
from reference.birth import breed, is_free, open_window
from reference.chance import factor_at
from reference.channel import channel, kept_names
from reference.draw import fine_uniform, normals, uniform
from reference.heredity import first_genome
from reference.meal import eat, hunt
from reference.metabolism import motor_forces, pay
from reference.place import TRIES, candidate
from reference.rule_book import RuleBook, memory_of
from reference.sense import smells
from reference.setting import Rules, Species
from reference.state import COUNTED, HARMED, HUNTED, Agent, Deed, Outcome, Stock, Turn, Vacancy, World

from hedon.config.config import Config


class Model:
    """The rules of one world under a config and a seed."""

    def __init__(self, config: Config, seed: int) -> None:
        self.rules = Rules(config, seed)
        self.book = RuleBook(self.rules)

    # The beginning.

    def found(self) -> World:
        rules = self.rules
        meals = len(rules.kinds) + len(rules.names) * rules.hunting
        world = World(
            *(0, 0, 0, 0, []),
            stocks=[Stock(food.initial_count) for food in rules.foods],
            sums=[dict.fromkeys((*COUNTED, *HUNTED, *HARMED), 0.0) for _ in rules.species],
            meals=[[0] * meals for _ in rules.species],
            vacancies=[[] for _ in rules.species],
        )
        for species in rules.species:
            for _ in range(species.population.initial_count):
                world.agents.append(self.founder(world, species, meals))
                world.sums[species.number]["energy_initial"] += species.energy.initial
                world.next_agent_id += 1
        number = 0
        for species in rules.species:
            for _ in range(species.population.capacity - species.population.initial_count):
                late = first_genome(rules, species, number, "vacant_genome") if rules.inherits_late else None
                world.vacancies[species.number].append(Vacancy(np.zeros(len(species.genes)) if late is None else late))
                number += 1
        for k in range(len(rules.kinds)):
            self.place_food(world, k, "initial_food", TRIES)
        return world

    def founder(self, world: World, species: Species, meals: int) -> Agent:
        draw, number = self.rules.draw, world.next_agent_id
        genome = first_genome(self.rules, species, number, "initial_genome")
        radius = self.rules.with_genes(species.number, genome).body.radius
        places = (self.rules.arena.anywhere(draw("initial_place", number, 0, n)) for n in range(TRIES))
        return Agent(
            number,
            species.number,
            *next(place for place in places if is_free(self.rules, world, *place, radius)),
            species.population.heading_range * uniform(draw("initial_heading", number, 0)[0]),
            species.energy.initial,
            genome,
            {name: store.initial for name, store in species.store.items()},
            eaten=[0] * meals,
            memory=memory_of(species),
            last=[0.0] * len(kept_names(species)),
            birth_energy=species.energy.initial,
            resident_slot=self.rules.resident_slots_only,
        )

    # One step.

    def advance(self, before: World, deeds: Sequence[Deed]) -> Outcome:
        rules, world = self.rules, before.copy()
        turns: list[Turn] = []
        turns += [self.act(before, turns, *each) for each in zip(before.agents, world.agents, deeds, strict=True)]
        eat(rules, world, turns)
        for turn in turns:
            pay(rules, world, turn)
        hunt(rules, world, turns)
        rewards = {}
        for turn in turns:
            rewards[turn.agent.agent_id] = self.book.reward(world, turn)
            turn.agent.reward += rewards[turn.agent.agent_id]
            names = kept_names(rules.of(turn.agent))
            turn.agent.last = [channel(rules, world, turn, name) for name in names]
        for turn in turns:
            self.draw_fate(world, turn)
        outcome = Outcome(world, turns, rewards, [], [])
        self.reap(outcome, turns, lambda turn: turn.caught)
        if rules.births_first:
            breed(rules, world, turns, lambda turn: self.draw_death(world, turn))
        self.reap(outcome, turns, lambda turn: turn.dies and not turn.caught)
        if not rules.births_first:
            breed(rules, world, turns, lambda turn: None)
        self.grow(world)
        world.step += 1
        if world.step % rules.window == 0 and world.agents:
            open_window(rules, world)
        return outcome

    def act(self, before: World, company: list[Turn], start: Agent, agent: Agent, deed: Deed) -> Turn:
        """What an agent sensed and did, and where it ended."""
        agent.x, agent.y, agent.angle = deed.x, deed.y, deed.angle
        forces = motor_forces(self.rules.of(agent), deed.action, start)
        smelled = smells(self.rules, before, start)
        return Turn(agent, start, deed, [0] * len(agent.eaten), forces, smelled, before, company)

    def draw_fate(self, world: World, turn: Turn) -> None:
        """Draws whether an agent has a child and whether it dies. If it starved or was eaten, it dies without one."""
        high, low, *_ = self.rules.draw("life_and_death", turn.agent.agent_id, world.step)
        lost = turn.starved or turn.caught
        turn.breeds = not lost and fine_uniform(high, low) < self.book.birth_chance(world, turn)
        self.draw_death(world, turn)

    def draw_death(self, world: World, turn: Turn) -> None:
        """Draws whether an agent dies, given its current energy."""
        *_, high, low = self.rules.draw("life_and_death", turn.agent.agent_id, world.step)
        by_chance = fine_uniform(high, low) < self.book.death_chance(world, turn)
        turn.dies = turn.starved or turn.caught or by_chance

    def reap(self, outcome: Outcome, turns: list[Turn], dies: Callable[[Turn], bool]) -> None:
        """Removes the agents that die; the children of this step are not at risk yet."""
        world = outcome.world
        for turn in filter(dies, turns):
            agent, sums = turn.agent, world.sums[turn.agent.species]
            cause = "eaten" if turn.caught else "starved" if turn.starved else "age_energy"
            world.agents.remove(agent)
            world.vacancies[agent.species].append(Vacancy(agent.genome, agent.resident_slot))
            outcome.dead.append(agent)
            outcome.causes.append(cause)
            sums["deaths"] += 1
            sums["energy_lost"] += agent.energy
            if cause != "age_energy":
                sums[f"deaths_{cause}"] += 1
            if cause == "eaten":
                sums["energy_prey"] += agent.energy

    def grow(self, world: World) -> None:
        for k, (food, stock) in enumerate(zip(self.rules.foods, world.stocks, strict=True)):
            growth = factor_at(food.schedule, "growth_rate", world.step) * food.growth_rate
            stock.number = min(stock.number + growth, factor_at(food.schedule, "capacity", world.step) * food.capacity)
            self.place_food(world, k, "food_place", food.candidates)

    def place_food(self, world: World, k: int, purpose: str, candidates: int) -> None:
        rules, stock, placement = self.rules, world.stocks[k], self.rules.foods[k].placement
        for i in range(candidates):
            if len(stock.foods) >= int(stock.number):
                return
            words = rules.draw(purpose, k, world.step, i)
            x, y = candidate(rules.arena, placement, stock.center, world.step, words)
            near = any((fx - x) ** 2 + (fy - y) ** 2 < placement.spacing**2 for fx, fy in stock.foods)
            if not near and is_free(rules, world, x, y, rules.food_radius):
                stock.foods.append((x, y))

    # Policies without networks.

    def action(self, world: World, agent: Agent, told: tuple[float, float]) -> tuple[float, float]:
        """An agent's action under a policy without a network; `told` is the last action given by a program."""
        policy = self.rules.of(agent).learning.policy
        if policy == "random":
            return normals(*self.rules.draw("action", agent.agent_id, world.step)[:2])
        return told if policy == "external" else (0.0, 0.0)
