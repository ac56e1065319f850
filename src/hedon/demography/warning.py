"""Warnings about a condition before it is run, in sentences."""

import math
from collections.abc import Iterator, Mapping
from functools import partial

from hedon.config import Config
from hedon.config.schema.food import FoodConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.species import SpeciesConfig
from hedon.config.type import diet
from hedon.demography.balance import fed, feeding, gains, supply
from hedon.demography.level import EnergyLevel
from hedon.demography.life import energy_hazard, expected_lifetime, reproduction_number
from hedon.demography.schedule import birth_of, factor_at, factor_range, hazard_of, mean_factor, scaled_hazard

LONG_LIFE = 100_000
"""Mean life [step] beyond which births and deaths are too few for selection."""


def warnings(config: Config, species: str, levels: tuple[EnergyLevel, ...]) -> tuple[str, ...]:
    """Warnings that follow from the settings of a species, without samples."""
    species_config = config.species[species]
    starving, best = levels[0], max(levels, key=lambda level: level.r0)
    capacity, founders = species_config.population.capacity, species_config.population.initial_count
    floor = species_config.energy.at_zero == "floor"
    messages = [*_gene_warnings(species_config), *_rule_warnings(species_config)]
    if best.r0 < 1:
        messages.append(f"It cannot live: R0 is {best.r0:.2f} at best, so every lineage dies out however well it eats.")
    fed_by_others = any(
        store.birth_weight > 0 for store in species_config.store.values()
    )  # assumed full in this forecast
    if floor and starving.r0 >= 1 and math.isfinite(starving.lifetime) and not fed_by_others:
        messages.append(
            f"It can live without eating: R0 is {starving.r0:.2f} at energy 0, so an agent that never eats replaces "
            f"itself. It lives {starving.lifetime:,.0f} steps and pays nothing. The world can go on starving, its size "
            "set by room for newborns, and drift is strong."
        )
    if floor and math.isinf(starving.lifetime):
        messages.append(
            "It cannot die: at energy 0 the chance of death is 0, and it rises with neither hunger nor age."
        )
    elif math.isinf(best.lifetime):
        messages.append(f"It need not die: at energy {best.energy:g} the chance of death is 0 at any age.")
    initial_supply = supply(config, species_config, lambda food: float(factor_at(food.schedule, "growth_rate", 0)))
    initially_fed = fed(config, species_config, initial_supply)
    if initially_fed < founders:
        fate = "starve" if floor else "starve to death"
        messages.append(
            f"At first, the food that grows is enough for {initially_fed:,.0f} of {founders} founders; once the supply "
            f"is used up, the others {fate}."
        )
    fed_on_average = fed(
        config, species_config, supply(config, species_config, lambda food: mean_factor(food.schedule, "growth_rate"))
    )
    if fed_on_average > capacity and LONG_LIFE < best.lifetime < math.inf:
        fed_text = "any number of" if math.isinf(fed_on_average) else f"{fed_on_average:,.0f}"
        messages.append(
            f"It can fill up and stand still: food pays for {fed_text} agents, the capacity is {capacity}, and those "
            f"who eat well live {best.lifetime:,.0f} steps. Then hardly anybody is born or dies, and selection fades."
        )
    return (*messages, *_scheduled(config, species, best.energy), *_others(config, species), *_beyond(config, species))


def _scheduled(config: Config, species: str, energy: float) -> Iterator[str]:
    """Warnings about schedules: the factor behind the numbers, and the numbers at other factors."""
    species_config = config.species[species]
    low, high = factor_range(species_config.hazard.schedule, "scale")
    if low < high:
        ends = [scaled_hazard(hazard_of(species_config), factor) for factor in (low, high)]
        lifetimes = [_steps(float(expected_lifetime(end, energy))) for end in ends]
        r0 = [
            float(reproduction_number(end, birth_of(species_config), energy)) if species_config.birth.kappa else 0.0
            for end in ends
        ]
        which = _which(species_config.hazard.schedule, "scale")
        yield (
            f"The chance of death follows a schedule, from {low:g} to {high:g} times what is set: lives and R0 are "
            f"those at {which}. Held at its lowest, it would give {lifetimes[0]} and R0 {r0[0]:.2f} at energy "
            f"{energy:g}; at its highest {lifetimes[1]} and R0 {r0[1]:.2f}. What a life meets depends on when it "
            "begins."
        )
    foods = {kind: config.food[kind] for kind in feeding(config, species_config)}
    bounds = {kind: factor_range(food.schedule, "growth_rate") for kind, food in foods.items()}
    if any(low < high for low, high in bounds.values()):
        phrases = [
            f"{kind} from {low:g} to {high:g} times what is set (here {_which(foods[kind].schedule, 'growth_rate')})"
            for kind, (low, high) in bounds.items()
            if low < high
        ]
        ends = (supply(config, species_config, partial(_extreme, index=which)) for which in (0, 1))
        least, most = (fed(config, species_config, supplied) for supplied in ends)
        yield f"Growth follows a schedule, {', '.join(phrases)}: food pays for {least:,.0f} to {most:,.0f} agents."
    for kind, food in foods.items():
        low, high = factor_range(food.schedule, "capacity")
        if low < high:
            yield (
                f"The capacity of {kind} follows a schedule, from {low:g} to {high:g} times what is set: how much "
                "of what grows it cuts off depends on what is eaten, and is not forecast."
            )


def _extreme(food: FoodConfig, index: int) -> float:
    """Smallest (0) or largest (1) factor of a kind's growth."""
    return factor_range(food.schedule, "growth_rate")[index]


def _which(schedules: Mapping[str, ScheduleConfig], name: str) -> str:
    """Names the factor of a schedule behind the numbers."""
    mean = mean_factor(schedules, name)
    return f"the mean over a period, {mean:g}" if schedules[name].period else f"its end, {mean:g}, which stays"


def _steps(lifetime: float) -> str:
    return "an endless life" if math.isinf(lifetime) else f"a mean life of {lifetime:,.0f} steps"


def _others(config: Config, species: str) -> Iterator[str]:
    """Relations of a species to agents that it eats, that eat it, or that share its food."""
    eaten = diet(config, config.species[species])
    prey = [each for each in config.species if each in eaten]
    if prey:
        food_text = "" if gains(config, config.species[species]) else "no food, but "
        prey_text = f"{food_text}{' and '.join(prey)}"
        yield f"It eats {prey_text}: how many it catches depends on what agents learn, and is not forecast."
    elif not gains(config, config.species[species]):
        yield "It eats nothing: nobody gains energy."
    eaters = [other for other, each in config.species.items() if species in diet(config, each)]
    if eaters:
        yield f"It is eaten by {' and '.join(eaters)}: lives here are without such deaths."
    competitors = [
        other
        for other, each in config.species.items()
        if other != species and set(feeding(config, config.species[species])) & set(diet(config, each))
    ]
    if competitors:
        yield f"Its food is also eaten by {' and '.join(competitors)}: what it pays for is shared with them."
    if len(config.species) > 1:
        yield "Places that agents of other species take are not counted: there is less room than this."


def _beyond(config: Config, species: str) -> Iterator[str]:
    """What affects births and deaths but is missing from this forecast."""
    species_config = config.species[species]
    if config.obstacle.count and config.obstacle.damage:
        yield (
            f"Obstacles cost {config.obstacle.damage:g} energy per step of touch: how often they are touched depends "
            "on what agents learn, and is not forecast."
        )
    for name, store in species_config.store.items():
        weight = store.hazard_weight if species_config.hazard.form == "age_energy" else 0.0
        increase = (
            weight
            * float(energy_hazard(species_config.hazard, 0.0))
            * mean_factor(species_config.hazard.schedule, "scale")
        )
        if increase:
            yield f"Without {name} the chance of death is {increase:.3g} per step higher; lives here are with enough."
        if store.birth_weight:
            state = f"full of {name}" if store.birth_weight > 0 else f"without {name}"
            yield f"Births follow {name} too: R0 here is that of agents {state}."
        if store.at_zero == "death":
            yield f"Without {name} agents die at once: how often that happens is not forecast."
    gated = [kind for kind in diet(config, species_config) if kind in config.food and config.food[kind].needs]
    if gated:
        yield f"Only agents that hold enough can eat {' and '.join(gated)}: the numbers here are as if all could."
    if species_config.birth.mating == "pairs":
        yield (
            "Children need two parents that wait near one another: R0 counts draws, of which two make one child, and "
            "the chance to meet is not forecast."
        )
    for name, store in species_config.stores.items():
        if store.motor_threshold:
            yield f"{name.capitalize()} weakens motors, so agents that hold it spend less; this is not forecast."


def _gene_warnings(species: SpeciesConfig) -> Iterator[str]:
    if species.genome.set:
        yield (
            f"Genes set {', '.join(species.genome.set)}: the numbers here are those of founders with mean genes; "
            "others differ, and evolution moves them."
        )


def _rule_warnings(species: SpeciesConfig) -> Iterator[str]:
    for event, rule in (("death", species.hazard.rule), ("birth", species.birth.rule)):
        if rule:
            yield (
                f"The chance of {event} comes from a rule, {rule}: what it answers is not known before a run. The "
                "numbers here are those of the formula that it replaces."
            )
