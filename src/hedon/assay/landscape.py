"""The landscape assay: founders spread over the genes, no mutation, and fitness as a surface over two of them."""

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
"""Neutral genes of an assay: genes that are known to do nothing."""
ROWS = 2000
"""Genomes in the table that founders are taken from."""
_SEED = 20260801
_TAIL = 0.01  # of the founders' genes that lies beyond each bound of the surface


class AssayError(HedonError):
    """An assay that cannot be made or read."""


@dataclass(frozen=True)
class Spread:
    """How founders are spread over each gene: evenly between two bounds, or normally around 0.

    Attributes:
        low, high: bounds.
        sd: standard deviation; None for an even spread.
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
        measure: one of `MEASURES`.
        mean: of the measure over founders, before it is made relative.
        worlds: that enter; a world in which the measure's mean is 0 does not.
        flat_p: chance that two genes explain this much or more if genes do nothing.
        quadratic, smooth: the surfaces.
        effects: of each gene by itself, neutral genes too.
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
    """What a landscape assay found.

    Attributes:
        steps: of each world [step].
        seeds: of its worlds.
        extinct: seeds of worlds that died out.
        founders: of each world.
        genes: the two columns of the surface.
        surfaces: by measure.
        outcomes: a row per founder: seed, agent_id, genes, measures.
    """

    steps: int
    seeds: tuple[int, ...]
    extinct: tuple[int, ...]
    founders: int
    genes: tuple[str, str]
    surfaces: Mapping[str, MeasureSurface]
    outcomes: pl.DataFrame


def assay_config(config: Config) -> Config:
    """The condition without mutation, and with the assay's neutral genes."""
    return without_mutation(config).with_("genome.neutral_count", NEUTRAL)


def without_mutation(config: Config) -> Config:
    """A config without mutation, whose founders are not those of another run."""
    for path, value in (("genome.mutation_scale", 0.0), ("genome.mutation", {}), ("world.founders", "")):
        config = config.with_(path, value)
    return config


def spread_founders(config: Config, spread: Spread, species: str, rows: int = ROWS) -> Founders:
    """A table of genomes of one species spread over all its genes, independently; the same for the same arguments.

    Those of the other species are drawn from the laws in the config.
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
    """A row per founder: world (from 0 on), seed, agent_id, genes, measures."""
    tables = [
        founder_outcomes(world.agents, world.weight_names, world.last_step).select(
            pl.lit(i, pl.Int64).alias("world"), pl.lit(world.seed, pl.Int64).alias("seed"), pl.all()
        )
        for i, world in enumerate(worlds)
    ]
    return pl.concat(tables)


def measure_landscape(sample: Sample, genes: tuple[str, str], species: str | None = None) -> Landscape:
    """Fits the surfaces to finished worlds.

    Raises:
        AssayError: all worlds died out before anything could be measured.
    """
    worlds = sample.of_species(species)
    outcomes, names = _read_outcomes(worlds), worlds[0].weight_names
    surfaces = {}
    for measure in MEASURES:
        found = _measure(outcomes, measure, genes, names)
        if found is not None:
            surfaces[measure] = found
    if not surfaces:
        raise AssayError(
            f"{worlds[0].run}: nothing can be measured: no founder has living descendants, children or food"
        )
    return Landscape(
        steps=sample.steps,
        seeds=tuple(world.seed for world in worlds),
        extinct=tuple(world.seed for world in worlds if world.extinct_step is not None),
        founders=worlds[0].own.population.initial_count,
        genes=genes,
        surfaces=surfaces,
        outcomes=outcomes.drop("world"),
    )


def _measure(
    outcomes: pl.DataFrame, measure: str, genes: tuple[str, str], names: Sequence[str]
) -> MeasureSurface | None:
    values = outcomes[measure].to_numpy().astype(np.float64)
    fitness = relative(values, outcomes["world"].to_numpy())
    known = np.isfinite(fitness)
    if not known.any():
        return None
    fitness = fitness[known]
    _, world = np.unique(outcomes["world"].to_numpy()[known], return_inverse=True)
    z = outcomes.select(names).to_numpy().astype(np.float64)[known]
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
    """Within which the surface is told: beyond are too few founders."""
    low, high = np.quantile(pair, (_TAIL, 1.0 - _TAIL), axis=0)
    return low, high
