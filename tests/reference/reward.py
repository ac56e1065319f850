"""The inherited reward of a step."""

import math

from reference.channel import channel
from reference.metabolism import sigmoid
from reference.setting import Rules, Species
from reference.state import Turn, World


def inputs(rules: Rules, world: World, turn: Turn) -> dict[str, float]:
    """The rewarded quantities, by the names of the terms."""
    species, settings = rules.of(turn.agent), rules.of(turn.agent).reward
    paid = {name: f"eaten_{name}" for name in (*rules.kinds, *rules.names) if name in species.eats}
    paid["action"] = "effort" if settings.action_norm == "max_force" else "force"
    paid |= {name: pay.channel or name for name, pay in settings.pay.items()}
    if settings.drive_reduction_coef:
        paid["drive_reduction"] = "drive_reduction"
    return {name: channel(rules, world, turn, of) for name, of in paid.items()}


def reward(rules: Rules, world: World, turn: Turn) -> float:
    species = rules.of(turn.agent)
    total = 0.0
    for name, value in inputs(rules, world, turn).items():
        factor = 1.0 if name == "drive_reduction" else weight(rules, world, turn, name)
        total += coef(species, name) * factor * value
    return total


def coef(species: Species, name: str) -> float:
    settings = species.reward
    if name in ("action", "drive_reduction"):
        return getattr(settings, f"{name}_coef")
    if name in settings.pay:
        return settings.pay[name].coef
    return settings.meal_coef


def weight(rules: Rules, world: World, turn: Turn, name: str) -> float:
    """The weight that follows from its genes."""
    species, genome = rules.of(turn.agent), turn.agent.genome
    family, w = species.reward.family, species.gene(genome, f"w_{name}")
    if family == "sinh":
        return math.sinh(2.5 * w)
    if family == "scaled":
        return 10 ** species.gene(genome, f"w_{name}_scale") * w
    if family == "linear":
        return w
    above = sigmoid(beyond(rules, world, turn))
    if family == "between":
        second = species.gene(genome, f"w_{name}_{'old' if species.reward.gate == 'age' else 'above'}")
        return w + (second - w) * above
    if family == "around":
        return 4 * w * above * (1 - above)
    return w * (above if family == "above" else 1 - above)


def beyond(rules: Rules, world: World, turn: Turn) -> float:
    """How far the gate is above the threshold, in units of the threshold's width."""
    species, gate = rules.of(turn.agent), channel(rules, world, turn, rules.of(turn.agent).reward.gate)
    threshold, width = (
        getattr(species.reward, name)
        * (10 ** species.gene(turn.agent.genome, f"g_{name}") if name in species.genome.family else 1.0)
        for name in ("threshold", "threshold_width")
    )
    return (gate - threshold) / width
