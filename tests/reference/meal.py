"""Which agents eat which foods and which other agents."""

import math

from reference.setting import Rules
from reference.state import Turn, World


def eat(rules: Rules, world: World, turns: list[Turn]) -> None:
    """Gives each food to the nearest of the agents whose mouths it met, or to all of them."""
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
    """Counts a meal: a food of a kind or, with an index after the kinds, an agent of a species."""
    turn.meal[meal] += 1
    turn.agent.eaten[meal] += 1
    world.meals[turn.agent.species][meal] += 1


def hunt(rules: Rules, world: World, turns: list[Turn]) -> None:
    """Settles what mouths claim: the nearest agent that they may eat, or all, unless their owner is digesting."""
    by_id = {turn.agent.agent_id: turn for turn in turns}
    claims: list[tuple[int, int]] = []
    for turn in turns:
        near = sorted(turn.deed.prey, key=lambda prey: distance(turn, by_id[prey]))
        wanted = sorted(near) if rules.eats_all_prey else near[:1]
        if turn.agent.digestion == 0 and not turn.starved:
            claims += [(turn.agent.agent_id, prey) for prey in wanted if not by_id[prey].starved]
        turn.agent.digestion = max(turn.agent.digestion - 1, 0)

    def energy(prey: int) -> float:
        turn = by_id[prey]
        return turn.start.energy if rules.prey_before_step else turn.agent.energy

    if rules.each_gains:  # all claims are settled at once, with the energies before anyone eats
        had = {prey: energy(prey) for _, prey in claims}
        for eater, prey in claims:
            gain(rules, world, by_id[eater], by_id[prey], had[prey])
            by_id[prey].caught = True
        return
    while claims:
        claimed = {prey for _, prey in claims}
        free = [each for each in claims if each[0] not in claimed]
        eater, prey = min(free or claims, key=lambda each: (rules.draw("hunt", each[0], world.step)[0], each))
        gain(rules, world, by_id[eater], by_id[prey], energy(prey))
        by_id[prey].caught = True
        # An agent that is eaten eats nothing; in a cycle, one that has eaten can no longer be eaten.
        claims = [each for each in claims if each[1] not in (prey, eater) and each[0] != prey]


def distance(turn: Turn, other: Turn) -> float:
    return 0.0 if other.deed.gone else math.hypot(turn.deed.x - other.deed.x, turn.deed.y - other.deed.y)


def gain(rules: Rules, world: World, turn: Turn, prey: Turn, energy: float) -> None:
    """Gives an eater its share of the energy of its prey."""
    species, eater, sums = rules.of(turn.agent), turn.agent, world.sums[turn.agent.species]
    gained = species.eats[rules.names[prey.agent.species]] * energy
    wanted = eater.energy + gained
    eater.energy = min(wanted, species.energy.capacity)
    eater.energy_gained += gained
    eater.digestion = species.diet.digestion_steps
    sums["energy_hunted"] += gained
    sums["energy_capped"] += wanted - eater.energy
    take(world, turn, len(rules.kinds) + prey.agent.species)
