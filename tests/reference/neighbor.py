"""What is near an agent: the results of its queries."""

import math
from typing import Any

from reference.setting import Rules
from reference.state import Agent, Turn, World


def neighbors(rules: Rules, world: World, agent: Agent, query: Any) -> dict[str, float]:
    """What a query finds around an agent: living agents, then foods, including those just eaten if they are seen."""
    names = {*query.of, *(rules.names if "*" in query.of else ())}
    others = [each for each in world.agents if each.agent_id != agent.agent_id and rules.names[each.species] in names]
    found = [(math.dist((each.x, each.y), (agent.x, agent.y)), each.agent_id, each.x, each.y) for each in others]
    foods = [
        place for kind, stock in zip(rules.kinds, world.stocks, strict=True) if kind in names for place in stock.foods
    ]
    foods += [(x, y) for x, y, kind in world.eaten_foods if rules.kinds[kind] in names]
    found += [(math.dist(place, (agent.x, agent.y)), math.inf, *place) for place in foods]
    near = sorted(each for each in found if each[0] <= query.range)
    ids = {number for _, number, *_ in near}
    kin = sum(are_kin(agent, other) for other in others if other.agent_id in ids)
    told: dict[str, float] = {"count": len(near), "kin": kin}
    if not near:
        return told | {"distance": query.range, "bearing": 0.0}
    distance, _, x, y = near[0]
    toward = math.atan2(y - agent.y, x - agent.x) - (agent.angle + math.pi / 2)
    return told | {"distance": distance, "bearing": math.remainder(toward, 2 * math.pi)}


def meals_near(rules: Rules, turn: Turn, query: Any) -> float:
    """The number of meals in this step of the agents that are near at its end."""
    here, names = (turn.agent.x, turn.agent.y), {*query.of, *(rules.names if "*" in query.of else ())}
    others = (each for each in turn.company if each is not turn and rules.names[each.agent.species] in names)
    return float(sum(sum(each.meal) for each in others if math.dist((each.agent.x, each.agent.y), here) <= query.range))


def are_kin(agent: Agent, other: Agent) -> bool:
    """Whether one is a parent of the other, or both have a parent in common."""
    mine, its = ({each.parent_id, each.mate_id} - {-1} for each in (agent, other))
    return bool(mine & its) or agent.agent_id in its or other.agent_id in mine
