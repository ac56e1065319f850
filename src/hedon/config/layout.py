"""What the numbers of an agent mean: the only place that knows the order of genes, reward terms and sensor channels.

The engine gets these layouts as data, the records carry them, and columns, labels and figures are named by them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from hedon.config.channel import Channel, observed_channels, recorded_channels
from hedon.config.evolution import FAMILY_GENES, LEARNING_GENES, OF_ALL_GENES, GeneConfig, MutationConfig
from hedon.config.field import value_at
from hedon.config.problem import nearest
from hedon.config.settings import Settings
from hedon.config.species import EVERYTHING, SpeciesConfig
from hedon.config.store import ENERGY
from hedon.error import ArgumentError
from hedon.text import brief

WALL = "wall"
"""What senses call a wall."""
OBSTACLE = "obstacle"
"""What senses call an obstacle, in worlds that have some."""
SOLID = (WALL, OBSTACLE)
"""What every species sees and collides with, where it is."""
SCALE, OLD = "_scale", "_old"
SECOND_GENES = {"scaled": (SCALE, "power of ten of the reward weight"), "by_age": (OLD, "reward weight when old")}
"""Families of rewards whose weights have a second gene: the end of its name, and what it is."""
SET_POINT = "set_point"
EXTRA = "extra_"
"""What the columns of genes for rules begin with."""
MAX_EXPONENT, MAX_WEIGHT = 2.0, 1e3
"""Largest limit of genes that are exponents, and of others."""


@dataclass(frozen=True, slots=True)
class Gene:
    """One gene of a genome.

    Attributes:
        name: Its column in the records.
        role: "reward", "learning", "rule" or "neutral".
        meaning: What it does, as a phrase.
        law: How founders draw it.
        place: The path of the law: in the config where it begins with "food.", else in the species.
        mutation: How it mutates, and its limit, which is at most `most`.
        most: The largest limit that it can have.
    """

    name: str
    role: str
    meaning: str
    law: GeneConfig
    place: str
    mutation: MutationConfig
    most: float


@dataclass(frozen=True, slots=True)
class RewardTerm:
    """One term of a reward: coef · gene · input.

    Attributes:
        input: The engine's name of the input.
        index: Which food kind, for inputs that there are several of.
        gene: Name of the gene that weighs it.
        second_gene: Name of the weight's other gene, where the family of the reward has one.
        coef: Factor of the term.
        place: The path of the factor in the species.
    """

    input: str
    index: int
    gene: str
    second_gene: str
    coef: float
    place: str

    @property
    def name(self) -> str:
        """What is paid: `normal`, `action`, `see_predator`, or `drive_reduction`."""
        return "drive_reduction" if self.input == "drive_reduction" else self.gene.removeprefix("w_")


@dataclass(frozen=True, slots=True)
class SpeciesLayout:
    """The layouts of one species.

    Attributes:
        genes: The genome, in order.
        terms: The reward, in order.
        sees: What its rays tell apart, in the order of their channels.
        stores: Names of its stores, in the engine's order: energy first.
        observed: What it observes beside rays and touch, in order.
        recorded: What a rule gets beside the reward's inputs, genes and memory, in order.
        smells: What it smells, in the order of the channels of smell.
        touches: What it collides with and feels, in the order of the channels of touch.
    """

    genes: tuple[Gene, ...]
    terms: tuple[RewardTerm, ...]
    sees: tuple[str, ...]
    touches: tuple[str, ...]
    smells: tuple[str, ...]
    stores: tuple[str, ...]
    observed: tuple[Channel, ...]
    recorded: tuple[Channel, ...]

    @property
    def gene_names(self) -> tuple[str, ...]:
        """Names of all genes, in order."""
        return tuple(gene.name for gene in self.genes)


def types(config: Settings) -> tuple[str, ...]:
    """What senses may tell apart, in the engine's order: the species, the kinds of food, walls, and obstacles."""
    return (*config.species, *config.food, *(SOLID if config.obstacle.count else (WALL,)))


def layouts(config: Settings) -> dict[str, SpeciesLayout]:
    """The layouts of every species, by name, in the order of the config."""
    return {name: layout_of(config, species) for name, species in config.species.items()}


def gene_columns(config: Settings) -> tuple[str, ...]:
    """Names of the genes of all species, each once, in order; neutral markers last."""
    genes = {gene.name: gene for layout in layouts(config).values() for gene in layout.genes}
    return (
        *(name for name, gene in genes.items() if gene.role != "neutral"),
        *(name for name, gene in genes.items() if gene.role == "neutral"),
    )


def observation_columns(config: Settings, name: str) -> tuple[str, ...]:
    """Names of the entries of what a species observes, in order: model page, section 5.

    Args:
        config: with the species.
        name: of the species.
    """
    species, layout = config.species[name], layout_of(config, config.species[name])
    return (
        *(f"ray_{kind}_{i}" for kind in layout.sees for i in range(species.sensor.ray_count)),
        *(f"touch_{kind}_{i}" for kind in layout.touches for i in range(species.sensor.touch_sectors)),
        *(channel.name for channel in layout.observed),
    )


def store_columns(config: Settings) -> tuple[str, ...]:
    """Names of the stores of all species but energy, each once, in order."""
    return tuple(dict.fromkeys(name for species in config.species.values() for name in species.store))


def rule_columns(config: Settings, name: str, use: str = "reward") -> tuple[str, ...]:
    """Names of the fields of the record that a rule of a species gets of each agent, in order.

    An input of the reward is called as its gene is, without the `w_`: `normal`, `action`, `see_predator`; or
    `drive_reduction`. What the config itself would say is `linear` for a reward, and `chance` for a hazard or a birth.
    Where there are other stores than energy, they stand before it, each as it was at the start of the step and as it
    is.

    Args:
        config: with the species.
        name: of the species.
        use: of the rule: "reward", "hazard" or "birth".
    """
    layout, memory = layout_of(config, config.species[name]), config.species[name].reward.memory
    inputs = (term.name for term in layout.terms)
    own = "linear" if use == "reward" else "chance"
    channels = (channel.name for channel in layout.recorded)
    return (*inputs, *layout.gene_names, *channels, own, *(f"memory_{i + 1}" for i in range(memory)))


def choose_species(name: str | None, config: Settings) -> str:
    """The species of this name, or by default the first.

    Args:
        name: as a user gives it, or None.
        config: with the species.

    Raises:
        ArgumentError: There is no such species.
    """
    known = list(config.species)
    if name is not None and name not in known:
        near = nearest(name, known)
        hint = f"; did you mean {near}?" if near else ""
        raise ArgumentError(f"species {brief(name)!r}: there is no such species (there are {', '.join(known)}){hint}")
    return known[0] if name is None else name


def diet(config: Settings, species: SpeciesConfig) -> dict[str, float]:
    """What a species eats: factors by name.

    Args:
        config: with the foods.
        species: one of the config's.
    """
    return {
        each: factor
        for name, factor in species.diet.eats
        for each in (config.food if name == EVERYTHING else [name])
        if factor != 0.0
    }


def hunted(config: Settings) -> str:
    """The first species that another one eats.

    Raises:
        StopIteration: no species is eaten by another.
    """
    return next(name for name in config.species if hunters(config, name))


def hunters(config: Settings, name: str) -> tuple[str, ...]:
    """The other species that eat a species, in order.

    Args:
        config: with the species.
        name: of the species that is eaten.
    """
    return tuple(other for other, each in config.species.items() if other != name and name in diet(config, each))


def chosen(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The types that a list of names stands for, in order; walls and obstacles are always among them.

    Args:
        config: with the types.
        names: of types, or `EVERYTHING`.
    """
    every = types(config)
    return every if EVERYTHING in names else tuple(name for name in every if name in names or name in SOLID)


def smelled(config: Settings, names: Sequence[str]) -> tuple[str, ...]:
    """The sources of smell that a list of names stands for, in order: species and kinds of food.

    Args:
        config: with the types.
        names: of sources, or `EVERYTHING`.
    """
    return tuple(name for name in (*config.species, *config.food) if name in names or EVERYTHING in names)


def set_point_of(store: str) -> str:
    """The gene of the set point of a store."""
    return SET_POINT if store == ENERGY else f"{SET_POINT}_{store}"


class _Layout:
    """Collects the genes and reward terms of one species, in order."""

    def __init__(self, config: Settings, species: SpeciesConfig) -> None:
        self.config, self.species = config, species
        self.genes: list[Gene] = []
        self.terms: list[RewardTerm] = []

    def add_gene(self, name: str, role: str, meaning: str, place: str) -> None:
        genome = self.species.genome
        law = value_at(self.config if place.startswith("food.") else self.species, place)
        common = {own: getattr(genome, whole) for own, whole in OF_ALL_GENES.items()}
        mutation = genome.mutation.get(name, MutationConfig(**common))
        most = _most(self.species.reward.family, role, name)
        limited = replace(mutation, limit=min(mutation.limit, most))
        self.genes.append(Gene(name, role, meaning, law, place, limited, most))

    def add_term(self, kind: str, index: int, of: str, meaning: str, law: str, coef: str) -> None:
        """Adds a term, the gene that weighs its input, and the weight's second gene if it has one.

        `law` is the place of the gene's law, `coef` that of the term's factor.
        """
        weight = second = f"w_{of}"
        self.add_gene(weight, "reward", f"reward weight for {meaning}", law)
        if self.species.reward.family in SECOND_GENES:
            ending, what = SECOND_GENES[self.species.reward.family]
            second = weight + ending
            self.add_gene(second, "reward", f"{what} for {meaning}", "genome.second")
        self.terms.append(RewardTerm(kind, index, weight, second, value_at(self.species, coef), coef))


def _most(family: str, role: str, name: str) -> float:
    """The largest limit that a gene can have: beyond it, what it stands for is out of all proportion."""
    exponent = family == "sinh" and role == "reward" and not name.startswith(SET_POINT)
    exponent |= name.endswith(SCALE) or role == "learning" or name.removeprefix("g_") in FAMILY_GENES
    return MAX_EXPONENT if exponent else MAX_WEIGHT


def layout_of(config: Settings, species: SpeciesConfig) -> SpeciesLayout:
    """The layouts of one species. It must see and smell all that it is rewarded for.

    Args:
        config: with what the species shares with others.
        species: one of the config's.
    """
    made, genome, reward = _Layout(config, species), species.genome, species.reward
    eaten, sees = diet(config, species), chosen(config, species.sensor.sees)
    for index, kind in enumerate(config.food):
        if kind in eaten:
            made.add_term("food", index, kind, f"a food of kind {kind}", f"food.{kind}.gene", "reward.meal_coef")
    for index, name in enumerate(config.species, len(config.food)):
        if name in eaten:
            made.add_term("food", index, name, f"eating a {name}", "genome.prey", "reward.meal_coef")
    made.add_term("action", 0, "action", "motor action", "genome.action", "reward.action_coef")
    for name, see in reward.see.items():
        read, place = sees.index(see.reads or name), f"reward.see.{name}"
        made.add_term(f"see_{see.over_rays}", read, f"see_{name}", f"seeing {name}", f"{place}.gene", f"{place}.coef")
    smells = smelled(config, species.sensor.smells)
    for name in reward.smell:
        place = f"reward.smell.{name}"
        made.add_term(
            "smell", smells.index(name), f"smell_{name}", f"smelling {name}", f"{place}.gene", f"{place}.coef"
        )
    if reward.drive_reduction_coef:
        for name, store in species.stores.items():
            measure = "motor_threshold" if store.motor_threshold else "capacity"
            place = f"{name if name == ENERGY else f'store.{name}'}.set_point"
            made.add_gene(set_point_of(name), "reward", f"{name} that it seeks, as a share of its {measure}", place)
        coef = "reward.drive_reduction_coef"
        made.terms.append(RewardTerm("drive_reduction", 0, SET_POINT, SET_POINT, reward.drive_reduction_coef, coef))
    for name in genome.family:
        made.add_gene(f"g_{name}", "reward", FAMILY_GENES[name], f"genome.family.{name}")
    for name in genome.learning:
        made.add_gene(f"g_{name}", "learning", LEARNING_GENES[name], f"genome.learning.{name}")
    for name in genome.extra:
        made.add_gene(f"{EXTRA}{name}", "rule", f"{name}, for rules in Python", f"genome.extra.{name}")
    for i in range(genome.neutral_count):
        meaning = "neutral marker: inherited and mutated, no effect"
        made.add_gene(f"neutral_{i + 1}", "neutral", meaning, "genome.neutral")
    touches = chosen(config, species.body.collides)
    return SpeciesLayout(
        genes=tuple(made.genes),
        terms=tuple(made.terms),
        sees=sees,
        touches=touches,
        smells=smells,
        stores=tuple(species.stores),
        observed=observed_channels(species, smells),
        recorded=recorded_channels(species),
    )
