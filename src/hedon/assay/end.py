"""The end points of evolution: mean weights of the worlds of some runs, for drawing on a landscape."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import polars as pl

from hedon.analysis.gene.weight import last_living, weight_spreads
from hedon.analysis.world.species import by_species
from hedon.assay.landscape import AssayError
from hedon.config.config import Config
from hedon.record.founder_source import parse_point
from hedon.record.reader import open_run
from hedon.study.catalogue import reported_figures
from hedon.text import brief


@dataclass(frozen=True)
class End:
    """The mean weights of one world at its end.

    Attributes:
        source: The file or run, and the seed of the world.
        weights: Mean weights by genome column.
        reported: Whether it is reported by a study's source instead of measured in a run.
    """

    source: str
    weights: Mapping[str, float]
    reported: bool = False


def read_ends(path: Path, config: Config, species: str) -> list[End]:
    """Reads the ends of worlds from a run's folder, its `summary.json`, or a `study.json`.

    From studies with several conditions, only rows of the config's own condition are used, if there are any.

    Raises:
        AssayError: There are no ends, or the file cannot be read.
        RecordError: A run cannot be read.
    """
    name = brief(str(path))
    if path.is_dir():
        ends = _run_ends(path, species, name)
    else:
        try:
            content = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise AssayError(f"--ends {name}: cannot be read: {error}") from None
        if not isinstance(content, dict):
            raise AssayError(f"--ends {name}: is neither a summary.json nor a study.json")
        ends = _summary_ends(content, path, species) if "worlds" in content and "tables" not in content else []
        ends = ends or _study_ends(content, path, config)
    if not ends:
        raise AssayError(f"--ends {name}: has no mean weights of a world")
    return ends


def _run_ends(path: Path, species: str, name: str) -> list[End]:
    run = open_run(path)
    run_species = species if run.columns.several else run.columns.species[0]
    agents, rows = (by_species(table, run.columns).get(run_species) for table in (run.agents(), run.population()))
    if agents is None or rows is None:
        available = ", ".join(run.columns.species)
        raise AssayError(f"--ends {name}: the run has no species {species} (there are {available})")
    genes = [gene for gene in run.reward_names if agents[gene].is_not_null().any()]
    ends = []
    for world, seed in enumerate(run.manifest.seeds):
        living = last_living(*(table.filter(pl.col("world") == world) for table in (agents, rows)))
        means = {gene: spread["mean"] for gene, spread in weight_spreads(living, genes).items()}
        if living.height:
            ends.append(End(f"{path.name}, seed {seed}", {gene: mean or 0.0 for gene, mean in means.items()}))
    return ends


def _summary_ends(content: Mapping[str, Any], path: Path, species: str) -> list[End]:
    ends = []
    for entry in content["worlds"]:
        world = entry.get("species", {}).get(species, {}) | {"seed": entry["seed"]} if "species" in entry else entry
        weights = {gene: spread.get("mean") for gene, spread in world.get("weights", {}).items()}
        if weights and all(isinstance(mean, float) for mean in weights.values()):
            ends.append(End(f"{path.parent.name}, seed {world['seed']}", weights))
    return ends


def _study_ends(content: Mapping[str, Any], path: Path, config: Config) -> list[End]:
    """Reads tables with a row per world and weight (`drift_world`), or else tables with a row per world."""
    tables = content.get("tables", {})
    rows = [row for table in tables.values() for row in table.get("rows", [])]
    points: dict[tuple[str, int], dict[str, float]] = {}
    weight_rows = [row for row in rows if {"weight", "mean", "seed", "score"} <= row.keys()]
    world_rows = [row for row in rows if {"w_food", "w_action", "seed"} <= row.keys()]
    kinds = list(config.food)
    for row in _own(weight_rows, config) or _own(world_rows, config):
        point = points.setdefault((_condition(row), row["seed"]), {})
        if "weight" in row:
            point[row["weight"]] = row["mean"]
        else:
            point |= {f"w_{kinds[0]}": row["w_food"], "w_action": row["w_action"]}
    recorded = ((key, {gene: value for gene, value in point.items() if _known(value)}) for key, point in points.items())
    return [End(f"{path.parent.name}, {arm}, seed {seed}", point) for (arm, seed), point in recorded if point]


def _own(rows: Sequence[dict[str, Any]], config: Config) -> Sequence[dict[str, Any]]:
    matching = [row for row in rows if _condition(row).split(" ")[0] in (config.name, config.preset)]
    return matching or rows


def _known(value: Any) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def reported_ends(config: Config) -> list[End]:
    """The ends that the sources of studies report for a config's preset, in the genes of the config."""
    return [
        End(f"{name}: {text}", parse_point(text, config), reported=True)
        for name, source in reported_figures(config.preset).items()
        for text in source.get("ends", ())
    ]


def _condition(row: Mapping[str, Any]) -> str:
    return str(row.get("condition", ""))


def on_surface(ends: Iterable[End], genes: Sequence[str]) -> list[tuple[End, tuple[float, float]]]:
    """The ends that have both genes of a surface, with their points."""
    return [(end, (end.weights[genes[0]], end.weights[genes[1]])) for end in ends if set(genes) <= end.weights.keys()]
