"""Who eats what, and whom."""

import math

from reference.setting import Rules
from reference.state import Turn, World


def eat(rules: Rules, world: World, turns: list[Turn]) -> None:
    """Each food goes to the nearest of those whose mouths it met, or to all."""
    world.eaten_foods = []
    for k, stock in enumerate(world.stocks):
        left, fed = [], 0
        for f, (x, y) in enumerate(stock.foods):
            rivals = [turn for turn in turns if (k, f) in turn.deed.mouthfuls and can_digest(rules, turn, k)]
            if not rules.all_mouths:
                rivals = sorted(rivals, key=lambda turn: math.hypot(turn.deed.x - x, turn.deed.y - y))[:1]
            for turn in rivals:
                take(world, turn, k)
            fed += len(rivals)
            if not rivals:
                left.append((x, y))
            elif rules.eaten_foods_seen:
                world.eaten_foods.append((x, y, k))
        placement = rules.foods[k].placement
        if placement.form == "switching":
            turned = (stock.eaten + fed) // placement.switch_after - stock.eaten // placement.switch_after
            stock.center = (stock.center + turned) % len(placement.centers)
        stock.number -= len(stock.foods) - len(left)
        stock.eaten += fed
        stock.foods = left


def can_digest(rules: Rules, turn: Turn, k: int) -> bool:
    """Whether an agent holds, at the start of the step, what a kind of food needs."""
    return all(turn.start.held.get(name, 0.0) >= need for name, need in rules.foods[k].needs.items())


def take(world: World, turn: Turn, meal: int) -> None:
    """One food of a kind, or, past the kinds, one agent of a species."""
    turn.meal[meal] += 1
    turn.agent.eaten[meal] += 1
    world.meals[turn.agent.species][meal] += 1


def hunt(rules: Rules, world: World, turns: list[Turn]) -> None:
    """Each mouth claims the nearest agent that it may eat, unless its owner digests; the claims are settled in turn."""
    by_id = {turn.agent.agent_id: turn for turn in turns}
    claims: dict[int, int] = {}
    for turn in turns:
        near = sorted(turn.deed.prey, key=lambda prey: distance(turn, by_id[prey]))
        if near and turn.agent.digestion == 0 and not turn.starved and not by_id[near[0]].starved:
            claims[turn.agent.agent_id] = near[0]
        turn.agent.digestion = max(turn.agent.digestion - 1, 0)
    if rules.each_gains:  # all are judged at once, by what they have before anyone eats
        energy = {each: by_id[each].agent.energy for each in claims.values()}
        for eater, prey in claims.items():
            gain(rules, world, by_id[eater], by_id[prey], energy[prey])
            by_id[prey].caught = True
        return
    while claims:
        free = [eater for eater in claims if eater not in claims.values()]
        eater = min(free or claims, key=lambda each: rules.draw("hunt", each, world.step)[0])
        prey = claims[eater]
        gain(rules, world, by_id[eater], by_id[prey], by_id[prey].agent.energy)
        by_id[prey].caught = True
        # Who is eaten eats nothing: in a cycle, who has eaten cannot be eaten any more.
        claims = {each: of for each, of in claims.items() if of not in (prey, eater) and each not in (prey, eater)}


def distance(turn: Turn, other: Turn) -> float:
    return 0.0 if other.deed.gone else math.hypot(turn.deed.x - other.deed.x, turn.deed.y - other.deed.y)


def gain(rules: Rules, world: World, turn: Turn, prey: Turn, energy: float) -> None:
    """An eater's share of the energy that its prey has."""
    species, eater, sums = rules.of(turn.agent), turn.agent, world.sums[turn.agent.species]
    gained = species.eats[rules.names[prey.agent.species]] * energy
    wanted = eater.energy + gained
    eater.energy = min(wanted, species.energy.capacity)
    eater.energy_gained += gained
    eater.digestion = species.diet.digestion_steps
    sums["energy_hunted"] += gained
    sums["energy_capped"] += wanted - eater.energy
    take(world, turn, len(rules.kinds) + prey.agent.species)
