"""Contradictions within a species and between the species of a world."""

import math
import re
from collections.abc import Sequence

from hedon.config.channel import QUERIED, SOURCES, called, known_channels, plain_channels
from hedon.config.expression import DRIVE, NO_GENE, expressed, settable
from hedon.config.field import leaves, value_at
from hedon.config.layout import Gene, layout_of, rule_columns, store_columns
from hedon.config.problem import Check, nearest, single
from hedon.config.room import MAX_FORCE, MAX_GENES, MAX_OBSERVED, MAX_QUERIES, MAX_SPECIES, MAX_STORES, MAX_TOUCH_BITS
from hedon.config.rule_path import RULE_PATTERN
from hedon.config.schema.evolution import GATED
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import EVERYTHING, RULE_USES, SpeciesConfig
from hedon.config.schema.store import ENERGY
from hedon.config.type import SOLID, asked_for, chosen, diet, smelled
from hedon.text import brief

RESERVED_STORES = (
    *("energy", "age", "reward", "children", "generation", "distance", "eaten", "genome", "cause", "species", "step"),
    *("x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity", "heading", "heading_sine", "heading_cosine"),
    *("force_left", "force_right", "agent_id", "parent_id", "mate_id", "birth_step", "death_step", "birth_energy"),
    *("energy_gained", "energy_spent", "mean_force_left", "mean_force_right", "reward_sum"),
    *("world", "seed", "kind", "id"),
    *(source.name for source in SOURCES.values() if "{}" not in source.name),
)
"""Names of an agent's other numbers, which no store may take."""
NAME = r"[a-z][a-z0-9_]{0,31}"
"""Pattern of the names of food kinds, species, stores, queries, and genes for rules."""
NAME_RULE = "a name must have only a-z, 0-9 and _, start with a letter, have at most 32 characters"
RESERVED_STARTS = ("eaten_", "w_", "g_", "neutral_", "extra_", "set_point")
"""Prefixes of the columns of meals and genes in the records."""
CHANNEL_SETTINGS = {
    "near_": "[neighbor.NAME] asks who is near, and gives NAME_count",
    "season_": "sensor.season_period gives a year where no schedule does",
    "see_": "sensor.sees says what it sees",
    "smell_": "sensor.smells says what it smells",
}
"""Settings that some channels require, by the prefix of the channel's name."""
MAX_COVERAGE = 0.45
"""Largest share of the arena that founders may cover; random placement without overlap stops at 0.547 (Feder 1980)."""


def check_species(check: Check) -> None:
    """Adds the problems of each species, and those between species."""
    config: Settings = check.config
    _names(check, config)
    for name, species in config.species.items():
        path = f"species.{name}."
        _body(check, config, species, path)
        _life(check, config, species, path)
        _lists(check, config, species, path)
        _stores(check, config, species, path)
        _read(check, config, species, path)
        problem_count = len(check.problems)
        _channels(check, config, species, path)
        # Otherwise the layout is undefined.
        if len(check.problems) == problem_count and not check.has(f"{path}genome."):
            _genes(check, config, species, path)
            _rules(check, config, name, path)
    if config.species:
        _crowd(check, config)
        _collisions(check, config)


def _names(check: Check, config: Settings) -> None:
    if not 1 <= len(config.species) <= MAX_SPECIES:
        check.add("species", f"there must be from 1 to {MAX_SPECIES} species, not {len(config.species)}")
    for name in config.species:
        if not re.fullmatch(NAME, name) or name in (*config.food, *SOLID, "action"):
            rule = f"{NAME_RULE} and be no kind of food and not {' or '.join((*SOLID, 'action'))}"
            check.add(f"species.{name}", rule)


def _body(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    motor, side = species.motor, min(config.arena.width, config.arena.height)
    low, high = (single(motor.force_scale * force) for force in (motor.min_force, motor.max_force))
    max_force = max(abs(low), abs(high))
    check.need(low < high, f"{path}motor.min_force", f"must be below motor.max_force = {motor.max_force:g}")
    rule = f"makes forces of {max_force:g}: at most {MAX_FORCE:g} is allowed"
    check.need(max_force <= MAX_FORCE, f"{path}motor.force_scale", rule)
    fits = 2 * single(max(species.body.radius, config.world.food_radius)) < single(side)
    check.need(fits, f"{path}body.radius", "a body does not fit into the arena")
    rule = f"a body of radius {species.body.radius:g} moves {_stride(config):.3g} u in a substep and may pass a wall: "
    rule += "lower physics.max_speed or physics.dt"
    check.need(species.body.radius > _stride(config), f"{path}body.radius", rule)
    touched_count = len(chosen(config, species.body.collides))
    rule = f"must be at most {MAX_TOUCH_BITS // touched_count} with {touched_count} types to touch"
    check.need(touched_count * species.sensor.touch_sectors <= MAX_TOUCH_BITS, f"{path}sensor.touch_sectors", rule)


def _stride(config: Settings) -> float:
    """Longest distance that a body moves in a substep [u]; the speed cap applies to each axis."""
    return math.sqrt(2) * config.physics.max_speed * config.physics.dt


def _life(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    learning, birth, population = species.learning, species.birth, species.population
    rule = f"must be at most population.capacity = {population.capacity}"
    check.need(population.initial_count <= population.capacity, f"{path}population.initial_count", rule)
    is_far = birth.distance_unit == "arena_width" and birth.distance_sd > 1
    check.need(not is_far, f"{path}birth.distance_sd", 'must be at most 1 with birth.distance_unit = "arena_width"')
    inherits_late = config.world.inheritance == "at_window_end"
    for setting in ("network", "mating"):
        rule = 'must be "none" with world.inheritance = "at_window_end"'
        check.need(not inherits_late or getattr(birth, setting) == "none", f"{path}birth.{setting}", rule)
    rule = 'must be "initial" with learning.policy = "fixed": a new network would never learn'
    check.need(learning.policy != "fixed" or birth.network == "initial", f"{path}birth.network", rule)
    rule = f'learning.policy = "{learning.policy}": there is no network to inherit'
    networks = birth.network == "none" or learning.policy in ("ppo", "fixed")
    check.need(networks, f"{path}birth.network", rule)
    rule = 'must be at least 2 with birth.mating = "pairs": nobody mates alone'
    check.need(birth.mating != "pairs" or population.capacity >= 2, f"{path}population.capacity", rule)
    rule = f"must divide world.rollout_steps = {config.world.rollout_steps}"
    check.need(config.world.rollout_steps % learning.minibatch_size == 0, f"{path}learning.minibatch_size", rule)


def _lists(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    all_names, touched_types = [*config.species, *config.food], chosen(config, species.body.collides)
    _known(check, f"{path}sensor.sees", species.sensor.sees, all_names)
    _known(check, f"{path}sensor.smells", species.sensor.smells, all_names)
    _known(check, f"{path}body.collides", species.body.collides, all_names)
    eats = f"{path}diet.eats"
    _known(check, eats, [name for name, _ in species.diet.eats], [*config.food, *config.species])
    for name, share in species.diet.eats:
        is_valid = name not in config.species or 0 <= share <= 1
        check.need(is_valid, eats, f"the share of a {name} must be from 0 to 1", share)
        if name in all_names and name not in touched_types:
            check.add(eats, f"it passes through {name}, so it cannot eat it: add it to body.collides")


def _stores(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    if len(species.stores) > MAX_STORES:
        check.add(f"{path}store", f"there must be at most {MAX_STORES} stores with energy, not {len(species.stores)}")
    for name, store in species.stores.items():
        place = f"{path}{name}" if name == ENERGY else f"{path}store.{name}"
        rule = f"must be at most its capacity = {store.capacity:g}"
        check.need(store.initial <= store.capacity, f"{place}.initial", rule)
    for name in species.store:
        if not re.fullmatch(NAME, name) or name in RESERVED_STORES:
            check.add(f"{path}store.{name}", f"{NAME_RULE} and not be one of " + ", ".join(RESERVED_STORES))
        elif name.startswith(RESERVED_STARTS):
            check.add(f"{path}store.{name}", "a store's name must not begin with " + ", ".join(RESERVED_STARTS))
    for kind in diet(config, species).keys() & config.food.keys():
        for name in config.food[kind].needs.keys() & set(store_columns(config)) - set(species.store):
            rule = f"it needs {name}, which it could never hold: give it store.{name}, or take {kind} out of diet.eats"
            check.add(f"{path}diet.eats", rule)
    observed, noses = sum(store.observed for store in species.stores.values()), species.sensor.noses
    limit = max(MAX_OBSERVED - observed, 0) // noses
    smells = len(smelled(config, species.sensor.smells))
    rule = f"must name at most {limit} with sensor.noses = {noses} and {observed} stores that it observes"
    check.need(smells <= limit, f"{path}sensor.smells", rule)
    if smells <= limit:
        limit = MAX_OBSERVED - observed - smells * noses
        rule = f"must have at most {limit} channels beside {observed} stores and {smells * noses} smells"
        check.need(len(species.sensor.observes) <= limit, f"{path}sensor.observes", rule)


def _known(check: Check, path: str, names: Sequence[str], allowed: Sequence[str]) -> None:
    for name in names:
        rule = "must be names of " + ", ".join(allowed) + f', or "{EVERYTHING}"'
        check.need(name in allowed or name == EVERYTHING, path, rule, name, nearest(name, allowed))


def _read(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    """Reports genes for rules and neighbor queries that nothing reads."""
    has_rule = any(getattr(species, use).rule for use in RULE_USES)
    rules = " or ".join(f"{use}.rule" for use in RULE_USES)
    for section, table in (("genome.extra", species.genome.extra), ("neighbor", species.neighbor)):
        for name in table:
            if not re.fullmatch(NAME, name):
                check.add(f"{path}{section}.{name}", NAME_RULE)
    if species.genome.extra and not has_rule:
        check.add(f"{path}genome.extra", f"only a rule in Python reads this: give {rules}")
    reward = species.reward
    read_channels = {*species.sensor.observes, *(term.channel or name for name, term in reward.pay.items())}
    read_channels |= {reward.gate} if reward.family in GATED else set()
    for name, query in species.neighbor.items():
        _known(check, f"{path}neighbor.{name}.of", query.of, [*config.species, *config.food])
        has_targets = bool(asked_for(config, query.of))
        check.need(has_targets, f"{path}neighbor.{name}.of", "must name a species or a kind of food")
        if not has_rule and not read_channels & {SOURCES[source].name.format(name) for source in QUERIED}:
            rule = f"nothing reads its channels, such as {name}_count: sensor.observes, reward.pay and reward.gate do"
            check.add(f"{path}neighbor.{name}", f"{rule}, and {rules}; neighbor.{name} = false leaves it out")
    if len(species.neighbor) > MAX_QUERIES:
        check.add(f"{path}neighbor", f"there must be at most {MAX_QUERIES} queries, not {len(species.neighbor)}")


def _rules(check: Check, config: Settings, name: str, path: str) -> None:
    reward = config.species[name].reward
    for use in RULE_USES:
        place = f"{path}{use}.rule"
        rule = value_at(config, place)
        check.match(f"({RULE_PATTERN})?", place, "must be FILE.py:NAME, a Python file and a function in it")
        columns = rule_columns(config, name, use) if rule else ()
        for column in {candidate for candidate in columns if columns.count(candidate) > 1}:
            rule = f"two things that it reads are called {column}: rename a food, a query or a term of reward.pay"
            check.need(False, place, rule)
    check.need(
        not reward.memory or bool(reward.rule), f"{path}reward.memory", "is kept by a rule: give reward.rule too"
    )


def _channels(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    """Reports unknown channel names."""
    channels, reward = known_channels(config, species), species.reward
    names = list(dict.fromkeys(channel.name for channel in channels.values()))

    def need(name: str, place: str) -> None:
        count = len(called(channels, name))
        if count == 0:
            hint = next(
                (f"; {explanation}" for start, explanation in CHANNEL_SETTINGS.items() if name.startswith(start)), ""
            )
            rule = f"there is no channel {brief(name)!r} here{hint}; there are " + ", ".join(names)
            check.add(place, rule, nearest(name, names))
        elif count > 1:
            check.add(place, f"{count} channels are called {name}: rename a food, a species, a store or a query")

    need(reward.gate, f"{path}reward.gate")
    for name, term in reward.pay.items():
        if not re.fullmatch(NAME, name):
            check.add(f"{path}reward.pay.{name}", NAME_RULE)
        need(term.channel or name, f"{path}reward.pay.{name}" + (".channel" if term.channel else ""))
    observed_names = [channel.name for channel in plain_channels(species, channels)]
    for name in species.sensor.observes:
        need(name, f"{path}sensor.observes.{name}")
        is_duplicate = name in observed_names and len(called(channels, name)) == 1
        check.need(not is_duplicate, f"{path}sensor.observes.{name}", "it observes this already")


def _genes(check: Check, config: Settings, species: SpeciesConfig, path: str) -> None:
    genome, learning, family = species.genome, species.learning, species.reward.family
    if genome.family and family not in GATED:
        rule = f'reward.family = "{family}" has no threshold: ' + ", ".join(GATED) + " have one"
        check.add(f"{path}genome.family", rule)
    if genome.learning and learning.policy != "ppo":
        rule = f'learning.policy = "{learning.policy}": there is no learning that genes could set'
        check.add(f"{path}genome.learning", rule)
    is_valid_gamma = "gamma" not in genome.learning or 0 < learning.gamma < 1
    check.need(is_valid_gamma, f"{path}learning.gamma", "must lie between 0 and 1 where a gene sets it")
    for value in ("learning_rate", "entropy_coef"):
        is_valid = value not in genome.learning or getattr(learning, value) > 0
        check.need(is_valid, f"{path}learning.{value}", "a gene multiplies it, so it must not be 0")
    for place in genome.set:
        _settable(check, species, place, path)
    if check.has(f"{path}genome."):
        return
    genes = layout_of(config, species).genes
    names = [gene.name for gene in genes]
    if len(names) > MAX_GENES:
        check.add(f"{path}genome", f"there must be at most {MAX_GENES} genes, not {len(names)}")
    for gene in {name for name in names if names.count(name) > 1}:
        check.add(
            f"{path}genome", f"two genes would have the name {gene}: rename a food, a species or what reward.pay has"
        )
    _own_bodies(check, config, path, genes)
    for gene in genome.mutation.keys() - set(names):
        rule = "there is no such gene: there are " + ", ".join(names)
        check.add(f"{path}genome.mutation.{gene}", rule, nearest(gene, names))
    _laws(check, config, species, path, genes)


def _settable(check: Check, species: SpeciesConfig, place: str, path: str) -> None:
    """Reports a gene whose number cannot be set by genes or has no effect."""
    kinds = {name: name if name == ENERGY else f"store.{name}" for name in species.stores}
    places = [template for template in settable() if "<kind>" not in template]
    places += [
        template.replace("store.<kind>", kind)
        for template in settable()
        for kind in kinds.values()
        if "<kind>" in template
    ]
    gene_path, section, name = f"{path}genome.set.{place}", place.split(".")[0], place.split(".")[-1]
    if place not in places:
        reason = NO_GENE.get(name) or NO_GENE.get(section) or "there are " + ", ".join(places)
        check.add(gene_path, f"no gene can set this: {reason}", nearest(place, places))
    elif value_at(species, place) == 0:
        check.add(gene_path, f"a gene multiplies {path}{place}, so that must not be 0")
    elif idle := _idle(species).get(place):
        check.add(gene_path, f"it would have no effect, since {idle}")


def _idle(species: SpeciesConfig) -> dict[str, str]:
    """Numbers that have no effect in a species, each with the reason."""
    birth, sensor = species.birth, species.sensor
    driven = "" if species.reward.drive_reduction_coef else "there is no drive: give reward.drive_reduction_coef"
    reasons = {
        **dict.fromkeys(DRIVE, driven),
        "sensor.smell_decay": "" if sensor.smells else "it smells nothing: give sensor.smells",
        "sensor.nose_angle": "" if sensor.noses == 2 else "its nose lies ahead: give sensor.noses = 2",
        "birth.network_noise": "" if birth.network != "none" else "children inherit no network: give birth.network",
        "birth.mating_range": "" if birth.mating == "pairs" else 'nobody mates: give birth.mating = "pairs"',
    }
    return {place: reason for place, reason in reasons.items() if reason}


def _own_bodies(check: Check, config: Settings, path: str, genes: Sequence[Gene]) -> None:
    """Reports body genes whose bodies do not fit into the arena, can pass walls, or lack their genes at birth."""
    side, radius = min(config.arena.width, config.arena.height), value_at(config, f"{path}body.radius")
    for gene in (gene for gene in genes if gene.place.startswith("genome.set.body.")):
        largest = radius * 10.0**gene.mutation.limit
        if gene.place.endswith(".radius") and 2 * radius < side <= 2 * single(largest):
            rule = (
                f"can make a radius of {largest:g}, which does not fit into the arena: give genome.mutation.{gene.name}"
            )
            check.add(f"{path}{gene.place}", f"{rule} a limit below {math.log10(side / 2 / radius):.3g}")
        smallest, stride = radius / 10.0**gene.mutation.limit, _stride(config)
        if gene.place.endswith(".radius") and smallest <= stride < radius:
            rule = f"can make a radius of {smallest:.3g}, which passes walls, as it moves {stride:.3g} u in a substep"
            limit = f"genome.mutation.{gene.name} a limit below {math.log10(radius / stride):.3g}"
            check.add(f"{path}{gene.place}", f"{rule}: give {limit}, or lower physics.max_speed")
        rule = 'bodies cannot change in a window: needs world.inheritance = "at_birth"'
        if config.world.inheritance != "at_birth":
            check.add(f"{path}{gene.place}", rule)


def _laws(check: Check, config: Settings, species: SpeciesConfig, path: str, genes: Sequence[Gene]) -> None:
    """Reports founder laws that exceed the limits of the species' genes."""
    prefix = path if len(config.species) > 1 else ""
    tightest: dict[str, Gene] = {}
    for gene in genes:
        if gene.mutation.limit < (tightest[gene.place].mutation.limit if gene.place in tightest else math.inf):
            tightest[gene.place] = gene
    without_gene = {
        place.removesuffix(".initial_mean"): None for place, _, _ in leaves(species) if place.endswith("_mean")
    }
    for place, gene in (without_gene | tightest).items():
        limit = gene.mutation.limit if gene else species.genome.weight_limit
        law_path = place if place.startswith("food.") else path + place
        rule = f"must be within ± {_limit_name(species, gene, prefix)}{limit:g}"
        mean = value_at(config, f"{law_path}.initial_mean")
        check.need(abs(mean) <= limit, f"{law_path}.initial_mean", rule)


def _limit_name(species: SpeciesConfig, gene: Gene | None, path: str) -> str:
    """The setting that limits a gene, as "genome.weight_limit = "; "" if the limit follows from the gene's effect."""
    mutation = species.genome.mutation.get(gene.name) if gene else None
    if gene and gene.mutation.limit < (mutation.limit if mutation else species.genome.weight_limit):
        return ""
    return f"{path}genome.mutation.{gene.name}.limit = " if gene and mutation else f"{path}genome.weight_limit = "


def _crowd(check: Check, config: Settings) -> None:
    """Reports a world without founders, or with more than fit into the arena."""
    paths = {name: f"species.{name}.population.initial_count" for name in config.species}
    if not any(species.population.initial_count for species in config.species.values()):
        check.need(False, next(iter(paths.values())), "there must be at least one founder")
    area, room = 0.0, MAX_COVERAGE * config.arena.width * config.arena.height
    for name, species in config.species.items():
        if 2 * species.body.radius >= min(config.arena.width, config.arena.height):
            return  # already reported
        founder_area = math.pi * _founder_radius(species) ** 2
        limit = math.floor((room - area) / founder_area)
        area += species.population.initial_count * founder_area
        check.need(area <= room, paths[name], f"too many to place: the arena has room for {limit}")


def _founder_radius(species: SpeciesConfig) -> float:
    """Radius of a founder, or of a large founder if genes set the radius."""
    law = species.genome.set.get("body.radius")
    return expressed(species, "body.radius", law.initial_mean + law.initial_sd) if law else species.body.radius


def _collisions(check: Check, config: Settings) -> None:
    """Reports pairs of species in which only one collides with the other."""
    touches = {name: chosen(config, species.body.collides) for name, species in config.species.items()}
    for name in touches:
        for other in touches:
            if other in touches[name] and name not in touches[other]:
                check.add(f"species.{other}.body.collides", f"must have {name}, since {name} collides with {other}")
