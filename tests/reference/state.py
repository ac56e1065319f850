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
"""Counted if agents eat agents."""
HARMED = ("obstacles_touched", "energy_damage")
"""Counted if there are obstacles."""


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
    """What it holds of each store except energy."""
    parent_id: int = -1
    mate_id: int = -1
    generation: int = 0
    birth_step: int = 0
    children: int = 0
    births: int | None = 0
    """Children that it had in the last step; None if the engine does not count them."""
    eaten: list[int] = field(default_factory=list)
    """Foods of each kind, then agents of each species."""
    digestion: int = 0
    """Steps until it can eat another agent."""
    ready_until: int = -1
    """Last step in which it waits for a second parent."""
    memory: list[float] = field(default_factory=list)
    last: list[float] = field(default_factory=list)
    """Values of the last step that it observes in the next one."""
    birth_energy: float = 0.0
    energy_gained: float = 0.0
    energy_spent: float = 0.0
    distance: float = 0.0
    force_left: float = 0.0
    force_right: float = 0.0
    reward: float = 0.0
    resident_slot: bool = False
    """Whether its slot was occupied when the window began."""

    @property
    def held(self) -> dict[str, float]:
        """What it holds of each store."""
        return {"energy": self.energy, **self.store}


@dataclass
class Stock:
    """The supply of one kind of food; `foods` are the places of those present."""

    number: float
    eaten: int = 0
    center: int = 0
    foods: list[tuple[float, float]] = field(default_factory=list)


@dataclass
class Vacancy:
    """A free slot: the genome left in it, and whether it was occupied when the window began."""

    genome: np.ndarray
    resident_slot: bool = False


@dataclass
class Newborn:
    """A birth in this window; `parent` is the parent's index among newborns, or -1 for an older one with `genome`."""

    agent_id: int
    species: int
    parent: int
    genome: np.ndarray


@dataclass
class World:
    """A world between two steps, with `agents` in the order of their ids. For each species: sums, meals by kind, and
    vacancies, the last of which is used next."""

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
    """Foods just eaten that rays still hit, with their kinds."""

    def copy(self) -> "World":
        """A copy that shares the genomes, which are never changed in place."""
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
    obstacles   numbers of the obstacles that it touched
    seen        (rays, types that it sees) the readings that it acted on
    motion      its velocity along x and y, and its angular velocity, at the end of the step
    felt        what it touched, as a bit mask: bit channel · sectors + sector
    replaced    it died, and a newborn is in its slot, so where it ended is not known
    gone        it was eaten and replaced, so it counts as the nearest of several in a mouth
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
    """One agent's step in progress: its state at the start, what it did, and the result.

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
    """The world after a step, the turns and rewards of the agents that lived in it, those that died, and why."""

    world: World
    turns: list[Turn]
    rewards: dict[int, float]
    dead: list[Agent]
    causes: list[str]
