"""Rules in Python: the same functions, called directly with what they receive about an agent."""

import math
import runpy
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
from reference.chance import birth_chance, death_chance
from reference.neighbor import meals_near, neighbors
from reference.reward import inputs, reward
from reference.setting import Rules, Species
from reference.state import Turn, World


def function_of(place: str) -> Callable[[Any], float] | None:
    """The function that a setting names as FILE.py:NAME."""
    if not place:
        return None
    file, name = place.rsplit(":", 1)
    return runpy.run_path(file)[name]


class RuleBook:
    """The rules of a world's species. A species without one is paid, dies and breeds as its settings say."""

    def __init__(self, rules: Rules) -> None:
        self.rules = rules
        self.found = [
            {use: function_of(getattr(species, use).rule) for use in ("reward", "hazard", "birth")}
            for species in rules.species
        ]

    def reward(self, world: World, turn: Turn) -> float:
        """What an agent is paid; its rule may change its memory."""
        plain, function = reward(self.rules, world, turn), self.found[turn.agent.species]["reward"]
        if function is None:
            return plain
        record = self.record(world, turn, linear=plain)
        paid = float(function(record))
        turn.agent.memory = [getattr(record, f"memory_{m + 1}") for m in range(len(turn.agent.memory))]
        return paid

    def death_chance(self, world: World, turn: Turn) -> float:
        plain = death_chance(self.rules.of(turn.agent), turn.agent, world.step)
        return self._chance("hazard", world, turn, plain)

    def birth_chance(self, world: World, turn: Turn) -> float:
        return self._chance("birth", world, turn, birth_chance(self.rules.of(turn.agent), turn.agent))

    def _chance(self, use: str, world: World, turn: Turn, plain: float) -> float:
        function = self.found[turn.agent.species][use]
        return plain if function is None else float(function(self.record(world, turn, chance=plain)))

    def record(self, world: World, turn: Turn, **answer: float) -> SimpleNamespace:
        """What a rule receives: the table in docs/guide/rule.md."""
        agent, start, species = turn.agent, turn.start, self.rules.of(turn.agent)
        told = (
            inputs(self.rules, world, turn) | dict(zip(species.genes, map(float, agent.genome), strict=True)) | answer
        )
        told |= {"age": world.step + 1 - agent.birth_step, "step": world.step, "x": agent.x, "y": agent.y}
        told |= agent.held | {f"{name}_before": held for name, held in start.held.items()}
        told["moved"] = math.hypot(agent.x - start.x, agent.y - start.y)
        told["nearness"] = float(np.maximum(turn.deed.seen, 0).sum(axis=1).mean())
        told["force_left"], told["force_right"] = turn.forces
        for name, query in species.neighbor.items():
            found = neighbors(self.rules, turn.before, start, query) | {"meals": meals_near(self.rules, turn, query)}
            told |= {f"{name}_{what}": number for what, number in found.items()}
        told["alive"] = sum(each.species == agent.species for each in world.agents)
        return SimpleNamespace(**told, **{f"memory_{m + 1}": value for m, value in enumerate(agent.memory)})


def memory_of(species: Species) -> list[float]:
    return [0.0] * species.reward.memory
