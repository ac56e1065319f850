"""Sources of founders: a table, the agents alive at a step of a run, a point, or a mixture of these."""

import re
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.gene import limits_of
from hedon.config.layout import gene_columns, layouts
from hedon.record.founder import FounderError, Founders, column_of, join, make_founders, unknown_gene
from hedon.record.founder_table import read_table
from hedon.record.reader import Run, open_run
from hedon.text import brief

_SHARE = re.compile(r":([0-9.eE+-]+)$")
_HELP = "give a table (.csv), RUN@STEP, the folder of a run, or a point such as food=5,action=0"


def read_founders(text: str, config: Config) -> Founders:
    """Reads founders from one source, or from several with shares.

    Args:
        text: The sources, as for `--founders`.
        config: Config of the worlds that the founders are for.

    Raises:
        FounderError: A source does not exist or cannot be used; the message gives the reason.
        RecordError: A run cannot be read.
    """
    parts = _parts(text)
    if len(parts) == 1 and parts[0][1] is None:
        return read_source(parts[0][0], config)
    shares = [share for _, share in parts if share is not None]
    if len(shares) not in (0, len(parts)):
        raise FounderError(f"--founders {brief(text)}: give every source a share, as in A:0.5,B:0.5, or none")
    labels: list[str] = []
    tables = [read_source(source, config) for source, _ in parts]
    for source, _ in parts:
        label = source_label(source)
        labels.append(label if label not in labels else f"{label} ({len(labels) + 1})")
    return join(tables, labels, shares or [1.0] * len(parts))


def read_source(text: str, config: Config) -> Founders:
    """Reads founders from one source; see `read_founders`.

    Args:
        text: The source: a CSV file, genes and their values, or a run's folder with an optional "@step".
        config: Config of the worlds that the founders are for.

    Raises:
        FounderError: The source does not exist, or does not fit the config.
        RecordError: A run cannot be read.
    """
    if text.endswith(".csv"):
        return read_table(Path(text), config)
    if "=" in text:
        return _point(text, config)
    folder, at, step = text.rpartition("@")
    if not at or Path(text).is_dir():
        return living(Path(text), None, config)
    if not step.isdecimal() or len(step) > 12:
        raise FounderError(f"founders {brief(text)!r}: {brief(step)!r} is not a step: {_HELP}")
    return living(Path(folder), int(step), config)


def living(folder: Path, step: int | None, config: Config) -> Founders:
    """The genomes of the agents alive after a step of a run, or at its end, from its table of agents.

    If the run has several species, each provides the genes of the species with the same name. Species that were extinct
    by then, or that the run lacks, are drawn from the config's distributions. Neutral genes that the config does
    not have are left out; those that the run lacks are drawn from its distributions.

    Args:
        folder: Folder of the run.
        step: Completed steps after which the agents are taken [step]; None for the end of the run.
        config: Config of the worlds that the founders are for.

    Raises:
        FounderError: No agent was alive then, the run did not get that far, or it has a gene that the config lacks.
        RecordError: The folder is not a run, or cannot be read.
    """
    if not folder.exists():
        raise FounderError(f"founders {brief(str(folder))!r}: there is no such file or folder: {_HELP}")
    run = open_run(folder)
    agents = run.agents()
    last_step = max([*run.manifest.steps_done, 0])
    if step is None:
        alive = agents.filter(pl.col("death_step").is_null())
    elif step > last_step:
        raise FounderError(f"founders {brief(str(folder))}@{step}: the run has only {last_step:,} steps")
    else:
        died_later = pl.col("death_step").is_null() | (pl.col("death_step") > step)
        alive = agents.filter((pl.col("birth_step") <= step) & died_later)
    if alive.is_empty():
        raise FounderError(
            f"founders {brief(str(folder))}: no agent is alive at step {last_step if step is None else step:,}"
        )
    label = folder.resolve().name if step is None else f"{folder.resolve().name}@{step}"
    alive = alive.sort("world", "agent_id")
    genes, values = _by_species(alive, run, config) if run.columns.several else _genomes(alive, run, config)
    founders = make_founders(genes, values, [label] * len(values))
    founders.require(config, f"founders {folder}")
    return founders


def _genomes(alive: pl.DataFrame, run: Run, config: Config) -> tuple[list[str], NDArray[np.float64]]:
    """The columns and genes of a run's agents, without neutral genes that the config does not have."""
    for gene in run.reward_names:
        if column_of(config, gene) != gene:
            raise FounderError(f"founders {brief(str(run.path))!r}: {unknown_gene(config, gene)}")
    columns = gene_columns(config)
    genes = [*run.reward_names, *(name for name in run.neutral_names if name in columns)]
    return genes, alive.select(genes).to_numpy()


def _by_species(alive: pl.DataFrame, run: Run, config: Config) -> tuple[list[str], NDArray[np.float64]]:
    """The columns and genes of the species in both the run and the config; each row has one agent of each species."""
    shared = [name for name in run.columns.species if name in config.species]
    if not shared:
        known = f"{', '.join(config.species)} here"
        run_species = ", ".join(run.columns.species)
        raise FounderError(f"founders {brief(str(run.path))!r}: its species ({run_species}) have other names ({known})")
    species_layouts, columns = layouts(config), {}
    for name in shared:
        members = alive.filter(pl.col("species") == name)
        for gene in (*run.reward_names, *run.neutral_names):
            known = members[gene].drop_nulls()
            if gene in species_layouts[name].gene_names and len(known):
                columns[f"{name}.{gene}"] = known.to_numpy()
            elif gene in run.reward_names and len(known):
                raise FounderError(f"founders {brief(str(run.path))!r}: {unknown_gene(config, f'{name}.{gene}')}")
    rows = max(map(len, columns.values()), default=0)
    return list(columns), np.stack([np.resize(values, rows) for values in columns.values()], axis=1)


def source_label(text: str) -> str:
    """The name of a source's group: the source without its parent folders."""
    return text if "=" in text else Path(text).name or text


def parse_point(text: str, config: Config) -> dict[str, float]:
    """Parses genes and their values from a text such as "food=5,action=0".

    Args:
        text: Genes with their values.
        config: Config that has the genes.

    Returns:
        The values by genome column.

    Raises:
        FounderError: A gene is unknown or given twice, or a value is not allowed.
    """
    point: dict[str, float] = {}
    for item in text.split(","):
        name, _, number = (part.strip() for part in item.partition("="))
        column = column_of(config, name)
        if column is None:
            raise FounderError(f"{brief(text)}: {unknown_gene(config, name)}")
        limit = limits_of(config, [column])[column]
        try:
            value = float(number)
        except ValueError:
            value = float("nan")
        if not abs(value) <= limit or column in point:
            assignment = f"{brief(name)} = {brief(number)}"
            raise FounderError(f"{brief(text)}: {assignment}: must be one number from {-limit:g} to {limit:g}")
        point[column] = value
    return point


def _point(text: str, config: Config) -> Founders:
    point = parse_point(text, config)
    values = np.array([list(point.values())], np.float32)
    return make_founders(tuple(point), values, [source_label(text)])


def _parts(text: str) -> list[tuple[str, float | None]]:
    """Sources with their shares. Commas separate sources, and also the genes of a point."""
    sources: list[tuple[str, float | None]] = []
    for item in map(str.strip, text.split(",")):
        share = _SHARE.search(item)
        source = item[: share.start()] if share else item
        if not source or (share and not _is_positive(share[1])):
            raise FounderError(
                f"--founders {brief(text)!r}: {brief(item)!r} is no source with a share above 0: {_HELP}"
            )
        is_gene = "=" in source and not source.endswith(".csv")
        if is_gene and sources and sources[-1][1] is None and "=" in sources[-1][0]:
            source = f"{sources.pop()[0]},{source}"
        sources.append((source, float(share[1]) if share else None))
    return sources


def _is_positive(text: str) -> bool:
    try:
        return 0 < float(text) <= 1e9
    except ValueError:
        return False
