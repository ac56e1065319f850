"""The rules of a world once more, in plain and slow Python: who eats, pays, is rewarded, breeds and dies.

Written from docs/model.md, not from the engine, but with the same counted random numbers, so that the engine's
every decision can be predicted: `advance` takes a world at the start of a step, what its agents did and where physics
moved them, and says what the world is after the step. Physics, senses and learning have judges of their own.
"""

import math
from copy import deepcopy
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from reference_draw import PURPOSES, cauchy, fine_uniform, normals, philox, uniform

from hedon.config.arena import outer_count, walls
from hedon.config.config import Config

FOUNDING_TRIES = 20_000
COUNTED = (
    *("births", "deaths", "births_failed_full", "births_failed_space", "agent_steps"),
    *("energy_initial", "energy_eaten", "energy_basic", "energy_action", "energy_forgiven", "energy_capped"),
    *("energy_shared", "energy_lost"),
)


@dataclass
class Agent:
    """One living agent. Lengths in u, ages and steps in steps."""

    agent_id: int
    x: float
    y: float
    angle: float
    energy: float
    genome: np.ndarray
    parent_id: int = -1
    generation: int = 0
    birth_step: int = 0
    children: int = 0
    eaten: list[int] = field(default_factory=list)
    old_slot: bool = False
    """Whether somebody lived in its slot when the window began."""


@dataclass
class Stock:
    """The supply of one food kind; `foods` are the places of those present."""

    number: float
    eaten: int = 0
    center: int = 0
    foods: list[tuple[float, float]] = field(default_factory=list)


@dataclass
class Vacancy:
    """What the dead left in a free slot, and whether somebody lived there when the window began."""

    genome: np.ndarray
    old_slot: bool = False


@dataclass
class Newborn:
    """A birth of this window; `parent` is its place among the newborns, or -1 with the older parent's genome."""

    agent_id: int
    parent: int
    genome: np.ndarray


@dataclass
class World:
    """A world between two steps; `agents` in the order of their ids, the vacancy that is used next at the end."""

    step: int
    next_agent_id: int
    births_in_window: int
    births_before: int
    agents: list[Agent]
    stocks: list[Stock]
    counters: dict[str, float]
    vacancies: list[Vacancy]
    newborns: list[Newborn] = field(default_factory=list)
    ghosts: list[tuple[float, float]] = field(default_factory=list)
    """Foods just eaten that rays still meet."""


@dataclass
class Deed:
    """What one agent did in a step: its action, where it ended, and the foods (kind, index) that met its mouth."""

    action: tuple[float, float]
    x: float
    y: float
    angle: float
    mouthfuls: list[tuple[int, int]]


@dataclass
class Outcome:
    """The world after a step, the reward of each agent that lived in it, and those who died."""

    world: World
    rewards: dict[int, float]
    dead: list[Agent]


def _rounded(value: Any) -> Any:
    """Settings as the engine holds them: floats of 32 bits."""
    if isinstance(value, dict):
        return {name: _rounded(inner) for name, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(inner) for inner in value]
    return float(np.float32(value)) if isinstance(value, float) else value


def _plain(config: Config) -> dict[str, Any]:
    """The sections of a config with one species, its kinds of food as a list."""
    plain = asdict(config)
    foods = list(plain["food"].values())
    plain["genome"]["food"] = [food["gene"] for food in foods]
    plain["food"] = foods
    scale = config.arena.width if config.birth.distance_unit == "arena_width" else 1.0
    plain["birth"]["distance_sd"] = (config.birth.distance_sd * scale,) * 2
    return plain


class Model:
    """The rules of one world under a config and a seed."""

    def __init__(self, config: Config, seed: int) -> None:
        self.config = _rounded(_plain(config))
        self.seed = seed
        self.walls = walls(config.arena).astype(float).tolist()
        self.outline = self.walls[: outer_count(config.arena)]

    def draw(self, purpose: str, of: int, step: int, index: int = 0) -> tuple[int, int, int, int]:
        return philox((index, PURPOSES.index(purpose), of, step), (self.seed & 0xFFFFFFFF, self.seed >> 32))

    # Where something may stand.

    def is_inside(self, x: float, y: float, radius: float) -> bool:
        crossings = sum(
            (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax) for ax, ay, bx, by in self.outline
        )
        return crossings % 2 == 1 and all(_wall_distance(x, y, wall) >= radius for wall in self.walls)

    def is_free(self, world: World, x: float, y: float, radius: float) -> bool:
        body = self.config["body"]
        near_agent = any(math.hypot(a.x - x, a.y - y) < radius + body["radius"] for a in world.agents)
        near_food = any(
            math.hypot(fx - x, fy - y) < radius + body["food_radius"] for s in world.stocks for fx, fy in s.foods
        )
        return self.is_inside(x, y, radius) and not near_agent and not near_food

    def anywhere(self, words: tuple[int, int, int, int]) -> tuple[float, float]:
        arena = self.config["arena"]
        return arena["width"] * uniform(words[0]), arena["height"] * uniform(words[1])

    # Chances.

    def hazard(self, age: int, energy: float) -> float:
        h = self.config["hazard"]
        by_energy = h["kappa"] * (1 - 1 / (1 + h["alpha_energy"] * math.exp(-h["beta_energy"] * energy)))
        return by_energy + h["alpha_age"] * math.exp(h["beta_age"] * age)

    def birth_rate(self, energy: float) -> float:
        b = self.config["birth"]
        return b["kappa"] / (1 + math.exp(-b["beta"] * energy))

    # The beginning.

    def found(self) -> World:
        population, body, kinds = self.config["population"], self.config["body"], self.config["food"]
        late = self.config["birth"]["inheritance"] == "at_window_end"
        stocks, free = (
            [Stock(kind["initial_count"]) for kind in kinds],
            population["capacity"] - population["initial_count"],
        )
        vacancies = [Vacancy(self.first_genome(i, "vacant_genome") * late) for i in range(free)]
        world = World(0, 0, 0, 0, [], stocks, dict.fromkeys(COUNTED, 0.0), vacancies)
        for i in range(population["initial_count"]):
            places = (self.anywhere(self.draw("initial_place", i, 0, n)) for n in range(FOUNDING_TRIES))
            x, y = next(place for place in places if self.is_free(world, *place, body["radius"]))
            angle = population["heading_range"] * uniform(self.draw("initial_heading", i, 0)[0])
            energy = self.config["energy"]["initial"]
            genome, old = self.first_genome(i, "initial_genome"), self.config["birth"]["parents"] == "old_slots"
            world.agents.append(Agent(i, x, y, angle, energy, genome, eaten=[0] * len(kinds), old_slot=old))
            world.counters["energy_initial"] += energy
            world.next_agent_id += 1
        for k in range(len(kinds)):
            self.place_food(world, k, "initial_food", 0, FOUNDING_TRIES)
        return world

    def first_genome(self, of: int, purpose: str) -> np.ndarray:
        g = self.config["genome"]
        genes = [*g["food"], g["action"], *[g["neutral"]] * g["neutral_count"]]
        means, sds = (np.array([gene[name] for gene in genes]) for name in ("initial_mean", "initial_sd"))
        noise = [normals(*self.draw(purpose, of, 0, i)[:2])[0] for i in range(len(genes))]
        return np.clip(means + sds * np.array(noise), -g["weight_limit"], g["weight_limit"])

    # One step.

    def advance(self, before: World, deeds: list[Deed]) -> Outcome:
        world = deepcopy(before)
        for agent, deed in zip(world.agents, deeds, strict=True):
            agent.x, agent.y, agent.angle = deed.x, deed.y, deed.angle
        meals = self.eat(world, deeds)
        rewards, starved = {}, set()
        for agent, deed, meal in zip(world.agents, deeds, meals, strict=True):
            force = self.force(deed.action)
            if self.pay(world, agent, meal, force):
                starved.add(agent.agent_id)
            rewards[agent.agent_id] = self.reward(agent.genome, meal, force)
        if self.config["birth"]["order"] == "before_deaths":
            self.breed(world, starved)
            dead = self.reap(world, starved)
        else:
            dead = self.reap(world, starved)
            self.breed(world, starved)
        self.grow(world)
        world.step += 1
        if world.step % self.config["learning"]["rollout_steps"] == 0 and world.agents:
            self.open_window(world)
        return Outcome(world, rewards, dead)

    def eat(self, world: World, deeds: list[Deed]) -> list[list[int]]:
        """Each food goes to the nearest of those whose mouths it met, or to all; returns meals by agent and kind."""
        world.ghosts = []
        meals = [[0] * len(world.stocks) for _ in deeds]
        for k, stock in enumerate(world.stocks):
            left = []
            for f, (x, y) in enumerate(stock.foods):
                rivals = [i for i, deed in enumerate(deeds) if (k, f) in deed.mouthfuls]
                if self.config["sensor"]["mouths"] == "nearest":
                    rivals = sorted(rivals, key=lambda i: math.hypot(deeds[i].x - x, deeds[i].y - y))[:1]
                for eater in rivals:
                    meals[eater][k] += 1
                if not rivals:
                    left.append((x, y))
                elif self.config["sensor"]["eaten_food"] == "seen":
                    world.ghosts.append((x, y))
            gone, fed = len(stock.foods) - len(left), sum(meal[k] for meal in meals)
            stock.foods = left
            placement = self.config["food"][k]["placement"]
            if placement["form"] == "switching":
                turns = (stock.eaten + fed) // placement["switch_after"] - stock.eaten // placement["switch_after"]
                stock.center = (stock.center + turns) % len(placement["centers"])
            stock.eaten += fed
            stock.number -= gone
        return meals

    def force(self, action: tuple[float, float]) -> float:
        low, high = self.config["motor"]["min_force"], self.config["motor"]["max_force"]
        return math.hypot(*(low + (high - low) / (1 + math.exp(-a)) for a in action))

    def pay(self, world: World, agent: Agent, meal: list[int], force: float) -> bool:
        """Energy and its ledger; True where the agent starves."""
        e, c = self.config["energy"], world.counters
        gain = sum(kind["energy"] * n for kind, n in zip(self.config["food"], meal, strict=True))
        action = e["action_cost"] * force
        wanted = agent.energy + gain - action - e["basic_cost"]
        agent.energy = min(max(wanted, 0.0), e["capacity"])
        agent.eaten = [all_before + n for all_before, n in zip(agent.eaten, meal, strict=True)]
        c["agent_steps"] += 1
        c["energy_eaten"] += gain
        c["energy_action"] += action
        c["energy_basic"] += e["basic_cost"]
        c["energy_forgiven"] += max(-wanted, 0.0)
        c["energy_capped"] += max(wanted - e["capacity"], 0.0)
        return wanted < 0 and e["starvation"] == "death"

    def reward(self, genome: np.ndarray, meal: list[int], force: float) -> float:
        settings = self.config["reward"]
        largest = self.config["motor"]["max_force"] * math.sqrt(2)
        strength = force / largest if settings["action_norm"] == "max_force" else force
        return float(genome[: len(meal)] @ meal + settings["action_coef"] * genome[len(meal)] * strength)

    def breed(self, world: World, starved: set[int]) -> None:
        """Who drew a birth has a child, but for those who starve in this step, or have to wait."""
        parents, old_only = [], self.config["birth"]["parents"] == "old_slots"
        for agent in world.agents:
            high, low, *_ = self.draw("life_and_death", agent.agent_id, world.step)
            waits = old_only and not agent.old_slot
            if not waits and agent.agent_id not in starved and fine_uniform(high, low) < self.birth_rate(agent.energy):
                parents.append(agent)
        for parent in sorted(parents, key=lambda a: self.draw("parent_order", a.agent_id, world.step)[0]):
            if len(world.agents) == self.config["population"]["capacity"]:
                world.counters["births_failed_full"] += 1
                continue
            place = self.child_place(world, parent)
            if place is None:
                world.counters["births_failed_space"] += 1
            else:
                self.bear(world, parent, place)

    def child_place(self, world: World, parent: Agent) -> tuple[float, float] | None:
        birth = self.config["birth"]
        for i in range(birth["attempts"]):
            aside, along = normals(*self.draw("child_place", parent.agent_id, world.step, i)[:2])
            x, y = parent.x + birth["distance_sd"][0] * aside, parent.y + birth["distance_sd"][1] * along
            if self.is_free(world, x, y, self.config["body"]["radius"]):
                return x, y
        return None

    def bear(self, world: World, parent: Agent, place: tuple[float, float]) -> None:
        child_id = world.next_agent_id
        share = self.config["energy"]["birth_share"] * parent.energy
        parent.energy -= share
        parent.children += 1
        shared = self.config["birth"]["heading"] == "shared"
        of, step = (0, world.step) if shared else (child_id, 0)
        angle = 2 * math.pi * uniform(self.draw("child_heading", of, step)[0])
        vacancy = world.vacancies.pop()
        if self.config["birth"]["inheritance"] == "at_birth":
            genome = self.mutate(parent.genome, child_id, world.births_before, world.births_in_window)
        else:
            genome = vacancy.genome
            among = [newborn.agent_id for newborn in world.newborns]
            at = among.index(parent.agent_id) if parent.agent_id in among else -1
            world.newborns.append(Newborn(child_id, at, parent.genome))
        family = (parent.agent_id, parent.generation + 1, world.step + 1)
        child = Agent(child_id, *place, angle, share, genome, *family, eaten=[0] * len(world.stocks))
        child.old_slot = vacancy.old_slot
        world.agents.append(child)
        world.next_agent_id += 1
        world.births_in_window += 1
        world.counters["births"] += 1
        world.counters["energy_shared"] += share

    def open_window(self, world: World) -> None:
        """Newborns that waited inherit; births are counted from 0, and taken slots are old."""
        for index, newborn in enumerate(world.newborns):
            parent = newborn.genome if newborn.parent < 0 else world.newborns[newborn.parent].genome
            newborn.genome = self.mutate(parent, newborn.agent_id, world.births_in_window, index)
            for agent in world.agents:
                if agent.agent_id == newborn.agent_id:
                    agent.genome = newborn.genome
        world.newborns = []
        world.births_before, world.births_in_window = world.births_in_window, 0
        old = self.config["birth"]["parents"] == "old_slots"
        for agent in world.agents:
            agent.old_slot = old
        for vacancy in world.vacancies:
            vacancy.old_slot = False

    def mutate(self, genome: np.ndarray, child_id: int, births: int, index: int) -> np.ndarray:
        g = self.config["genome"]
        frozen = g["mutation_noise"] == "frozen"
        stream = ("frozen_mutation", index, births) if frozen else ("mutation", child_id, 0)
        noise = np.array([cauchy(self.draw(*stream, i)[0]) for i in range(len(genome))])
        return np.clip(genome + g["mutation_scale"] * noise, -g["weight_limit"], g["weight_limit"])

    def reap(self, world: World, starved: set[int]) -> list[Agent]:
        """Takes out those who die; the children of this step are not at risk yet."""
        dead = []
        for agent in world.agents:
            age = world.step + 1 - agent.birth_step
            *_, high, low = self.draw("life_and_death", agent.agent_id, world.step)
            by_chance = fine_uniform(high, low) < self.hazard(age, agent.energy)
            if age > 0 and (by_chance or agent.agent_id in starved):
                dead.append(agent)
        gone = {agent.agent_id for agent in dead}
        world.agents = [agent for agent in world.agents if agent.agent_id not in gone]
        world.vacancies += [Vacancy(agent.genome, agent.old_slot) for agent in dead]
        world.counters["deaths"] += len(dead)
        world.counters["energy_lost"] += sum(agent.energy for agent in dead)
        return dead

    def grow(self, world: World) -> None:
        for k, (kind, stock) in enumerate(zip(self.config["food"], world.stocks, strict=True)):
            stock.number = min(stock.number + kind["growth_rate"], kind["capacity"])
            self.place_food(world, k, "food_place", world.step, kind["candidates"])

    def place_food(self, world: World, k: int, purpose: str, step: int, candidates: int) -> None:
        stock, placement = world.stocks[k], self.config["food"][k]["placement"]
        for i in range(candidates):
            if len(stock.foods) >= math.floor(stock.number):
                return
            words = self.draw(purpose, k, step, i)
            if placement["form"] == "uniform":
                x, y = self.anywhere(words)
            else:
                center, noise = placement["centers"][stock.center], normals(*words[:2])
                x, y = (center[axis] + placement["sd"][axis] * noise[axis] for axis in (0, 1))
            if self.is_free(world, x, y, self.config["body"]["food_radius"]):
                stock.foods.append((x, y))


def _wall_distance(x: float, y: float, wall: list[float]) -> float:
    ax, ay, bx, by = wall
    ex, ey = bx - ax, by - ay
    t = min(max(((x - ax) * ex + (y - ay) * ey) / (ex * ex + ey * ey), 0.0), 1.0)
    return math.hypot(ax + t * ex - x, ay + t * ey - y)
