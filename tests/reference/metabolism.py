"""Motors, energy and the other stores."""

import math

from reference.chance import harmful
from reference.setting import Rules, Species
from reference.state import Agent, Turn, World


def sigmoid(x: float) -> float:
    return 1 / (1 + math.exp(-x)) if x > -700 else 0.0


def motor_forces(species: Species, action: tuple[float, float], agent: Agent) -> tuple[float, float]:
    """The forces of both motors, which stores may reduce."""
    if species.learning.policy == "idle":
        return 0.0, 0.0
    left = 1.0
    for name, store in species.stores.items():
        threshold = store.motor_threshold
        if threshold:
            left *= (1 - sigmoid(agent.held[name] - threshold)) / (1 - sigmoid(-threshold))
    low, high = species.min_force, species.max_force
    one, other = (left * (low + (high - low) * sigmoid(a)) for a in action)
    return one, other


def pay(rules: Rules, world: World, turn: Turn) -> None:
    """Applies meals and costs to energy and the other stores, and updates the ledger."""
    agent, species, sums = turn.agent, rules.of(turn.agent), world.sums[turn.agent.species]
    energy, force = species.energy, math.hypot(*turn.forces)
    meal = turn.meal[: len(rules.kinds)]
    gain = sum(each * n for each, n in zip(species.food_energy, meal, strict=True))
    action = energy.action_cost * force
    touched = sum(obstacle < harmful(rules, world.step) for obstacle in turn.deed.obstacles)
    damage = rules.obstacle.damage * touched
    basic = energy.basic_cost + energy.decay * agent.energy
    wanted = agent.energy + gain - action - basic - damage
    agent.energy = min(max(wanted, 0.0), energy.capacity)
    agent.energy_gained += gain
    agent.energy_spent += action + basic + damage
    turn.starved = wanted < 0 and energy.at_zero == "death"
    changes = {
        "agent_steps": 1,
        "energy_eaten": gain,
        "energy_action": action,
        "energy_basic": basic,
        "energy_forgiven": max(-wanted, 0.0),
        "energy_capped": max(wanted - energy.capacity, 0.0),
        "obstacles_touched": touched,
        "energy_damage": damage,
    }
    for name, change in changes.items():
        sums[name] += change
    for name, own in species.store.items():
        eaten = sum(food.gives.get(name, 0.0) * n for food, n in zip(rules.foods, meal, strict=True))
        left = agent.held[name] * (1 - own.decay) + eaten - own.action_cost * force - own.basic_cost
        agent.store[name] = min(max(left, 0.0), own.capacity)
        turn.starved |= left < 0 and own.at_zero == "death"
    agent.distance += math.hypot(turn.deed.x - turn.start.x, turn.deed.y - turn.start.y)
    agent.force_left += turn.forces[0]
    agent.force_right += turn.forces[1]
