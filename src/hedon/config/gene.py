"""Looks up genes by their columns in the records."""

from collections.abc import Iterable, Mapping

from hedon.config.layout import Gene, SpeciesLayout, layouts
from hedon.config.schema.settings import Settings


def gene_of(config: Settings, column: str) -> Gene:
    """The gene of a column in the first species that has it, or in the species of a column such as "prey.w_normal"."""
    return _genes(layouts(config), column)[0]


def limits_of(config: Settings, columns: Iterable[str]) -> dict[str, float]:
    """Absolute limit of each gene, by column; if a column names no species, the smallest among species that have it."""
    layouts_by_species = layouts(config)
    return {column: min(gene.mutation.limit for gene in _genes(layouts_by_species, column)) for column in columns}


def _genes(layouts_by_species: Mapping[str, SpeciesLayout], column: str) -> list[Gene]:
    species, _, name = column.rpartition(".")
    selected = [layouts_by_species[species]] if species else layouts_by_species.values()
    return [gene for layout in selected for gene in layout.genes if gene.name == name]
