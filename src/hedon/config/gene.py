"""A gene by the name of its column in the records."""

from hedon.config.layout import Gene, layouts
from hedon.config.settings import Settings


def gene_of(config: Settings, column: str) -> Gene:
    """The gene of a column, of the first species that has it; a column such as "prey.w_normal" names the species.

    Args:
        config: with the species.
        column: of a genome.
    """
    return _genes(config, column)[0]


def limit_of(config: Settings, column: str) -> float:
    """What a gene is clipped to, on both sides; without a species in the column, in all that have it.

    Args:
        config: with the species.
        column: of a genome.
    """
    return min(gene.mutation.limit for gene in _genes(config, column))


def _genes(config: Settings, column: str) -> list[Gene]:
    species, _, name = column.rpartition(".")
    made = layouts(config)
    wanted = [made[species]] if species else made.values()
    return [gene for layout in wanted for gene in layout.genes if gene.name == name]
