"""The landscape assay: founders spread over all genes, no mutation, and fitness as a surface over two genes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from hedon.analysis.world.record import WorldRecord
from hedon.assay.gene_effect import GeneEffect, flatness, gene_effects
from hedon.assay.outcome import MEASURES, founder_outcomes
from hedon.assay.resample import Floats, relative
from hedon.assay.sample import Sample
from hedon.assay.surface import Quadratic, Smooth, fit_quadratic, fit_smooth, quadratic_terms
from hedon.config.config import Config
from hedon.config.gene import limits_of
from hedon.config.layout import layouts
from hedon.error import HedonError
from hedon.record.founder import Founders, make_founders

NEUTRAL = 16
"""Number of neutral genes in an assay."""
ROWS = 2000
"""Number of genomes in the table of founders."""
_SEED = 20260801
_TAIL = 0.01  # share of the founders' genes beyond each bound of the surface


class AssayError(HedonError):
    """An assay cannot be run or read."""


@dataclass(frozen=True)
class Spread:
    """The distribution of founders over each gene: even between two bounds, or normal around 0.

    Attributes:
        low, high: The bounds.
        sd: Standard deviation; None for an even distribution.
    """

    low: float
    high: float
    sd: float | None = None

    def __str__(self) -> str:
        return f"uniform from {self.low:g} to {self.high:g}" if self.sd is None else f"normal, sd {self.sd:g}"


@dataclass(frozen=True, eq=False)
class MeasureSurface:
    """Relative fitness by one measure.

    Attributes:
        measure: One of `MEASURES`.
        mean: Mean of the absolute measure over founders.
        worlds: Number of worlds used; worlds in which the mean of the measure is 0 are not.
        flat_p: Chance that the two genes explain at least this much if genes have no effect.
        quadratic, smooth: The fitted surfaces.
        effects: Effect of each gene by itself, including neutral genes.
    """

    measure: str
    mean: float
    worlds: int
    flat_p: float
    quadratic: Quadratic
    smooth: Smooth
    effects: tuple[GeneEffect, ...]


@dataclass(frozen=True, eq=False)
class Landscape:
    """The results of a landscape assay.

    Attributes:
        steps: Length of each world [step].
        seeds: Seeds of its worlds.
        extinct: Seeds of worlds that died out.
        founders: Number of founders in each world.
        genes: The two genome columns of the surface.
        surfaces: The surfaces, by measure.
        outcomes: A row per founder: seed, agent_id, genes, measures.
    """

    steps: int
    seeds: tuple[int, ...]
    extinct: tuple[int, ...]
    founders: int
    genes: tuple[str, str]
    surfaces: Mapping[str, MeasureSurface]
    outcomes: pl.DataFrame


def assay_config(config: Config) -> Config:
    """A config without mutation and with the assay's neutral genes."""
    return without_mutation(config).with_("genome.neutral_count", NEUTRAL)


def without_mutation(config: Config) -> Config:
    """A config without mutation and without a table of founders."""
    for path, value in (("genome.mutation_scale", 0.0), ("genome.mutation", {}), ("world.founders", "")):
        config = config.with_(path, value)
    return config


def spread_founders(config: Config, spread: Spread, species: str, rows: int = ROWS) -> Founders:
    """A table of genomes of one species, spread independently over all its genes; equal arguments give equal tables.

    Genomes of other species are drawn from the config's distributions.

    Args:
        config: Config of the worlds.
        spread: The distribution of each gene.
        species: The species whose genes are spread.
        rows: Number of genomes.
    """
    prefix = f"{species}." if len(config.species) > 1 else ""
    columns = [prefix + name for name in layouts(config)[species].gene_names]
    rng = np.random.default_rng(_SEED)
    limits = np.array(list(limits_of(config, columns).values()))
    if spread.sd is None:
        values = rng.uniform(spread.low, spread.high, (rows, len(columns)))
    else:
        values = rng.normal(0.0, spread.sd, (rows, len(columns)))
    values = np.clip(values, -limits, limits)
    return make_founders(columns, values, ["spread"] * rows)


def _read_outcomes(worlds: Sequence[WorldRecord]) -> pl.DataFrame:
    """A row per founder: world (from 0), seed, agent_id, genes, measures."""
    tables = [
        founder_outcomes(world.agents, world.weight_names, world.last_step).select(
            pl.lit(i, pl.Int64).alias("world"), pl.lit(world.seed, pl.Int64).alias("seed"), pl.all()
        )
        for i, world in enumerate(worlds)
    ]
    return pl.concat(tables)


def measure_landscape(sample: Sample, genes: tuple[str, str], species: str | None = None) -> Landscape:
    """Fits the surfaces to finished worlds.

    Args:
        sample: The worlds.
        genes: Genome columns of the two genes of the surface.
        species: The species to measure; None for the only one.

    Raises:
        AssayError: All worlds died out before anything could be measured.
    """
    worlds = sample.of_species(species)
    outcomes, names = _read_outcomes(worlds), worlds[0].weight_names
    surfaces = {}
    for measure in MEASURES:
        surface = _measure(outcomes, measure, genes, names)
        if surface is not None:
            surfaces[measure] = surface
    if not surfaces:
        raise AssayError(
            f"{worlds[0].run}: nothing can be measured: no founder has living descendants, children or food"
        )
    return Landscape(
        steps=sample.steps,
        seeds=tuple(world.seed for world in worlds),
        extinct=tuple(world.seed for world in worlds if world.extinct_step is not None),
        founders=worlds[0].species_config.population.initial_count,
        genes=genes,
        surfaces=surfaces,
        outcomes=outcomes.drop("world"),
    )


def _measure(
    outcomes: pl.DataFrame, measure: str, genes: tuple[str, str], names: Sequence[str]
) -> MeasureSurface | None:
    values = outcomes[measure].to_numpy().astype(np.float64)
    fitness = relative(values, outcomes["world"].to_numpy())
    is_finite = np.isfinite(fitness)
    if not is_finite.any():
        return None
    fitness = fitness[is_finite]
    _, world = np.unique(outcomes["world"].to_numpy()[is_finite], return_inverse=True)
    z = outcomes.select(names).to_numpy().astype(np.float64)[is_finite]
    pair = z[:, [list(names).index(gene) for gene in genes]]
    rng = np.random.default_rng([_SEED, list(MEASURES).index(measure)])
    return MeasureSurface(
        measure=measure,
        mean=float(values.mean()),
        worlds=int(world.max()) + 1,
        flat_p=flatness(quadratic_terms(pair), fitness, world, rng),
        quadratic=fit_quadratic(pair, fitness, world, rng),
        smooth=fit_smooth(pair, fitness, world, _bounds(pair), rng),
        effects=tuple(gene_effects(names, z, fitness, world, rng)),
    )


def _bounds(pair: Floats) -> tuple[Floats, Floats]:
    """The bounds of the surface, beyond which there are too few founders."""
    low, high = np.quantile(pair, (_TAIL, 1.0 - _TAIL), axis=0)
    return low, high
