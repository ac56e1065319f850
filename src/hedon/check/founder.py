"""Checks the founders of a run against the table from which they should come."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import polars as pl

from hedon.check.finding import Finding
from hedon.config.config import Config
from hedon.config.layout import layouts
from hedon.record.founder import FOUNDERS, FounderError
from hedon.record.founder_table import load_founders
from hedon.record.manifest import Manifest


def check_founders(
    folder: Path, config: Config | None, manifest: Manifest | None, agents: pl.DataFrame | None
) -> Iterator[Finding]:
    """Checks the table of founders, and the founders among the agents.

    Args:
        folder: Folder of the run.
        config: Config of the run; None if it cannot be read.
        manifest: Manifest of the run; None if it cannot be read.
        agents: Rows of the table `agents`; None if they are incomplete.
    """
    if config is None:
        return
    try:
        founders = load_founders(folder, config)
    except FounderError as error:
        yield Finding(FOUNDERS, f"cannot be used: {str(error).removeprefix(str(folder / FOUNDERS) + ': ')}")
        return
    if founders is None or manifest is None or agents is None:
        return
    first_id, layouts_by_species = 0, layouts(config)
    for name, species in config.species.items():  # IDs of founders follow the order of species
        count, genes = species.population.initial_count, layouts_by_species[name].gene_names
        is_founder = pl.col("agent_id").is_between(first_id, first_id + count - 1) & (pl.col("generation") == 0)
        for world, seed in enumerate(manifest.seeds):
            founder_rows = agents.filter(is_founder & (pl.col("world") == world))
            ids = founder_rows["agent_id"].to_numpy()
            expected = founders.of_species(name).genomes(seed, count, genes)[ids - first_id]
            differs = (~np.isnan(expected) & (expected != founder_rows.select(genes).to_numpy())).any(axis=1)
            if differs.any():
                message = f"world {world}: the genes of {differs.sum():,} founders are not those of {FOUNDERS}"
                yield Finding("agents", f"{message}, the first is agent {ids[differs][0]}")
        first_id += count
