"""Layouts of an agent's numbers: the only place that defines the order of genes, reward terms and sensor channels.

The engine gets these layouts as data, records store them, and columns, labels and figures take their names from them.
"""

from dataclasses import dataclass, replace

from hedon.config.channel import Channel, called, known_channels, observed_channels, recorded_channels
from hedon.config.expression import gene_column
from hedon.config.field import value_at
from hedon.config.problem import did_you_mean
from hedon.config.schema.evolution import (
    FAMILY_GENES,
    LEARNING_GENES,
    MAX_EXPONENT,
    OF_ALL_GENES,
    GeneConfig,
    MutationConfig,
    RewardConfig,
)
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import ENERGY
from hedon.config.type import chosen, diet, seen, smelled
from hedon.error import ArgumentError
from hedon.text import brief

SCALE, ABOVE, OLD = "_scale", "_above", "_old"
SECOND_GENES = {
    SCALE: "power of ten of the reward weight",
    ABOVE: "reward weight above the threshold",
    OLD: "reward weight when old",
}
"""Suffixes of the names of weights' second genes, with descriptions of these genes."""
SET_POINT = "set_point"
EXTRA = "extra_"
"""Prefix of the columns of genes for rules."""
MAX_WEIGHT = 1e3
"""Largest limit of genes that are not exponents."""


@dataclass(frozen=True, slots=True)
class Gene:
    """One gene of a genome.

    Attributes:
        name: Its column in the records.
        role: "reward", "learning", "setting", "rule" or "neutral".
        meaning: Effect of the gene, as a phrase.
        law: Distribution of founders' values.
        place: Path of the law: in the config if it begins with "food.", else in the species.
        mutation: Its mutation, with a limit of at most `most`.
        most: Largest limit allowed for the gene.
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
    """One term of a reward: coef · weight · channel.

    Attributes:
        name: What is rewarded: `normal`, `action`, `see_predator`, or `drive_reduction`.
        channel: Channel that the term multiplies.
        gene: Name of the gene that gives the weight; "" for none.
        second_gene: Name of the weight's second gene, if the reward family has one.
        coef: Factor of the term.
        place: Path of the factor in the species.
    """

    name: str
    channel: Channel
    gene: str
    second_gene: str
    coef: float
    place: str


@dataclass(frozen=True, slots=True)
class SpeciesLayout:
    """Layouts of one species.

    Attributes:
        genes: Genes in genome order.
        terms: Reward terms, in order.
        sees: Types that its rays distinguish, in the order of their channels.
        stores: Names of its stores in the engine's order, energy first.
        observed: Channels observed besides rays and touch, in order.
        last: Channels stored during a step for the next observation, in order.
        recorded: Channels that a rule gets besides the reward's inputs, genes and memory, in order.
        gate: Channel that the reward family compares with a threshold, if it has one.
        smells: Types that it smells, in the order of the smell channels.
        touches: Types that it collides with and feels, in the order of the touch channels.
    """

    genes: tuple[Gene, ...]
    terms: tuple[RewardTerm, ...]
    sees: tuple[str, ...]
    touches: tuple[str, ...]
    smells: tuple[str, ...]
    stores: tuple[str, ...]
    observed: tuple[Channel, ...]
    last: tuple[Channel, ...]
    recorded: tuple[Channel, ...]
    gate: Channel

    @property
    def gene_names(self) -> tuple[str, ...]:
        """Names of all genes, in order."""
        return tuple(gene.name for gene in self.genes)


def layouts(config: Settings) -> dict[str, SpeciesLayout]:
    """Layouts of every species by name, in the order of the config."""
    return {name: layout_of(config, species) for name, species in config.species.items()}


def gene_columns(config: Settings) -> tuple[str, ...]:
    """Names of the genes of all species, without repeats, in order; neutral genes come last."""
    genes = {gene.name: gene for layout in layouts(config).values() for gene in layout.genes}
    return (
        *(name for name, gene in genes.items() if gene.role != "neutral"),
        *(name for name, gene in genes.items() if gene.role == "neutral"),
    )


def observation_columns(config: Settings, name: str) -> tuple[str, ...]:
    """Names of the entries of a species' observation, in order: model page, section 5."""
    species, layout = config.species[name], layout_of(config, config.species[name])
    return (
        *(f"ray_{kind}_{i}" for kind in layout.sees for i in range(species.sensor.ray_count)),
        *(f"touch_{kind}_{i}" for kind in layout.touches for i in range(species.sensor.touch_sectors)),
        *(channel.name for channel in layout.observed),
    )


def store_columns(config: Settings) -> tuple[str, ...]:
    """Names of all species' stores except energy, without repeats, in order."""
    return tuple(dict.fromkeys(name for species in config.species.values() for name in species.store))


def rule_columns(config: Settings, name: str, use: str = "reward") -> tuple[str, ...]:
    """Names of the fields that a species' rule receives for each agent, in order.

    An input of the reward has the name of its gene without `w_`: `normal`, `action`, `see_predator`; or it is
    `drive_reduction`. The config's own value is `linear` for a reward, and `chance` for a hazard or a birth. Stores
    other than energy come before it, each at the start of the step and now.
    """
    layout, memory = layout_of(config, config.species[name]), config.species[name].reward.memory
    inputs = (term.name for term in layout.terms)
    computed = "linear" if use == "reward" else "chance"
    channels = (channel.name for channel in layout.recorded)
    return (*inputs, *layout.gene_names, *channels, computed, *(f"memory_{i + 1}" for i in range(memory)))


def choose_species(name: str | None, config: Settings) -> str:
    """Returns the name of a species, by default the first.

    Raises:
        ArgumentError: The species does not exist.
    """
    names = list(config.species)
    if name is not None and name not in names:
        hint = did_you_mean(name, names)
        raise ArgumentError(f"species {brief(name)!r}: there is no such species (there are {', '.join(names)}){hint}")
    return names[0] if name is None else name


def set_point_of(store: str) -> str:
    """Name of the gene for a store's set point."""
    return SET_POINT if store == ENERGY else f"{SET_POINT}_{store}"


class _Layout:
    """Collects the genes and reward terms of one species, in order."""

    def __init__(self, config: Settings, species: SpeciesConfig) -> None:
        self.config, self.species = config, species
        self.known = known_channels(config, species)
        self.genes: list[Gene] = []
        self.terms: list[RewardTerm] = []

    def add_gene(self, name: str, role: str, meaning: str, place: str) -> None:
        genome = self.species.genome
        law = value_at(self.config if place.startswith("food.") else self.species, place)
        common = {setting: getattr(genome, default_name) for setting, default_name in OF_ALL_GENES.items()}
        mutation = genome.mutation.get(name, MutationConfig(**common))
        most = _most(self.species.reward.family, role, name)
        limited = replace(mutation, limit=min(mutation.limit, most))
        self.genes.append(Gene(name, role, meaning, law, place, limited, most))

    def add_term(self, name: str, channel: Channel, meaning: str, law: str, coef: str) -> None:
        """Adds a term, the gene that weighs its channel, and the weight's second gene if it has one.

        `law` is the path of the gene's law, `coef` the path of the term's factor.
        """
        weight = second = f"w_{name}"
        self.add_gene(weight, "reward", f"reward weight for {meaning}", law)
        ending = second_ending(self.species.reward)
        if ending:
            second = weight + ending
            self.add_gene(second, "reward", f"{SECOND_GENES[ending]} for {meaning}", "genome.second")
        self.terms.append(RewardTerm(name, channel, weight, second, value_at(self.species, coef), coef))


def second_ending(reward: RewardConfig) -> str:
    """Suffix of the names of weights' second genes; "" if weights have one gene."""
    if reward.family == "between":
        return OLD if reward.gate == "age" else ABOVE
    return SCALE if reward.family == "scaled" else ""


def _most(family: str, role: str, name: str) -> float:
    """Largest limit allowed for a gene; beyond it, the effect is absurdly large."""
    exponent = family == "sinh" and role == "reward" and not name.startswith(SET_POINT)
    exponent |= name.endswith(SCALE) or role in ("learning", "setting") or name.removeprefix("g_") in FAMILY_GENES
    return MAX_EXPONENT if exponent else MAX_WEIGHT


def layout_of(config: Settings, species: SpeciesConfig) -> SpeciesLayout:
    """Layouts of one species. All channels that its reward uses must exist."""
    layout, genome, reward = _Layout(config, species), species.genome, species.reward
    eaten, channels = diet(config, species), layout.known
    for meal, name in enumerate((*config.food, *config.species)):
        if name in eaten:
            food = name in config.food
            description, law = (
                (f"a food of kind {name}", f"food.{name}.gene") if food else (f"eating a {name}", "genome.prey")
            )
            layout.add_term(name, channels["meals", meal], description, law, "reward.meal_coef")
    effort = "effort" if reward.action_norm == "max_force" else "force_norm"
    layout.add_term("action", channels[effort, 0], "motor action", "genome.action", "reward.action_coef")
    for name, pay in reward.pay.items():
        (paid,), place = called(channels, pay.channel or name), f"reward.pay.{name}"
        layout.add_term(name, paid, paid.meaning, f"{place}.gene", f"{place}.coef")
    if reward.drive_reduction_coef:
        for name, store in species.stores.items():
            measure = "motor_threshold" if store.motor_threshold else "capacity"
            place = f"{name if name == ENERGY else f'store.{name}'}.set_point"
            layout.add_gene(set_point_of(name), "reward", f"{name} that it seeks, as a share of its {measure}", place)
        coef, paid = "reward.drive_reduction_coef", channels["drive_reduction", 0]
        layout.terms.append(RewardTerm(paid.name, paid, "", "", reward.drive_reduction_coef, coef))
    for name in genome.family:
        layout.add_gene(f"g_{name}", "reward", FAMILY_GENES[name], f"genome.family.{name}")
    for name in genome.learning:
        layout.add_gene(f"g_{name}", "learning", LEARNING_GENES[name], f"genome.learning.{name}")
    for place in genome.set:
        meaning = f"power of ten by which {place} differs"
        layout.add_gene(gene_column(place), "setting", meaning, f"genome.set.{place}")
    for name in genome.extra:
        layout.add_gene(f"{EXTRA}{name}", "rule", f"{name}, for rules in Python", f"genome.extra.{name}")
    for i in range(genome.neutral_count):
        meaning = "neutral gene: inherited and mutated, no effect"
        layout.add_gene(f"neutral_{i + 1}", "neutral", meaning, "genome.neutral")
    observed, last = observed_channels(species, channels)
    paid = {(term.name, term.channel) for term in layout.terms}
    return SpeciesLayout(
        genes=tuple(layout.genes),
        terms=tuple(layout.terms),
        sees=seen(config, species.sensor.sees),
        touches=chosen(config, species.body.collides),
        smells=smelled(config, species.sensor.smells),
        stores=tuple(species.stores),
        observed=observed,
        last=last,
        recorded=tuple(
            channel for channel in recorded_channels(species, channels) if (channel.name, channel) not in paid
        ),
        gate=called(channels, reward.gate)[0],
    )
