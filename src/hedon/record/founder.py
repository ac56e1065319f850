"""Tables of founders: the genomes with which the worlds of a run start, and which founder gets which row.

A table has one row per genome and a column for each gene that it specifies; other genes are drawn from the config's
distributions. The column `group` distinguishes competitors, and `share` is the part of the founders from a group. The
table is stored in the run's folder as `founders.csv`, and its digest in the config, so that a run can be repeated and
checked.
"""

import csv
import hashlib
import io
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.gene import limits_of
from hedon.config.layout import gene_columns, layouts
from hedon.config.problem import nearest
from hedon.error import HedonError
from hedon.text import brief

FOUNDERS = "founders.csv"
GROUP, SHARE = "group", "share"


class FounderError(HedonError):
    """A specification of founders cannot be used."""


@dataclass(frozen=True, eq=False)
class Founders:
    """A table of genomes for founders.

    Attributes:
        genes: Genome columns that the table specifies.
        values: Genomes, shape (rows, genes), float32; NaN for a gene that is drawn from the config's distribution.
        group: Group of each row.
        share: Share of each group among the founders of a world, in the order of the table; they sum to 1.
    """

    genes: tuple[str, ...]
    values: NDArray[np.float32]
    group: tuple[str, ...]
    share: Mapping[str, float]

    @cached_property
    def content(self) -> bytes:
        """The table as CSV."""
        file = io.StringIO()
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([GROUP, SHARE, *self.genes])
        for group, row in zip(self.group, self.values, strict=True):
            cells = ["" if math.isnan(value) else str(value) for value in row]
            writer.writerow([group, repr(self.share[group]), *cells])
        return file.getvalue().encode()

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the table, 64 hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()

    def draw(self, seed: int, count: int) -> NDArray[np.int64]:
        """The row of the table that each founder of a world gets, shape (count,).

        Each group gets its share of the founders, rounded so that the sum is right. Within a group, rows are taken in
        an order that depends on the seed; if a group has fewer rows than founders, rows are repeated.

        Args:
            seed: Seed of the world.
            count: Number of founders.
        """
        quotas = {group: share * count for group, share in self.share.items()}
        number = {group: math.floor(part) for group, part in quotas.items()}
        by_remainder = sorted(quotas, key=lambda group: number[group] - quotas[group])
        for group in by_remainder[: count - sum(number.values())]:
            number[group] += 1
        rows: dict[str, list[int]] = {group: [] for group in self.share}
        for row, group in enumerate(self.group):
            rows[group].append(row)
        chosen = [np.resize(_shuffled(rows[group], f"row {seed}"), number[group]) for group in self.share]
        founders = np.concatenate(chosen).tolist()
        order = _shuffled(range(count), f"founder {seed}")
        return np.array([founders[i] for i in order], np.int64)

    def groups(self, seed: int, count: int) -> list[str]:
        """The group of each founder of a world, by agent_id.

        Args:
            seed: Seed of the world.
            count: Number of founders.
        """
        return [self.group[row] for row in self.draw(seed, count)]

    def genomes(self, seed: int, count: int, names: Sequence[str]) -> NDArray[np.float32]:
        """The genes of each founder of a world, shape (count, names); NaN for genes that the table does not specify.

        Args:
            seed: Seed of the world.
            count: Number of founders.
            names: Genome columns; further columns of the table belong to other species.
        """
        genomes = np.full((count, len(names)), np.nan, np.float32)
        rows = self.draw(seed, count)
        for i, gene in enumerate(self.genes):
            if gene in names:
                genomes[:, list(names).index(gene)] = self.values[rows, i]
        return genomes

    def of_species(self, name: str) -> "Founders":
        """The table for one species: genes that name it, as in `prey.w_action`, and genes that name no species."""
        columns = [i for i, gene in enumerate(self.genes) if "." not in gene or gene.startswith(f"{name}.")]
        genes = tuple(self.genes[i].removeprefix(f"{name}.") for i in columns)
        return replace(self, genes=genes, values=self.values[:, columns])

    def only_for(self, name: str) -> "Founders":
        """The table for one species, with the species in all names of genes, as in `prey.w_action`.

        Args:
            name: Name of the species.
        """
        founders = self.of_species(name)
        return replace(founders, genes=tuple(f"{name}.{gene}" for gene in founders.genes))

    def changed(self, gene: str, value: float) -> "Founders":
        """A copy of the table in which one gene has the same value in all rows.

        Args:
            gene: Column of the gene, which the table must have.
            value: Its value.
        """
        values = self.values.copy()
        values[:, self.genes.index(gene)] = value
        return replace(self, values=values)

    def require(self, config: Config, origin: str = "founders") -> None:
        """Checks that a config has all genes of the table, and that their values are within its limits.

        Args:
            config: Config of the worlds that the founders are for.
            origin: Name of the table in error messages.

        Raises:
            FounderError: A gene is unknown, or a value is beyond its limit.
        """
        for gene in self.genes:
            if column_of(config, gene) != gene:
                raise FounderError(f"{brief(origin)}: {unknown_gene(config, gene)}")
        limits = np.array(list(limits_of(config, self.genes).values()), np.float32)
        invalid = np.argwhere(np.abs(self.values) > limits)
        if len(invalid):
            row, column = invalid[0]
            raise FounderError(
                f"{brief(origin)}: row {row + 1}, {self.genes[column]} = {self.values[row, column]:g}: must be within "
                f"± {limits[column]:g}, the gene's limit"
            )


def make_founders(
    genes: Sequence[str], values: NDArray[np.floating], group: Sequence[str], share: Mapping[str, float] | None = None
) -> Founders:
    """Makes a table from genomes.

    Args:
        genes: Genome columns.
        values: Genomes, shape (rows, genes); NaN for a gene that is drawn from the config's distribution.
        group: Group of each row.
        share: Relative share of each group among the founders; None for shares in proportion to the groups' rows.
    """
    weights = dict(share) if share is not None else dict(Counter(group))
    total = math.fsum(weights.values())
    parts = {name: weight / total for name, weight in weights.items()}
    return Founders(tuple(genes), np.asarray(values, np.float32), tuple(group), parts)


def join(tables: Sequence[Founders], labels: Sequence[str], shares: Sequence[float]) -> Founders:
    """Joins tables into one, in which each becomes a group; genes that a table lacks are drawn from distributions.

    Args:
        tables: The tables to join.
        labels: Name of the group for each table.
        shares: Relative share of each table among the founders.
    """
    genes = tuple(dict.fromkeys(gene for table in tables for gene in table.genes))
    values, group = [], []
    for table, label in zip(tables, labels, strict=True):
        block = np.full((len(table.values), len(genes)), np.nan, np.float32)
        for i, gene in enumerate(table.genes):
            block[:, genes.index(gene)] = table.values[:, i]
        values.append(block)
        group += [label] * len(block)
    return make_founders(genes, np.concatenate(values), group, dict(zip(labels, shares, strict=True)))


def column_of(config: Config, name: str, owner: str | None = None) -> str | None:
    """The column of a gene that is given by its column, its food kind, or `action`; None if there is no such gene.

    `food` stands for the first kind, unless a kind has this name. A gene of only one species starts with the name of
    the species, as in `prey.action`.

    Args:
        config: Config that has the gene.
        name: Name of the gene.
        owner: Species to which the gene must belong; None for any.
    """
    species, dot, gene = name.rpartition(".")
    if dot:
        column = column_of(config, gene, species) if species in config.species else None
        return None if column is None else f"{species}.{column}"
    return _column_among(gene_columns(config) if owner is None else layouts(config)[owner].gene_names, name)


def _column_among(columns: Sequence[str], name: str) -> str | None:
    return next((column for column in (name, f"w_{name}") if column in columns), columns[0] if name == "food" else None)


def unknown_gene(config: Config, name: str, owner: str | None = None) -> str:
    """The error message for an unknown gene, with the existing genes and the most similar one.

    Args:
        config: Config that lacks the gene.
        name: The unknown name.
        owner: Species to which the gene should belong; None for any.
    """
    species, dot, gene = name.rpartition(".")
    prefix = f"{species}." if dot and species in config.species else ""
    owner = species if prefix else owner
    columns = gene_columns(config) if owner is None else layouts(config)[owner].gene_names
    gene_names = [column.removeprefix("w_") for column in columns if not column.startswith("neutral_")]
    count = sum(column.startswith("neutral_") for column in columns)
    neutral = f", neutral_1 to neutral_{count}" if count else ""
    suggestion = nearest(gene if prefix else name, [*columns, *gene_names, "food"])
    hint = f"; did you mean {prefix}{suggestion}?" if suggestion else ""
    holder = "there are" if owner is None or len(config.species) == 1 else f"{owner} has"
    return f"there is no gene {brief(repr(name))} ({holder} {', '.join(gene_names)}{neutral}){hint}"


def _shuffled(items: Sequence[int], purpose: str) -> list[int]:
    """Items in an order that depends only on a text, and on no version of any library."""
    return sorted(items, key=lambda item: hashlib.sha256(f"{purpose} {item}".encode()).digest())
