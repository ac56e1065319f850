"""Contradictions in how founders draw their genes."""

from collections.abc import Iterator

from hedon.config.config import Config
from hedon.config.evolution import GeneConfig
from hedon.config.layout import Gene, layout_of
from hedon.config.problem import Problem, format_value
from hedon.config.species import SpeciesConfig


def law_problems(config: Config, species: SpeciesConfig, path: str) -> Iterator[Problem]:
    """What founders of a species draw lies within the limits of its own genes.

    Args:
        config: Whose layouts can be made.
        species: One of its species.
        path: Of its sections, "species.NAME.".
    """
    genes = layout_of(config, species).genes
    for place, law in _laws(config, species, path):
        using = [gene for gene in genes if gene.law is law]
        if not using and place.startswith("food."):
            continue
        gene = min(using, key=lambda each: each.mutation.limit, default=None)
        limit = gene.mutation.limit if gene else species.genome.weight_limit
        if abs(law.initial_mean) > limit:
            owner = path if len(config.species) > 1 else ""
            rule = f"must be within ± {_limit_name(species, gene, owner)}{limit:g}"
            yield Problem(f"{place}.initial_mean", rule, format_value(law.initial_mean))


def _laws(config: Config, species: SpeciesConfig, path: str) -> Iterator[tuple[str, GeneConfig]]:
    """Every law by which founders of a species draw a gene, with its path."""
    genome, reward = species.genome, species.reward
    for name in ("action", "prey", "neutral", "second", "set_point", "set_point_nutrient", "set_point_toxin"):
        yield f"{path}genome.{name}", getattr(genome, name)
    for table in ("learning", "family"):
        for name, law in getattr(genome, table).items():
            yield f"{path}genome.{table}.{name}", law
    for table in ("see", "smell"):
        for name, term in getattr(reward, table).items():
            yield f"{path}reward.{table}.{name}.gene", term.gene
    for kind, food in config.food.items():
        yield f"food.{kind}.gene", food.gene


def _limit_name(species: SpeciesConfig, gene: Gene | None, path: str) -> str:
    """The setting that says a limit, as "genome.weight_limit = "; empty where what the gene stands for limits it."""
    own = species.genome.mutation.get(gene.name) if gene else None
    if gene and gene.mutation.limit < (own.limit if own else species.genome.weight_limit):
        return ""
    return f"{path}genome.mutation.{gene.name}.limit = " if gene and own else f"{path}genome.weight_limit = "
