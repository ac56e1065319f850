"""Access to tables of worlds with several species: code that sums or averages rows must take rows of one species.

Rows of prey and predators look alike, but means over both are meaningless. Functions that read a table check here that
it is of one species.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import polars as pl

from hedon.config.config import Config
from hedon.config.layout import layouts
from hedon.config.type import diet
from hedon.error import ArgumentError
from hedon.record.schema import Columns


@dataclass(frozen=True)
class Kind:
    """Meaning of a table's columns for one species.

    Attributes:
        foods: Kinds of food that it may eat.
        prey: Species that it may eat, possibly including its own.
        rewards, neutral: Its genes that have an effect, and its neutral genes.
    """

    foods: tuple[str, ...]
    prey: tuple[str, ...]
    rewards: tuple[str, ...]
    neutral: tuple[str, ...]

    @property
    def genes(self) -> tuple[str, ...]:
        """All its genes, in order."""
        return (*self.rewards, *self.neutral)


def by_species(rows: pl.DataFrame, columns: Columns) -> dict[str, pl.DataFrame]:
    """Rows of each species by name, in the order of the config; all rows if there is one species.

    Args:
        rows: Table `agents` or `population`, or a part of it.
        columns: Columns of the run, `run.columns`.
    """
    if not columns.several:
        return {columns.species[0]: rows}
    return {name: rows.filter(pl.col("species") == name) for name in columns.species}


def kinds(columns: Columns, config: Config | None = None) -> Mapping[str, Kind]:
    """What each species of a run eats and inherits, by name.

    Raises:
        ArgumentError: There are several species but no config.
    """
    if not columns.several:
        single_kind = Kind(columns.food_kinds, columns.prey, columns.reward_names, columns.neutral_names)
        return {columns.species[0]: single_kind}
    if config is None:
        raise ArgumentError("config: is needed where there are several species")
    species_kinds = {}
    for name, layout in layouts(config).items():
        eaten, gene_names = diet(config, config.species[name]), set(layout.gene_names)
        species_kinds[name] = Kind(
            foods=tuple(kind for kind in columns.food_kinds if kind in eaten),
            prey=tuple(prey for prey in columns.prey if prey in eaten),
            rewards=tuple(gene for gene in columns.reward_names if gene in gene_names),
            neutral=tuple(gene for gene in columns.neutral_names if gene in gene_names),
        )
    return species_kinds


def require_one_species(rows: pl.DataFrame) -> None:
    """Refuses rows of several species.

    Raises:
        ArgumentError: The rows are of several species.
    """
    if "species" in rows.columns and rows["species"].n_unique() > 1:
        names = ", ".join(rows["species"].unique(maintain_order=True))
        raise ArgumentError(f"rows are of several species ({names}): choose one, as by_species(rows, run.columns) does")
