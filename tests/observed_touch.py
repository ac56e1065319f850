"""Compares the touches reported by the physics in a step with the positions of everything."""

import math
from typing import Any

import numpy as np
from reference.chance import harmful
from reference.place import encloses, sides, wall_distance
from reference.setting import Rules
from reference.state import Deed, World

from hedon.experiment.simulation import Simulation

MARGIN = 1e-3
"""Within this distance of an edge [u], or of the cosine of a mouth's end, either answer is right."""


def touch_bits(world: Any, slots: list[int]) -> list[int]:
    """What each agent felt in the last step; bit channel · sectors + sector is set for a touch."""
    more = world.view("touch_more")
    high = more[slots].tolist() if len(more) else [0] * len(slots)
    return [low + (up << 64) for low, up in zip(world.view("touch")[slots].tolist(), high, strict=True)]


def assert_touches(
    simulation: Simulation, rules: Rules, before: World, slots: list[int], deeds: list[Deed]
) -> dict[str, int]:
    """Asserts that foods inside a mouth at the start of the step were met, and that foods met were near; likewise for
    agents and obstacles. If the mouth consists of whole sectors, a kind of food was met if and only if it was felt
    there. Returns the numbers of encounters."""
    met = {"mouthfuls": 0, "prey_met": 0, "harmed": 0, "harmless": 0}
    world, harm, physics = simulation.worlds[0], harmful(rules, before.step), simulation.config.physics
    # Farthest that a body can move in a step at the speed cap [u].
    moves = math.sqrt(2) * physics.max_speed * physics.dt * physics.substeps
    ids, bits = world.view("life.agent_id")[slots].tolist(), touch_bits(world, slots)
    foods = [[(x, y, rules.food_radius) for x, y in stock.foods] for stock in before.stocks]
    near_foods = [_near(rules, before, circles, moves) for circles in foods]
    near_agents = _near(rules, before, [(a.x, a.y, rules.of(a).body.radius) for a in before.agents], 2 * moves)
    for i, (agent, deed) in enumerate(zip(before.agents, deeds, strict=True)):
        species = rules.of(agent)
        for k, kind in enumerate(rules.kinds):
            eaten = {f for kind_met, f in deed.mouthfuls if kind_met == k}
            if kind not in species.eats or kind not in species.touches:
                assert not eaten
                continue
            inside, close = near_foods[k][i]
            assert inside <= eaten <= close
            sectors = _mouth_sectors(species)
            # A newborn may occupy the slot of an agent that died in this step, whose touches are then lost.
            if sectors and ids[i] == agent.agent_id:
                felt = bits[i] >> species.touches.index(kind) * species.sensor.touch_sectors
                assert any(felt >> sector & 1 for sector in sectors) == bool(eaten)
        prey = {j for j, other in enumerate(before.agents) if rules.names[other.species] in species.eats} - {i}
        met_here = {j for j in prey if before.agents[j].agent_id in deed.prey}
        assert len(met_here) == len(deed.prey)
        assert near_agents[i][0] & prey <= met_here <= near_agents[i][1]
        for o, polygon in enumerate(rules.arena.obstacles):
            apart = min(wall_distance(agent.x, agent.y, (*a, *b)) for a, b in sides(polygon))
            touches = apart < species.body.radius - MARGIN or encloses(polygon, agent.x, agent.y)
            assert touches <= (o in deed.obstacles) <= (apart < species.body.radius + moves)
        met["mouthfuls"] += len(deed.mouthfuls)
        met["prey_met"] += len(deed.prey)
        met["harmed"] += sum(o < harm for o in deed.obstacles)
        met["harmless"] += sum(o >= harm for o in deed.obstacles)
    return met


def _near(rules: Rules, world: World, circles: list, moves: float) -> list[tuple[set[int], set[int]]]:
    """For each agent, the circles inside its mouth, and those near enough to get there."""
    x, y, radius = np.reshape(circles, (-1, 3)).T
    sensors = [rules.of(agent).sensor for agent in world.agents]
    mouths = [
        (a.angle + math.radians(s.mouth_center), s.mouth_spread) for a, s in zip(world.agents, sensors, strict=True)
    ]
    bodies = [(a.x, a.y, rules.of(a).body.radius, *mouth) for a, mouth in zip(world.agents, mouths, strict=True)]
    at_x, at_y, own, angle, spread = np.reshape(bodies, (-1, 5, 1)).swapaxes(0, 1)
    dx, dy, reach = x - at_x, y - at_y, radius + own
    apart = np.hypot(dx, dy)
    ahead = dy * np.cos(angle) - dx * np.sin(angle) > (np.cos(np.radians(spread)) + MARGIN) * apart
    inside, close = (apart < reach - MARGIN) & ahead, apart < reach + moves
    return [
        (set(np.flatnonzero(here).tolist()), set(np.flatnonzero(there).tolist()))
        for here, there in zip(inside, close, strict=True)
    ]


def _mouth_sectors(species: Any) -> list[int]:
    """The sectors that make up the mouth; empty if it ends inside a sector."""
    count = species.sensor.touch_sectors
    spread, center = species.sensor.mouth_spread, species.sensor.mouth_center
    first, last = ((center + side * spread) * count / 360 for side in (-1, 1))
    if max(abs(first - round(first)), abs(last - round(last))) > 1e-6:
        return []
    return [sector % count for sector in range(round(first), round(last))]
