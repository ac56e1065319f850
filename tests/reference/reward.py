"""The inherited reward of a step."""

import math

import numpy as np
from reference.metabolism import sigmoid
from reference.setting import Rules, Species
from reference.state import Agent, Turn


def inputs(rules: Rules, turn: Turn) -> dict[str, float]:
    """What is paid for, by name."""
    species, settings = rules.of(turn.agent), rules.of(turn.agent).reward
    found = {name: float(n) for name, n in zip([*rules.kinds, *rules.names], turn.meal, strict=False)}
    found = {name: n for name, n in found.items() if name in species.eats}
    force, largest = math.hypot(*turn.forces), species.max_force * math.sqrt(2)
    found["action"] = force / largest if settings.action_norm == "max_force" else force
    for name, see in settings.see.items():
        readings = np.maximum(turn.deed.seen[:, species.sees.index(see.reads or name)], 0)
        found[f"see_{name}"] = float(readings.mean() if see.over_rays == "mean" else readings.max())
    for name in settings.smell:
        found[f"smell_{name}"] = float(turn.smelled[species.smells.index(name)].mean())
    if settings.drive_reduction_coef:
        found["drive_reduction"] = drive(species, turn.start) - drive(species, turn.agent)
    return found


def drive(species: Species, agent: Agent) -> float:
    """Distance of the stores from their set points, in shares of their capacities, or of where they weaken motors."""
    apart = []
    for name, store in species.stores.items():
        point = species.gene(agent.genome, "set_point" if name == "energy" else f"set_point_{name}")
        apart.append(point - agent.held[name] / (store.motor_threshold or store.capacity))
    return math.hypot(*apart)


def reward(rules: Rules, turn: Turn, step: int) -> float:
    species = rules.of(turn.agent)
    total = 0.0
    for name, value in inputs(rules, turn).items():
        factor = 1.0 if name == "drive_reduction" else weight(species, turn.agent, name, step)
        total += coef(species, name) * factor * value
    return total


def coef(species: Species, name: str) -> float:
    settings = species.reward
    if name in ("action", "drive_reduction"):
        return getattr(settings, f"{name}_coef")
    for sense in ("see", "smell"):
        if name.startswith(f"{sense}_"):
            return getattr(settings, sense)[name.removeprefix(f"{sense}_")].coef
    return settings.meal_coef


def weight(species: Species, agent: Agent, name: str, step: int) -> float:
    """How a weight follows from its genes."""
    family, w = species.reward.family, species.gene(agent.genome, f"w_{name}")
    if family == "sinh":
        return math.sinh(2.5 * w)
    if family == "scaled":
        return 10 ** species.gene(agent.genome, f"w_{name}_scale") * w
    if family == "fed":
        return w * sigmoid(beyond(species, agent, agent.energy))
    if family == "hungry":
        return w * sigmoid(-beyond(species, agent, agent.energy))
    if family == "by_age":
        old = species.gene(agent.genome, f"w_{name}_old")
        return w + (old - w) * sigmoid(beyond(species, agent, step + 1 - agent.birth_step))
    return w


def beyond(species: Species, agent: Agent, value: float) -> float:
    """How far above the threshold of the family a value is, in units of its width."""
    threshold, width = (
        getattr(species.reward, name)
        * (10 ** species.gene(agent.genome, f"g_{name}") if name in species.genome.family else 1.0)
        for name in ("threshold", "threshold_width")
    )
    return (value - threshold) / width
