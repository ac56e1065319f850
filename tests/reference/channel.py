"""What can be known about an agent in a step, by name: the channels in the tables of docs/guide/reward.md."""

import math

import numpy as np
from reference.chance import harmful
from reference.neighbor import meals_near, neighbors
from reference.setting import Rules, Species
from reference.state import Agent, Turn, World

OF_STEP = ("_before", "_change", "eaten_", "damage", "effort", "force", "_meals", "moved", "drive_reduction")
"""Beginnings and ends of the names of channels that are known only when a step is done."""


def is_of_step(name: str) -> bool:
    """Whether an agent that observes a channel gets its value of the previous step."""
    return name.startswith(OF_STEP) or name.endswith(OF_STEP)


def channel(rules: Rules, world: World, turn: Turn, name: str) -> float:
    """The value of one channel for an agent; `world` does not count this step yet."""
    agent, start, deed, species = turn.agent, turn.start, turn.deed, rules.of(turn.agent)
    if name in species.stores:
        return agent.held[name]
    if name in (f"{store}_before" for store in species.stores):
        return start.held[name.removesuffix("_before")]
    if name in (f"{store}_change" for store in species.stores):
        store = name.removesuffix("_change")
        return agent.held[store] - start.held[store]
    head, _, what = name.partition("_")
    if head == "eaten":
        return float(turn.meal[[*rules.kinds, *rules.names].index(what)])
    if head == "see":
        readings = np.maximum(deed.seen[:, species.sees.index(what.removesuffix("_max"))], 0)
        return float(readings.max() if what.endswith("_max") else readings.mean())
    if head == "smell":
        return float(turn.smelled[species.smells.index(what)].mean())
    if head == "contacts":
        return felt_sectors(species, turn, [species.touches.index(what)])
    if head == "season":
        angle = 2 * math.pi * world.step / year(rules, species)
        return math.sin(angle) if what == "sine" else math.cos(angle)
    for query in (query for query in species.neighbor if name.startswith(f"{query}_")):
        number = name.removeprefix(f"{query}_")
        if number == "meals":
            return meals_near(rules, turn, species.neighbor[query])
        return neighbors(rules, turn.before, turn.start, species.neighbor[query])[number]
    left, right = turn.forces
    plain = {
        "damage": lambda: rules.obstacle.damage * sum(each < harmful(rules, world.step) for each in deed.obstacles),
        "nearness": lambda: float(np.maximum(deed.seen, 0).sum(axis=1).mean()),
        "touched": lambda: felt_sectors(species, turn, range(len(species.touches))),
        "effort": lambda: math.hypot(left, right) / (species.max_force * math.sqrt(2)),
        "force_left": lambda: left,
        "force_right": lambda: right,
        "force": lambda: math.hypot(left, right),
        "moved": lambda: math.dist((deed.x, deed.y), (start.x, start.y)),
        "x": lambda: deed.x,
        "y": lambda: deed.y,
        "heading": lambda: deed.angle,
        "heading_sine": lambda: math.sin(start.angle),
        "heading_cosine": lambda: math.cos(start.angle),
        "velocity_x": lambda: deed.motion[0],
        "velocity_y": lambda: deed.motion[1],
        "angular_velocity": lambda: deed.motion[2],
        "age": lambda: world.step + 1 - agent.birth_step,
        "births": lambda: agent.births or 0,
        "waits": lambda: float(agent.ready_until >= world.step),
        "drive_reduction": lambda: drive(species, start) - drive(species, agent),
        "step": lambda: world.step,
        "alive": lambda: sum(each.species == agent.species for each in world.agents),
        "one": lambda: 1.0,
    }
    return float(plain[name]())


def drive(species: Species, agent: Agent) -> float:
    """How far the stores are from their set points, as fractions of their motor thresholds, if any, or capacities."""
    apart = []
    for name, store in species.stores.items():
        point = species.gene(agent.genome, "set_point" if name == "energy" else f"set_point_{name}")
        apart.append(abs(point - agent.held[name] / (store.motor_threshold or store.capacity)))
    return sum(each**species.reward.drive_exponent for each in apart) ** (1 / species.reward.drive_root)


def felt_sectors(species: Species, turn: Turn, types: range | list[int]) -> float:
    """The number of touch sectors that felt any of some types, which are indices into `species.touches`."""
    count = species.sensor.touch_sectors
    felt = [turn.deed.felt >> t * count & ((1 << count) - 1) for t in types]
    return float(np.bitwise_or.reduce(felt).item().bit_count())


def year(rules: Rules, species: Species) -> int:
    """The length of a species' year: its own setting, or else the period of the first schedule that has one."""
    schedules = [food.schedule for food in rules.foods] + [species.hazard.schedule, rules.obstacle.schedule]
    periods = [species.sensor.season_period, *(each.period for table in schedules for each in table.values())]
    return next(period for period in periods if period)


PLACED = ("x", "y", "moved", "touched", "contacts_", "velocity_", "angular_velocity", "heading")
"""Beginnings of the names of channels that depend on where a step ended."""
COMPANY = "_meals"
"""The end of the names of channels that depend on where all other agents ended."""


def paid_names(species: Species) -> list[str]:
    """The channels that a species' gate and its terms for channels read."""
    return [species.reward.gate, *(pay.channel or name for name, pay in species.reward.pay.items())]


def is_paid_by_place(species: Species, others: bool) -> bool:
    """Whether the reward depends on where a step ended for the agent itself, or for the others."""
    found = ((name.endswith(COMPANY) if others else name.startswith(PLACED)) for name in paid_names(species))
    return any(found)


def kept_names(species: Species) -> list[str]:
    """The channels of a step that are kept for the next observation, in order."""
    return [name for name in species.sensor.observes if is_of_step(name)]
