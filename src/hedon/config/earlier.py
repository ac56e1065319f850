"""Founders' genes in configs of versions before 0.4, which had one mean for all food, one for action, and one spread.

A complete file of such a version is read as what it meant, and digests keep the old form where it says the same, so
that digests of older runs stay valid.
"""

from typing import Any

from hedon.config.config import Config
from hedon.config.layer import Table

_FOOD, _ACTION, _SD = "initial_mean_food", "initial_mean_action", "initial_sd"


def with_genes(tables: Table) -> Table:
    """A complete file's tables, with a section for each gene where it has the old settings."""
    genome = tables.get("genome")
    if not isinstance(genome, dict) or not {_FOOD, _ACTION, _SD} <= genome.keys():
        return tables
    kept = {name: value for name, value in genome.items() if name not in (_FOOD, _ACTION, _SD)}
    spread = {"initial_sd": genome[_SD]}
    kept |= {"action": {"initial_mean": genome[_ACTION]} | spread, "neutral": {"initial_mean": 0.0} | spread}
    gene = {"initial_mean": genome[_FOOD]} | spread
    food = tables.get("food")
    if isinstance(food, dict):
        food = {kind: {"gene": gene} | each if isinstance(each, dict) else each for kind, each in food.items()}
    return tables | {"genome": kept, "food": food}


def old_rows(config: Config) -> tuple[list[list[Any]], set[str]] | None:
    """The old settings' paths and values, and the paths of the settings for which they stand.

    None if the old settings cannot say what a config says. Genes of species, of sight and of learning are not among
    them: those versions had none.
    """
    foods, action, neutral = [food.gene for food in config.food.values()], config.genome.action, config.genome.neutral
    means = {gene.initial_mean for gene in foods}
    if len(means) != 1 or len({gene.initial_sd for gene in (*foods, action, neutral)}) != 1 or neutral.initial_mean:
        return None
    rows = {_FOOD: means.pop(), _ACTION: action.initial_mean, _SD: action.initial_sd}
    genes = ["genome.action", "genome.neutral", *(f"food.{kind}.gene" for kind in config.food)]
    replaced = {f"{gene}.{name}" for gene in genes for name in ("initial_mean", "initial_sd")}
    return [[f"genome.{name}", value] for name, value in rows.items()], replaced
