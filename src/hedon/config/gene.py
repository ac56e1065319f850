"""How founders draw a gene, by the name of its column in the records."""

from hedon.config.config import Config
from hedon.config.evolution import GeneConfig
from hedon.config.layout import layouts


def gene_config(config: Config, column: str) -> GeneConfig:
    """How founders draw the gene of a column; of the first species that has it."""
    return next(gene.law for layout in layouts(config).values() for gene in layout.genes if gene.name == column)
