"""The catalogue of measures, from which summaries, tables, comparisons, claims and plots take their numbers.

A measure added here appears in all of them. Measures of genes are created for each gene.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import polars as pl

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import mean_lifetime
from hedon.analysis.gene.weight import LAST_AGENTS, end_mean, last_mean
from hedon.analysis.world.population import alive_after_extinction, last_generation, mean_alive, mean_energy, run_tail
from hedon.analysis.world.record import WorldRecord
from hedon.measure.measure import Measure
from hedon.statistic.interval import AMOUNT, SHARE

_GENES = ("w_", "neutral_")
"""Prefixes of the columns of genes."""


def _has(column: str) -> Callable[[WorldRecord], bool]:
    return lambda world: column in world.population.columns


def _hunts(world: WorldRecord) -> bool:
    return world.hunts


def _sum_of(column: str) -> Callable[[WorldRecord], int]:
    return lambda world: int(world.population[column].sum())


def _alive(world: WorldRecord) -> int:
    rows = world.population["alive"]
    return int(rows[-1]) if len(rows) else world.agents["death_step"].null_count()


def _alive_mean(world: WorldRecord) -> float | None:
    if world.extinct_step is None:
        return mean_alive(run_tail(world.population))
    return alive_after_extinction(world.population, world.end_step)


def _energy(world: WorldRecord) -> float | None:
    return mean_energy(run_tail(world.population)) if world.extinct_step is None else None


def _refused(world: WorldRecord) -> float | None:
    sums = world.population.select(pl.col("births", "births_failed_full", "births_failed_space").sum()).row(0)
    return (sums[1] + sums[2]) / sum(sums) if sum(sums) else None


MEASURES: Mapping[str, Measure] = {
    measure.name: measure
    for measure in (
        Measure("alive", "agents alive at the end", _alive, AMOUNT),
        Measure(
            "alive_mean",
            "agents alive, last tenth",
            _alive_mean,
            AMOUNT,
            "agents alive, mean over the last tenth of the steps; after extinction a world counts as empty",
            usual=True,
            averaged=True,
        ),
        Measure(
            "extinct",
            "share of worlds extinct",
            lambda world: world.extinct_step is not None,
            SHARE,
            "true if no agent is left",
            binary=True,
            usual=True,
        ),
        Measure(
            "survived",
            "steps that the world lived",
            lambda world: min(world.end_step, world.end_step if world.extinct_step is None else world.extinct_step),
            AMOUNT,
            "step at which the last agent died, or the last planned one [step]; its mean over worlds of equal length "
            "is the restricted mean of their survival",
        ),
        Measure("extinct_step", "step at which the last agent died, or null", lambda world: world.extinct_step),
        Measure("births", "children born", _sum_of("births"), AMOUNT),
        Measure("deaths", "agents that died", _sum_of("deaths"), AMOUNT),
        Measure("births_failed_full", "births that failed at capacity", _sum_of("births_failed_full"), AMOUNT),
        Measure("births_failed_space", "births that failed for lack of space", _sum_of("births_failed_space"), AMOUNT),
        Measure("refused", "share of births that failed", _refused, SHARE),
        Measure(
            "deaths_starved",
            "agents that starved",
            _sum_of("deaths_starved"),
            AMOUNT,
            condition=_has("deaths_starved"),
        ),
        Measure(
            "deaths_eaten",
            "agents that were eaten",
            _sum_of("deaths_eaten"),
            AMOUNT,
            "agents that were eaten; only if agents eat agents",
            condition=_has("deaths_eaten"),
        ),
        Measure(
            "mean_lifetime",
            "lifetime of the dead [step]",
            lambda world: mean_lifetime(world.born),
            AMOUNT,
            "mean lifetime of the dead [step]; too small if many are still alive, see `alive`",
            ratio=True,
            usual=True,
            averaged=True,
        ),
        Measure(
            "mean_lifetime_born",
            "lifetime of the dead without founders [step]",
            lambda world: mean_lifetime(world.born, born_in_run=True),
            AMOUNT,
            ratio=True,
        ),
        Measure(
            "mean_lifetime_last",
            "lifetime of the last 5000 to die [step]",
            lambda world: mean_lifetime(world.born, last=LAST_AGENTS),
            AMOUNT,
            ratio=True,
        ),
        Measure(
            "food_per_step",
            "food per step, mean over agents [1/step]",
            lambda world: food_per_step(world.agents, world.food_kinds),
            AMOUNT,
            "foods eaten / lifetime, mean over the dead [1/step]; null for species that eat no food",
            ratio=True,
            averaged=True,
        ),
        Measure(
            "food_per_agent_step",
            "food per agent and step",
            lambda world: food_per_agent_step(world.population, world.food_kinds),
            AMOUNT,
            "foods eaten by all / steps lived by all [1/step]; null for species that eat no food",
            ratio=True,
            usual=True,
            averaged=True,
        ),
        Measure(
            "prey_per_step",
            "agents eaten per step, mean over agents [1/step]",
            lambda world: food_per_step(world.agents, world.prey),
            AMOUNT,
            "agents eaten / lifetime, mean over the dead [1/step]; null for species that eat no agents",
            ratio=True,
            averaged=True,
            condition=_hunts,
        ),
        Measure(
            "prey_per_agent_step",
            "agents eaten per agent and step",
            lambda world: food_per_agent_step(world.population, world.prey),
            AMOUNT,
            "agents eaten by all / steps lived by all [1/step]; null for species that eat no agents",
            ratio=True,
            usual=True,
            averaged=True,
            condition=_hunts,
        ),
        Measure(
            "mean_energy",
            "mean energy, last tenth",
            _energy,
            AMOUNT,
            "energy of the living, mean over the last tenth of the steps; null if the world is extinct",
            usual=True,
            averaged=True,
        ),
        Measure(
            "generation",
            "mean generation at the end",
            lambda world: last_generation(world.population),
            AMOUNT,
            "mean generation of the living at the end, or of the last to live",
            averaged=True,
        ),
    )
}
"""All measures except those of genes, by name."""


def gene_mean(gene: str) -> Measure:
    """The mean of a gene over the agents alive at the end, or over the last ones alive in an extinct world."""
    title, usual = f"mean of {gene}", gene.startswith("w_")

    def of(world: WorldRecord) -> float | None:
        return end_mean(gene, world) if gene in world.weight_names else None

    return Measure(f"{gene}_mean", title, of, usual=usual)


def last_born_mean(gene: str) -> Measure:
    """The mean of a gene over the 5000 agents born last, which the paper shows."""

    def of(world: WorldRecord) -> float | None:
        return last_mean(gene, world) if gene in world.weight_names else None

    return Measure(f"{gene}_last", f"{gene}, agents born last", of)


def column_measure(column: str, titles: Mapping[str, str] | None = None) -> Measure | None:
    """The measure in a column of a table; None if the column contains something else.

    For worlds with several species, "prey.alive_mean" is a measure of the species prey, and its title includes the
    species.

    Args:
        column: Name of the column.
        titles: Titles of the measures that configs add, by name.
    """
    species, _, name = column.rpartition(".")
    match = MEASURES.get(name)
    if match is None and titles and name in titles:
        match = Measure(name, titles[name], lambda world: None, usual=True)
    if match is None and name.endswith("_mean") and name.startswith(_GENES):
        match = gene_mean(name.removesuffix("_mean"))
    if match is None or not species:
        return match
    return replace(match, name=column, title=f"{match.title}: {species}")
