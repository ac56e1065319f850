"""What agents sense without rays: smell, their motion and what they hold."""

import math

import numpy as np
from reference.channel import channel, is_of_step, kept_names
from reference.setting import Rules
from reference.state import Agent, Turn, World


def smells(rules: Rules, world: World, agent: Agent) -> np.ndarray:
    """(channels, noses): the sum over all sources except the agent itself, at most 1."""
    species = rules.of(agent)
    sensor = species.sensor
    if not species.smells:
        return np.zeros((0, sensor.noses))
    sources = {name: [] for name in species.smells}
    for kind, stock in zip(rules.kinds, world.stocks, strict=True):
        sources.get(kind, []).extend(stock.foods)
    for x, y, kind in world.eaten_foods:
        sources.get(rules.kinds[kind], []).append((x, y))
    for other in world.agents:
        if other is not agent:
            sources.get(rules.names[other.species], []).append((other.x, other.y))
    angles = [0.0] if sensor.noses == 1 else [-math.radians(sensor.nose_angle), math.radians(sensor.nose_angle)]
    smelled = np.zeros((len(sources), len(angles)))
    reach = math.log(1e4 * rules.most_sources) / sensor.smell_decay
    for n, angle in enumerate(angles):
        toward = agent.angle + angle
        nose = agent.x - species.body.radius * math.sin(toward), agent.y + species.body.radius * math.cos(toward)
        for c, places in enumerate(sources.values()):
            near = [d for d in (math.dist(nose, place) for place in places) if d < reach]
            smelled[c, n] = min(1.0, sum(math.exp(-sensor.smell_decay * d) for d in near))
    return smelled


def body_sense(rules: Rules, world: World, turn: Turn) -> list[float]:
    """The part of the observation after rays and touch. In `turn`, the agent has done nothing yet."""
    agent, species = turn.agent, rules.of(turn.agent)
    vx, vy, spin = turn.deed.motion
    sensor = species.sensor
    held = {name: (agent.held[name], store.scale) for name, store in species.stores.items() if store.observed}
    if sensor.scaling == "raw":
        own = [vx, vy, agent.angle, spin, *(amount for amount, _ in held.values())]
    else:
        speed, heading = sensor.velocity_scale, [math.sin(agent.angle), math.cos(agent.angle)]
        own = [vx / speed, vy / speed, *heading, spin / sensor.angular_velocity_scale]
        own += [amount / scale for amount, scale in held.values()]
    last = dict(zip(kept_names(species), agent.last, strict=True))
    more = [
        (last[name] if is_of_step(name) else channel(rules, world, turn, name)) / scale
        for name, scale in sensor.observes.items()
    ]
    return [*own, *turn.smelled.ravel(), *more]
