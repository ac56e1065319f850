"""Contradictions in what makes a species, and between the species of a world."""

import math
import re
from collections.abc import Iterator, Sequence

from hedon.config.check_gene import law_problems
from hedon.config.check_schedule import schedule_problems
from hedon.config.config import Config
from hedon.config.evolution import FAMILY_GENES, LEARNING_GENES, GenomeConfig
from hedon.config.layout import (
    INNER_STATES,
    SOLID,
    chosen,
    inner_states,
    layout_of,
    rule_columns,
    set_point_of,
    smelled,
)
from hedon.config.problem import Problem, format_value, nearest, single
from hedon.config.room import MAX_FACTOR, MAX_FORCE, MAX_GENES, MAX_SMELLS, MAX_SPECIES, MAX_TOUCH_BITS
from hedon.config.rule_path import RULE_PATTERN
from hedon.config.species import EVERYTHING, RULE_USES, SpeciesConfig

THRESHOLDS = ("fed", "hungry", "by_age")
"""Families of rewards that have a threshold."""
MAX_COVERAGE = 0.45
"""Share of the arena that founders may cover; random placement without overlap stops at 0.547 (Feder 1980)."""


def species_problems(config: Config) -> Iterator[Problem]:
    """Yields what is wrong with a species, or with several together."""
    yield from _names(config)
    if not config.species:
        return
    for name, species in config.species.items():
        path = f"species.{name}."
        yield from _body(config, species, path)
        yield from _life(config, species, path)
        yield from _lists(config, species, path)
        yield from schedule_problems(species.hazard.schedule, f"{path}hazard.schedule", {"scale": MAX_FACTOR})
        unknown = [*_sight(config, species, path), *_settable(species, path)]
        yield from unknown
        if not unknown:  # else there is no layout
            yield from _genes(config, species, path)
            yield from _rule(config, name, path)
    yield from _nobody(config)
    yield from _crowd(config)
    yield from _collisions(config)


def _names(config: Config) -> Iterator[Problem]:
    if not 1 <= len(config.species) <= MAX_SPECIES:
        yield Problem("species", f"there must be from 1 to {MAX_SPECIES} species, not {len(config.species)}")
    for name in config.species:
        if not re.fullmatch(r"[a-z][a-z0-9_]{0,31}", name) or name in (*config.food, *SOLID, "action"):
            rule = "a name must have only a-z, 0-9 and _, start with a letter, have at most 32 characters"
            yield Problem(f"species.{name}", f"{rule} and be no kind of food and not {' or '.join((*SOLID, 'action'))}")


def _body(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    arena, motor = config.arena, species.motor
    forces = [single(motor.force_scale * force) for force in (motor.min_force, motor.max_force)]
    if forces[0] >= forces[1]:
        rule = f"must be below motor.max_force = {motor.max_force:g}"
        yield Problem(f"{path}motor.min_force", rule, format_value(motor.min_force))
    if max(map(abs, forces)) > MAX_FORCE:
        rule = f"makes forces of {max(map(abs, forces)):g}: at most {MAX_FORCE:g} is allowed"
        yield Problem(f"{path}motor.force_scale", rule, format_value(motor.force_scale))
    if 2 * single(max(species.body.radius, config.world.food_radius)) >= single(min(arena.width, arena.height)):
        yield Problem(f"{path}body.radius", "a body does not fit into the arena", format_value(species.body.radius))
    touched = len(chosen(config, species.body.collides))
    if touched * species.sensor.touch_sectors > MAX_TOUCH_BITS:
        most = MAX_TOUCH_BITS // touched
        rule = f"must be at most {most} with {touched} types to touch"
        yield Problem(f"{path}sensor.touch_sectors", rule, format_value(species.sensor.touch_sectors))


def _life(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    learning, birth, energy = species.learning, species.birth, species.energy
    count, capacity = species.population.initial_count, species.population.capacity
    if count > capacity:
        rule = f"must be at most population.capacity = {capacity}"
        yield Problem(f"{path}population.initial_count", rule, format_value(count))
    if birth.distance_unit == "arena_width" and birth.distance_sd > 1:
        rule = 'must be at most 1 with birth.distance_unit = "arena_width"'
        yield Problem(f"{path}birth.distance_sd", rule, format_value(birth.distance_sd))
    if config.world.inheritance == "at_window_end":
        for setting, plain in (("network", "none"), ("mating", "none")):
            if getattr(birth, setting) != plain:
                rule = f'must be "{plain}" with world.inheritance = "at_window_end"'
                yield Problem(f"{path}birth.{setting}", rule, format_value(getattr(birth, setting)))
    if learning.policy == "fixed" and birth.network != "initial":
        rule = 'must be "initial" with learning.policy = "fixed": a new network would never learn'
        yield Problem(f"{path}birth.network", rule, format_value(birth.network))
    if birth.network != "none" and learning.policy not in ("ppo", "fixed"):
        rule = f'learning.policy = "{learning.policy}": there is no network to inherit'
        yield Problem(f"{path}birth.network", rule, format_value(birth.network))
    if birth.mating == "pairs" and capacity < 2:
        rule = 'must be at least 2 with birth.mating = "pairs": nobody mates alone'
        yield Problem(f"{path}population.capacity", rule, format_value(capacity))
    if energy.initial > energy.capacity:
        rule = f"must be at most energy.capacity = {energy.capacity:g}"
        yield Problem(f"{path}energy.initial", rule, format_value(energy.initial))
    if config.world.rollout_steps % learning.minibatch_size:
        rule = f"must divide world.rollout_steps = {config.world.rollout_steps}"
        yield Problem(f"{path}learning.minibatch_size", rule, format_value(learning.minibatch_size))


def _lists(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    everything = [*config.species, *config.food]
    yield from _known(f"{path}sensor.sees", species.sensor.sees, everything)
    yield from _known(f"{path}sensor.smells", species.sensor.smells, everything)
    yield from _known(f"{path}body.collides", species.body.collides, everything)
    yield from _known(f"{path}diet.eats", [name for name, _ in species.diet.eats], [*config.food, *config.species])
    for name, share in species.diet.eats:
        if name in config.species and not 0 <= share <= 1:
            yield Problem(f"{path}diet.eats", f"the share of a {name} must be from 0 to 1", format_value(share))
        if name in everything and name not in chosen(config, species.body.collides):
            yield Problem(f"{path}diet.eats", f"it passes through {name}, so it cannot eat it: add it to body.collides")


def _rule(config: Config, name: str, path: str) -> Iterator[Problem]:
    species = config.species[name]
    for use in RULE_USES:
        place, rule = f"{path}{use}.rule", getattr(species, use).rule
        if rule and not re.fullmatch(RULE_PATTERN, rule):
            yield Problem(place, "must be FILE.py:NAME, a Python file and a function in it", format_value(rule))
        columns = rule_columns(config, name, use) if rule else ()
        for column in {each for each in columns if columns.count(each) > 1}:
            yield Problem(place, f"two things that it reads are called {column}: rename a food")
    if species.reward.memory and not species.reward.rule:
        yield Problem(
            f"{path}reward.memory", "is kept by a rule: give reward.rule too", format_value(species.reward.memory)
        )


def _sight(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    seen = chosen(config, species.sensor.sees)
    for name in species.reward.see:
        if name not in seen:
            rule = "it does not see this: it sees " + ", ".join(seen)
            yield Problem(f"{path}reward.see.{name}", rule, nearest=nearest(name, seen))
    smells = smelled(config, species.sensor.smells)
    for name in species.reward.smell:
        if name not in smells:
            rule = "it does not smell this: add it to sensor.smells" + (f" = {', '.join(smells)}" if smells else "")
            yield Problem(f"{path}reward.smell.{name}", rule, nearest=nearest(name, smells))
    if len(smells) * species.sensor.noses > MAX_SMELLS:
        rule = f"must name at most {MAX_SMELLS // species.sensor.noses} with sensor.noses = {species.sensor.noses}"
        yield Problem(f"{path}sensor.smells", rule, format_value(species.sensor.smells))
    for name, see in species.reward.see.items():
        if see.reads and see.reads not in seen:
            rule = "must be empty or one of " + ", ".join(seen)
            yield Problem(f"{path}reward.see.{name}.reads", rule, format_value(see.reads), nearest(see.reads, seen))


def _settable(species: SpeciesConfig, path: str) -> Iterator[Problem]:
    """Genes set what genes can set."""
    for table, known in (("learning", LEARNING_GENES), ("family", FAMILY_GENES)):
        for gene in getattr(species.genome, table):
            if gene not in known:
                rule = "no gene can set this: there are " + ", ".join(known)
                yield Problem(f"{path}genome.{table}.{gene}", rule, nearest=nearest(gene, tuple(known)))


def _genes(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    genome, learning = species.genome, species.learning
    if genome.family and species.reward.family not in THRESHOLDS:
        rule = f'reward.family = "{species.reward.family}" has no threshold: ' + ", ".join(THRESHOLDS) + " have one"
        yield Problem(f"{path}genome.family", rule)
    if genome.learning and learning.policy != "ppo":
        rule = f'learning.policy = "{learning.policy}": there is no learning that genes could set'
        yield Problem(f"{path}genome.learning", rule)
    if "gamma" in genome.learning and not 0 < learning.gamma < 1:
        rule = "must lie between 0 and 1 where a gene sets it"
        yield Problem(f"{path}learning.gamma", rule, format_value(learning.gamma))
    for value in ("learning_rate", "entropy_coef"):
        if value in genome.learning and getattr(learning, value) == 0:
            yield Problem(f"{path}learning.{value}", "a gene multiplies it, so it must not be 0", "0.0")
    names = layout_of(config, species).gene_names
    for state in set(INNER_STATES) - set(inner_states(config, species)):
        point = set_point_of(state)
        if getattr(genome, point) != getattr(GenomeConfig(), point):
            rule = f"nobody here has {state}: give a kind of food that it eats {state} above 0"
            yield Problem(f"{path}genome.{point}", rule)
    if len(names) > MAX_GENES:
        yield Problem(f"{path}genome", f"there must be at most {MAX_GENES} genes, not {len(names)}")
    for gene in {each for each in names if names.count(each) > 1}:
        yield Problem(f"{path}genome", f"two genes would have the name {gene}: rename a food or a species")
    for gene in genome.mutation:
        if gene not in names:
            rule = "there is no such gene: there are " + ", ".join(names)
            yield Problem(f"{path}genome.mutation.{gene}", rule, nearest=nearest(gene, names))
    yield from law_problems(config, species, path)


def _known(path: str, names: Sequence[str], known: Sequence[str]) -> Iterator[Problem]:
    for name in names:
        if name not in known and name != EVERYTHING:
            rule = "must be names of " + ", ".join(known) + f', or "{EVERYTHING}"'
            yield Problem(path, rule, format_value(name), nearest(name, known))


def _nobody(config: Config) -> Iterator[Problem]:
    if all(species.population.initial_count == 0 for species in config.species.values()):
        name = next(iter(config.species))
        yield Problem(f"species.{name}.population.initial_count", "there must be at least one founder", "0")


def _crowd(config: Config) -> Iterator[Problem]:
    """Founders of all species together must fit into the arena."""
    area, room = 0.0, MAX_COVERAGE * config.arena.width * config.arena.height
    for name, species in config.species.items():
        if 2 * species.body.radius >= min(config.arena.width, config.arena.height):
            return  # that is said already
        each = math.pi * species.body.radius**2
        free = room - area
        area += species.population.initial_count * each
        if area > room:
            most = math.floor(free / each)
            path = f"species.{name}.population.initial_count"
            rule = f"too many to place: the arena has room for {most}"
            yield Problem(path, rule, format_value(species.population.initial_count))


def _collisions(config: Config) -> Iterator[Problem]:
    """Two species pass through one another, or both collide."""
    for name, species in config.species.items():
        for other, theirs in config.species.items():
            if other in chosen(config, species.body.collides) and name not in chosen(config, theirs.body.collides):
                yield Problem(f"species.{other}.body.collides", f"must have {name}, since {name} collides with {other}")
