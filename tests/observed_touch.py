"""What the physics says was touched in a step, against where everything lay."""

import math
from typing import Any

import numpy as np
from reference.chance import harmful
from reference.place import encloses, sides, wall_distance
from reference.setting import Rules
from reference.state import Deed, World

from hedon.experiment.simulation import Simulation

MARGIN = 1e-3
"""Nearer than this to an edge [u], or to the cosine of the end of a mouth, either answer is right."""


def touch_bits(world: Any, slots: list[int]) -> list[int]:
    """Bit channel · sectors + sector of what each agent felt in the last step."""
    more = world.view("touch_more")
    high = more[slots].tolist() if len(more) else [0] * len(slots)
    return [low + (up << 64) for low, up in zip(world.view("touch")[slots].tolist(), high, strict=True)]


def assert_touches(
    simulation: Simulation, rules: Rules, before: World, slots: list[int], deeds: list[Deed]
) -> dict[str, int]:
    """What lay in a mouth as the step began was met, and what was met lay near; so with agents and obstacles. A food is
    met only where its kind is felt, and the reverse, where the mouth is made of whole sectors. Returns what was met."""
    met = {"mouthfuls": 0, "prey_met": 0, "harmed": 0, "harmless": 0}
    world, harm, physics = simulation.worlds[0], harmful(rules, before.step), simulation.config.physics
    # Furthest that a body moves in a step at the speed cap [u].
    moves = math.sqrt(2) * physics.max_speed * physics.dt * physics.substeps
    ids, bits = world.view("life.agent_id")[slots].tolist(), touch_bits(world, slots)
    others = [(a.x, a.y, rules.of(a).body.radius) for a in before.agents]
    for i, (agent, deed) in enumerate(zip(before.agents, deeds, strict=True)):
        species = rules.of(agent)
        for k, (kind, stock) in enumerate(zip(rules.kinds, before.stocks, strict=True)):
            eaten = {f for kind_met, f in deed.mouthfuls if kind_met == k}
            if kind not in species.eats or kind not in species.touches:
                assert not eaten
                continue
            inside, close = _within(species, agent, [(x, y, rules.food_radius) for x, y in stock.foods], moves)
            assert inside <= eaten <= close
            sectors = _mouth_sectors(species)
            # A newborn may lie where an agent died in this step; what that one touched is not known any more.
            if sectors and ids[i] == agent.agent_id:
                felt = bits[i] >> species.touches.index(kind) * species.sensor.touch_sectors
                assert any(felt >> sector & 1 for sector in sectors) == bool(eaten)
        inside, close = (
            {
                before.agents[j].agent_id
                for j in found
                if j != i and rules.names[before.agents[j].species] in species.eats
            }
            for found in _within(species, agent, others, 2 * moves)
        )
        assert inside <= set(deed.prey) <= close
        for o, polygon in enumerate(rules.arena.obstacles):
            apart = min(wall_distance(agent.x, agent.y, (*a, *b)) for a, b in sides(polygon))
            touches = apart < species.body.radius - MARGIN or encloses(polygon, agent.x, agent.y)
            assert touches <= (o in deed.obstacles) <= (apart < species.body.radius + moves)
        met["mouthfuls"] += len(deed.mouthfuls)
        met["prey_met"] += len(deed.prey)
        met["harmed"] += sum(o < harm for o in deed.obstacles)
        met["harmless"] += sum(o >= harm for o in deed.obstacles)
    return met


def _within(species: Any, agent: Any, circles: list, moves: float) -> tuple[set[int], set[int]]:
    """Which circles lay in the mouth, and which so near that they could come into it."""
    x, y, radius = np.reshape(circles, (-1, 3)).T
    dx, dy, reach = x - agent.x, y - agent.y, radius + species.body.radius
    apart = np.hypot(dx, dy)
    end = math.cos(math.radians(species.sensor.mouth_spread)) + MARGIN
    ahead = dy * math.cos(agent.angle) - dx * math.sin(agent.angle) > end * apart
    inside, close = (apart < reach - MARGIN) & ahead, apart < reach + moves
    return set(np.flatnonzero(inside).tolist()), set(np.flatnonzero(close).tolist())


def _mouth_sectors(species: Any) -> list[int]:
    """The sectors that make up the mouth; none where it ends within one."""
    count = species.sensor.touch_sectors
    half = species.sensor.mouth_spread * count / 360
    if abs(half - round(half)) > 1e-6:
        return []
    return [*range(round(half)), *range(count - round(half), count)]
