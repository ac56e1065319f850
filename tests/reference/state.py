"""A world between two steps, and what its agents do in one."""

from copy import copy
from dataclasses import dataclass, field, replace

import numpy as np

COUNTED = (
    *("births", "deaths", "births_failed_full", "births_failed_space", "agent_steps"),
    *("energy_initial", "energy_eaten", "energy_basic", "energy_action", "energy_forgiven", "energy_capped"),
    *("energy_shared", "energy_lost"),
)
HUNTED = ("deaths_starved", "deaths_eaten", "energy_hunted", "energy_prey")
"""Counted where agents eat agents."""
HARMED = ("obstacles_touched", "energy_damage")
"""Counted where there are obstacles."""


@dataclass(eq=False)
class Agent:
    """One living agent. Lengths in u, ages and steps in steps; `species` counts from 0."""

    agent_id: int
    species: int
    x: float
    y: float
    angle: float
    energy: float
    genome: np.ndarray
    store: dict[str, float] = field(default_factory=dict)
    """What it holds of each store but energy."""
    parent_id: int = -1
    mate_id: int = -1
    generation: int = 0
    birth_step: int = 0
    children: int = 0
    births: int | None = 0
    """Children that it had in the last step; None where the engine does not count them."""
    eaten: list[int] = field(default_factory=list)
    """Foods of each kind, then agents of each species."""
    digestion: int = 0
    """Steps until it can eat another agent."""
    ready_until: int = -1
    """Last step in which it waits for a second parent."""
    memory: list[float] = field(default_factory=list)
    last: list[float] = field(default_factory=list)
    """What of the last step it observes in the next one."""
    birth_energy: float = 0.0
    energy_gained: float = 0.0
    energy_spent: float = 0.0
    distance: float = 0.0
    force_left: float = 0.0
    force_right: float = 0.0
    reward: float = 0.0
    resident_slot: bool = False
    """Whether somebody lived in its slot when the window began."""

    @property
    def held(self) -> dict[str, float]:
        """What it holds of each store."""
        return {"energy": self.energy, **self.store}


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
    resident_slot: bool = False


@dataclass
class Newborn:
    """A birth of this window; `parent` is its place among the newborns, or -1 with the older parent's genome."""

    agent_id: int
    species: int
    parent: int
    genome: np.ndarray


@dataclass
class World:
    """A world between two steps; `agents` in the order of their ids. Of each species: sums, meals by kind, and
    vacancies, of which the last is used next."""

    step: int
    next_agent_id: int
    births_in_window: int
    births_before: int
    agents: list[Agent]
    stocks: list[Stock]
    sums: list[dict[str, float]]
    meals: list[list[int]]
    vacancies: list[list[Vacancy]]
    newborns: list[Newborn] = field(default_factory=list)
    eaten_foods: list[tuple[float, float, int]] = field(default_factory=list)
    """Foods just eaten that rays still meet, with their kinds."""

    def copy(self) -> "World":
        """The same world; genomes are never changed in place."""
        return replace(
            self,
            agents=[replace(a, eaten=[*a.eaten], memory=[*a.memory], store={**a.store}) for a in self.agents],
            stocks=[replace(stock, foods=[*stock.foods]) for stock in self.stocks],
            sums=[{**sums} for sums in self.sums],
            meals=[[*meals] for meals in self.meals],
            vacancies=[[copy(vacancy) for vacancy in each] for each in self.vacancies],
            newborns=[copy(newborn) for newborn in self.newborns],
            eaten_foods=[*self.eaten_foods],
        )


@dataclass
class Deed:
    """What one agent did in a step: its action, and where it ended.

    mouthfuls   foods (kind, index) that met its mouth
    prey        ids of the agents that its mouth touched and that it may eat
    obstacles   those that it touched, by their numbers
    seen        (rays, types that it sees) what it acted on
    motion      its velocity along x and y, and its angular velocity; where it ended, as the place
    felt        bit channel · sectors + sector of what it touched
    replaced    it died, and a newborn lies in its slot: where it ended is not known
    gone        it was eaten, and replaced: of several in a mouth it was the nearest
    """

    action: tuple[float, float]
    x: float
    y: float
    angle: float
    mouthfuls: list[tuple[int, int]]
    prey: list[int]
    obstacles: list[int]
    seen: np.ndarray
    motion: tuple[float, float, float]
    felt: int
    replaced: bool = False
    gone: bool = False


@dataclass
class Turn:
    """One agent's step, as it goes on: what it was at the start, what it did, and what came of it.

    before    the world at the start
    company   the turns of all agents
    """

    agent: Agent
    start: Agent
    deed: Deed
    meal: list[int]
    forces: tuple[float, float]
    smelled: np.ndarray
    before: World
    company: "list[Turn]"
    starved: bool = False
    caught: bool = False
    """Another agent ate it."""
    breeds: bool = False
    dies: bool = False


@dataclass
class Outcome:
    """The world after a step, the turns and rewards of those who lived in it, those who died, and why."""

    world: World
    turns: list[Turn]
    rewards: dict[int, float]
    dead: list[Agent]
    causes: list[str]
