"""How founders draw a gene, by the name of its column in the records."""

from hedon.config.config import Config
from hedon.config.evolution import GeneConfig


def gene_config(config: Config, column: str) -> GeneConfig:
    """How founders draw the gene of a column: `w_<kind>`, `w_action`, or a neutral marker."""
    if column == "w_action":
        return config.genome.action
    kind = column.removeprefix("w_")
    return config.genome.neutral if kind == column else config.food[kind].gene
