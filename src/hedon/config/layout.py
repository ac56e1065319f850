"""What the numbers of an agent mean: the only place that knows the order of genes, reward terms and sensor channels.

The engine gets these layouts as data, the records carry them, and columns, labels and figures are named by them.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from hedon.config.config import Config
from hedon.config.evolution import GeneConfig
from hedon.config.problem import nearest
from hedon.config.species import EVERYTHING, PER_SPECIES, SpeciesConfig
from hedon.error import ArgumentError
from hedon.text import brief

WALL = "wall"
"""What senses call a wall."""


@dataclass(frozen=True, slots=True)
class Gene:
    """One gene of a genome.

    Attributes:
        name: Its column in the records.
        role: "reward" or "neutral".
        meaning: What it does, as a phrase.
        law: How founders draw it.
    """

    name: str
    role: str
    meaning: str
    law: GeneConfig


@dataclass(frozen=True, slots=True)
class RewardTerm:
    """One term of a reward: coef · gene · input.

    Attributes:
        input: The engine's name of the input.
        index: Which food kind, for inputs that there are several of.
        gene: Name of the gene that weighs it.
        coef: Factor of the term.
    """

    input: str
    index: int
    gene: str
    coef: float


@dataclass(frozen=True, slots=True)
class SpeciesLayout:
    """The layouts of one species.

    Attributes:
        genes: The genome, in order.
        terms: The reward, in order.
        sees: What its rays tell apart, in the order of their channels.
        touches: What it collides with and feels, in the order of the channels of touch.
    """

    genes: tuple[Gene, ...]
    terms: tuple[RewardTerm, ...]
    sees: tuple[str, ...]
    touches: tuple[str, ...]

    @property
    def gene_names(self) -> tuple[str, ...]:
        """Names of all genes, in order."""
        return tuple(gene.name for gene in self.genes)


def types(config: Config) -> tuple[str, ...]:
    """What senses may tell apart, in the engine's order: the species, the kinds of food, walls."""
    return (*config.agents, *config.food, WALL)


def layouts(config: Config) -> dict[str, SpeciesLayout]:
    """The layouts of every species, by name, in the order of the config."""
    return {name: _layout(config, species) for name, species in config.agents.items()}


def gene_columns(config: Config) -> tuple[str, ...]:
    """Names of the genes of all species, each once, in order; neutral markers last."""
    genes = {gene.name: gene for layout in layouts(config).values() for gene in layout.genes}
    return (
        *(name for name, gene in genes.items() if gene.role != "neutral"),
        *(name for name, gene in genes.items() if gene.role == "neutral"),
    )


def choose_species(name: str | None, config: Config) -> str | None:
    """The species of this name, or by default the first; None where there is only one, without a name.

    Raises:
        ArgumentError: There is no such species.
    """
    known = list(config.species)
    if name is not None and name not in known:
        there = "there are " + ", ".join(known) if known else "the config has only one, without a name"
        near = nearest(name, known)
        hint = f"; did you mean {near}?" if near else ""
        raise ArgumentError(f"species {brief(name)!r}: there is no such species ({there}){hint}")
    return name if name is not None else next(iter(known), None)


def of_species(config: Config, name: str) -> Config:
    """A config whose sections are those of one of its species, which also comes first among the species."""
    if not config.species:
        return config
    own = config.species[name]
    sections = {section: getattr(own, section) for section in PER_SPECIES}
    return replace(config, **sections, species={name: own} | config.species)


def with_genome(config: Config, **changes: Any) -> Config:
    """A config with other settings of `[genome]`, in all of its species."""
    species = {name: replace(each, genome=replace(each.genome, **changes)) for name, each in config.species.items()}
    return replace(config, genome=replace(config.genome, **changes), species=species)


def diet(config: Config, species: SpeciesConfig) -> dict[str, float]:
    """What a species eats: factors by name."""
    return {
        each: factor
        for name, factor in species.diet.eats
        for each in (config.food if name == EVERYTHING else [name])
        if factor != 0.0
    }


def chosen(config: Config, names: Sequence[str]) -> tuple[str, ...]:
    """The types that a list of names stands for, in order; walls are always among them."""
    every = types(config)
    return every if EVERYTHING in names else tuple(name for name in every if name in names or name == WALL)


def _layout(config: Config, species: SpeciesConfig) -> SpeciesLayout:
    genes: list[Gene] = []
    terms: list[RewardTerm] = []
    eaten = diet(config, species)
    for index, (kind, food) in enumerate(config.food.items()):
        if kind in eaten:
            genes.append(Gene(f"w_{kind}", "reward", f"reward weight for a food of kind {kind}", food.gene))
            terms.append(RewardTerm("food", index, f"w_{kind}", 1.0))
    for index, name in enumerate(config.agents):
        if name in eaten:
            genes.append(Gene(f"w_{name}", "reward", f"reward weight for eating a {name}", species.genome.prey))
            terms.append(RewardTerm("food", len(config.food) + index, f"w_{name}", 1.0))
    genes.append(Gene("w_action", "reward", "reward weight for motor action", species.genome.action))
    terms.append(RewardTerm("action", 0, "w_action", species.reward.action_coef))
    sees = chosen(config, species.sensor.sees)
    for name, see in species.reward.see.items():
        genes.append(Gene(f"w_see_{name}", "reward", f"reward weight for seeing {name}", see.gene))
        terms.append(RewardTerm(f"see_{see.over_rays}", sees.index(name), f"w_see_{name}", see.coef))
    meaning = "neutral marker: inherited and mutated, no effect on the reward"
    genes += [
        Gene(f"neutral_{i + 1}", "neutral", meaning, species.genome.neutral)
        for i in range(species.genome.neutral_count)
    ]
    return SpeciesLayout(
        genes=tuple(genes),
        terms=tuple(terms),
        sees=sees,
        touches=chosen(config, species.body.collides),
    )
