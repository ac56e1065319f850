"""Tables of founders: whose genes the worlds of a run begin with, and which founder gets which row.

A table has one row per genome and a column for each gene that it gives; other genes are drawn from the config's laws.
The column `group` tells competitors apart, and `share` is the part of the founders that comes from a group. The run's
folder holds the table as `founders.csv`, and the config its digest, so that a run can be repeated and checked.
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
    """Founders that cannot be used."""


@dataclass(frozen=True, eq=False)
class Founders:
    """Genomes to begin with.

    Attributes:
        genes: columns of the genome that the table gives.
        values: (rows, genes) float32; NaN where a gene is drawn from the config's law.
        group: of each row.
        share: of each group among the founders of a world; they sum to 1. The groups are in the order of the table.
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
        """Which row each founder of a world gets, (count,).

        Each group gets its share of the founders, rounded so that the sum is right. Within a group rows are taken in an
        order that depends on the seed; a group with fewer rows than founders gives each row several times.

        Args:
            seed: of the world.
            count: of founders.
        """
        exact = {group: share * count for group, share in self.share.items()}
        number = {group: math.floor(part) for group, part in exact.items()}
        left = sorted(exact, key=lambda group: number[group] - exact[group])
        for group in left[: count - sum(number.values())]:
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
            seed: of the world.
            count: of founders.
        """
        return [self.group[row] for row in self.draw(seed, count)]

    def genomes(self, seed: int, count: int, names: Sequence[str]) -> NDArray[np.float32]:
        """The genes of each founder of a world, (count, names); NaN where a gene is not given.

        Args:
            seed: of the world.
            count: founders.
            names: the genome's columns; what the table gives beside them is for another species.
        """
        found = np.full((count, len(names)), np.nan, np.float32)
        rows = self.draw(seed, count)
        for i, gene in enumerate(self.genes):
            if gene in names:
                found[:, list(names).index(gene)] = self.values[rows, i]
        return found

    def of_species(self, name: str) -> "Founders":
        """The genes for one species: those that name it, as in `prey.w_action`, and those that name none."""
        mine = [i for i, gene in enumerate(self.genes) if "." not in gene or gene.startswith(f"{name}.")]
        genes = tuple(self.genes[i].removeprefix(f"{name}.") for i in mine)
        return replace(self, genes=genes, values=self.values[:, mine])

    def only_for(self, name: str) -> "Founders":
        """The genes for one species, each of which names it, as in `prey.w_action`.

        Args:
            name: of the species.
        """
        mine = self.of_species(name)
        return replace(mine, genes=tuple(f"{name}.{gene}" for gene in mine.genes))

    def changed(self, gene: str, value: float) -> "Founders":
        """The same table with one gene, which it must have, at one value.

        Args:
            gene: its column.
            value: for all rows.
        """
        values = self.values.copy()
        values[:, self.genes.index(gene)] = value
        return replace(self, values=values)

    def require(self, config: Config, origin: str = "founders") -> None:
        """Checks that the genes are those of a config, and within its limit.

        Args:
            config: that the founders are for.
            origin: what errors call the table.

        Raises:
            FounderError: One is not.
        """
        for gene in self.genes:
            if column_of(config, gene) != gene:
                raise FounderError(f"{brief(origin)}: {unknown_gene(config, gene)}")
        limits = np.array(list(limits_of(config, self.genes).values()), np.float32)
        wrong = np.argwhere(np.abs(self.values) > limits)
        if len(wrong):
            row, column = wrong[0]
            raise FounderError(
                f"{brief(origin)}: row {row + 1}, {self.genes[column]} = {self.values[row, column]:g}: must be within "
                f"± {limits[column]:g}, the gene's limit"
            )


def make_founders(
    genes: Sequence[str], values: NDArray[np.floating], group: Sequence[str], share: Mapping[str, float] | None = None
) -> Founders:
    """Makes a table from genomes.

    Args:
        genes: columns.
        values: genomes, (rows, genes); NaN for a gene that is drawn from the config's law.
        group: of each row.
        share: of each group among the founders; None for shares by the groups' rows.
    """
    weights = dict(share) if share is not None else dict(Counter(group))
    total = math.fsum(weights.values())
    parts = {name: weight / total for name, weight in weights.items()}
    return Founders(tuple(genes), np.asarray(values, np.float32), tuple(group), parts)


def join(tables: Sequence[Founders], labels: Sequence[str], shares: Sequence[float]) -> Founders:
    """One table from several, each of which becomes one group; a gene that one lacks is drawn from the config's law."""
    genes = tuple(dict.fromkeys(gene for table in tables for gene in table.genes))
    values, group = [], []
    for table, label in zip(tables, labels, strict=True):
        block = np.full((len(table.values), len(genes)), np.nan, np.float32)
        for i, gene in enumerate(table.genes):
            block[:, genes.index(gene)] = table.values[:, i]
        values.append(block)
        group += [label] * len(block)
    return make_founders(genes, np.concatenate(values), group, dict(zip(labels, shares, strict=True)))


def column_of(config: Config, name: str, own: str | None = None) -> str | None:
    """The column of a gene that is named by its column, its kind of food, or `action`; None if there is no such gene.

    `food` is the first kind, unless a kind has this name. A gene of only one species begins with the name of the
    species, as in `prey.action`.
    """
    species, dot, gene = name.rpartition(".")
    if dot:
        column = column_of(config, gene, species) if species in config.species else None
        return None if column is None else f"{species}.{column}"
    return _column_among(gene_columns(config) if own is None else layouts(config)[own].gene_names, name)


def _column_among(columns: Sequence[str], name: str) -> str | None:
    return next((column for column in (name, f"w_{name}") if column in columns), columns[0] if name == "food" else None)


def unknown_gene(config: Config, name: str, own: str | None = None) -> str:
    """Says that there is no such gene, which there are, and which is near."""
    species, dot, gene = name.rpartition(".")
    begin = f"{species}." if dot and species in config.species else ""
    own = species if begin else own
    columns = gene_columns(config) if own is None else layouts(config)[own].gene_names
    shown = [column.removeprefix("w_") for column in columns if not column.startswith("neutral_")]
    count = sum(column.startswith("neutral_") for column in columns)
    neutral = f", neutral_1 to neutral_{count}" if count else ""
    near = nearest(gene if begin else name, [*columns, *shown, "food"])
    hint = f"; did you mean {begin}{near}?" if near else ""
    whose = "there are" if own is None or len(config.species) == 1 else f"{own} has"
    return f"there is no gene {brief(repr(name))} ({whose} {', '.join(shown)}{neutral}){hint}"


def _shuffled(items: Sequence[int], what: str) -> list[int]:
    """Items in an order that depends on a text alone, the same with every version of every library."""
    return sorted(items, key=lambda item: hashlib.sha256(f"{what} {item}".encode()).digest())
