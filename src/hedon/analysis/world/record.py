"""The worlds of some runs, one by one, each with the condition that it replicates."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import polars as pl

from hedon.analysis.world.population import extinct_step
from hedon.analysis.world.species import Kind, by_species, kinds
from hedon.config import Config, digest, flatten
from hedon.config.layout import Gene, layouts
from hedon.config.problem import format_value
from hedon.config.schema.species import ONLY, SpeciesConfig
from hedon.record.reader import Run
from hedon.text import brief

MOST_DIFFERENCES = 3
"""Maximum number of settings in the name of a condition."""
SEED = 20240717
"""Seed of the bootstrap and the neutral walks, so that the same records give the same numbers."""


@dataclass(frozen=True, eq=False)
class WorldRecord:
    """Records of one world, or of one species in it.

    Two records are equal only if they are the same object.

    Attributes:
        condition: Condition that the world replicates, shared by worlds of equal config; with the name of the species
            if there are several.
        run: Name of the run's folder.
        seed: Seed of the world.
        config: Complete config of the run.
        food_kinds, reward_names, neutral_names: Columns of the tables, in order; if there are several species, only
            those of food that this one eats and genes that it has.
        agents: Rows of the table `agents`, by agent_id.
        population: Rows of the table `population`, by step.
        last_step: End of the records [step].
        first_step: Start of the records: 0, or the step at which the run branched off another [step].
        planned_step: Last step planned for its run, or reached so far if the run is unfinished [step].
        hunts: Whether any species of its world eats agents.
        extinct_step: Step of its extinction [step]; None while any agent is alive.
        apart_step: Step at which the first of the world's other species was gone [step]; None while all of them live.
        prey: Species that it eats, possibly including its own.
        species: Name of the species; `agent` if a file names none.
    """

    condition: str
    run: str
    seed: int
    config: Config
    food_kinds: tuple[str, ...]
    reward_names: tuple[str, ...]
    neutral_names: tuple[str, ...]
    agents: pl.DataFrame
    population: pl.DataFrame
    last_step: int
    extinct_step: int | None
    apart_step: int | None = None
    prey: tuple[str, ...] = ()
    species: str = ONLY
    first_step: int = 0
    planned_step: int = 0
    hunts: bool = False

    @cached_property
    def settings(self) -> str:
        """Digest of its config, which identifies its settings."""
        return digest(self.config)

    @property
    def end_step(self) -> int:
        """End of the world's measures [step]; from its extinction to this step it counts as empty."""
        return max(self.planned_step, self.last_step)

    @property
    def born(self) -> pl.DataFrame:
        """Agents whose lives are recorded from birth, which excludes those alive when a branch started."""
        return born_since(self.agents, self.first_step)

    @property
    def species_config(self) -> SpeciesConfig:
        """Settings of its species."""
        return self.config.species[self.species]

    def gene(self, column: str) -> Gene:
        """Gene of a column."""
        return self._genes[column]

    @cached_property
    def _genes(self) -> dict[str, Gene]:
        return {gene.name: gene for gene in layouts(self.config)[self.species].genes}

    @property
    def weight_names(self) -> tuple[str, ...]:
        """All genome columns in order: those that enter the reward, then the neutral genes."""
        return (*self.reward_names, *self.neutral_names)

    def recorded_step(self) -> int:
        """Last step at which all agents are in the records [step]; 0 if there is none.

        Living agents are written only now and then, so an unfinished or killed run lacks those born since.
        """
        steps = self.population["step"].to_numpy()
        births, deaths = (np.sort(self.agents[name].drop_nulls().to_numpy()) for name in ("birth_step", "death_step"))
        alive = np.searchsorted(births, steps, "right") - np.searchsorted(deaths, steps, "right")
        return int(steps[alive == self.population["alive"].to_numpy()].max(initial=0))

    def until(self, step: int) -> "WorldRecord":
        """The world as if its records had ended earlier, except for what living agents had done by then.

        Agents that die later count as alive, with `death_step` missing. What such agents had eaten, spent or borne by
        that step was not recorded, so it is missing too.

        Args:
            step: New end [step]; if it is within an interval, that interval is lost.
        """
        planned = min(self.planned_step, step)
        if step >= self.last_step:
            return self if planned == self.planned_step else replace(self, planned_step=planned)
        is_living = pl.col("death_step").is_null() | (pl.col("death_step") > step)
        birth_columns = {"world", "seed", "species", "agent_id", "parent_id", "mate_id", "generation"}
        birth_columns |= {"birth_step", "birth_energy", *self.weight_names}
        later_columns = [name for name in self.agents.columns if name not in birth_columns]
        born = self.agents.filter(pl.col("birth_step") <= step)
        return replace(
            self,
            agents=born.with_columns(pl.when(~is_living).then(pl.col(later_columns))),
            population=self.population.filter(pl.col("step") <= step),
            last_step=step,
            extinct_step=_by(step, self.extinct_step),
            apart_step=_by(step, self.apart_step),
            planned_step=planned,
        )


def born_since(agents: pl.DataFrame, first_step: int) -> pl.DataFrame:
    """Agents whose lives are recorded from birth: all agents of a run, or those born in a branch.

    Of the agents alive before a branch started, those that died by then are not recorded; the rest would bias lives
    upward.

    Args:
        agents: Table `agents`.
        first_step: Start of the records [step].
    """
    return agents.filter(pl.col("birth_step") > first_step) if first_step else agents


def all_eaten(kind: str) -> str:
    """Column of a record's `population` with what all species of its world ate of a kind of food."""
    return f"all_eaten_{kind}"


Conditions = Mapping[str, Sequence[WorldRecord]]
"""Worlds by condition, at least one each."""


def with_roles(rows: Iterable[Mapping[str, Any]], conditions: Conditions) -> list[dict[str, Any]]:
    """Adds to rows with a condition and a weight the role of the gene, from `Gene.role`."""
    result = []
    for row in rows:
        position, items = list(row).index("weight") + 1, list(row.items())
        role = conditions[row["condition"]][0].gene(row["weight"]).role
        result.append(dict([*items[:position], ("role", role), *items[position:]]))
    return result


def read_worlds(runs: Iterable[Run]) -> list[WorldRecord]:
    """Reads the worlds of some runs; damaged parts are skipped.

    Runs with equal configs form one condition. If a seed appears twice in a condition, both are the same world, and the
    longer record is kept.

    Raises:
        RecordError, ConfigError: A run cannot be read.
    """
    longest: dict[tuple[str, int], WorldRecord] = {}
    runs = [run.load() for run in runs]
    labels = _labels(runs)
    for run in runs:
        for world in _run_worlds(run, labels[_key(run)]):
            previous = longest.get((world.condition, world.seed))
            if previous is None or previous.last_step < world.last_step:
                longest[world.condition, world.seed] = world
    return list(longest.values())


def condition_names(runs: Sequence[Run]) -> list[str]:
    """The name of each run's condition, in their order, as in a report of all of these runs."""
    labels = _labels(runs)
    return [labels[_key(run)] for run in runs]


def by_condition(worlds: Iterable[WorldRecord]) -> dict[str, list[WorldRecord]]:
    """Worlds by condition, in their order."""
    groups: dict[str, list[WorldRecord]] = {}
    for world in worlds:
        groups.setdefault(world.condition, []).append(world)
    return groups


def labels(world: WorldRecord) -> dict[str, Any]:
    """Columns that identify a world."""
    return {"condition": world.condition, "seed": world.seed}


def generator(world: WorldRecord) -> np.random.Generator:
    """Random number generator for one world, the same in each analysis."""
    return np.random.default_rng([SEED, world.seed])


def shares_noise(world: WorldRecord) -> bool:
    """Whether mutations depend on births of other species, which the record lacks: tabulated noise."""
    return len(world.config.species) > 1 and world.config.world.mutation_noise == "tabulated"


def _by(end: int, step: int | None) -> int | None:
    return None if step is None or step > end else step


def _run_worlds(run: Run, condition: str) -> list[WorldRecord]:
    config = run.config
    agents, population = run.agents(skip_damaged=True), run.population(skip_damaged=True)
    species_kinds = kinds(run.columns, config)
    if not run.columns.several:
        return _records(run, condition, config, next(iter(config.species)), agents, population, *species_kinds.values())
    eaten = [pl.col(f"eaten_{kind}").sum().over("world", "step").alias(all_eaten(kind)) for kind in run.food_kinds]
    agents_of, rows_of = by_species(agents, run.columns), by_species(population.with_columns(eaten), run.columns)
    worlds = []
    for name, kind in species_kinds.items():
        absent_genes = [gene for gene in run.weight_names if gene not in kind.genes]
        dropped = [*absent_genes, *(f"{gene}_{statistic}" for gene in absent_genes for statistic in ("mean", "sd"))]
        species_agents, rows = (table[name].drop(dropped, strict=False) for table in (agents_of, rows_of))
        worlds += _records(run, f"{condition}: {name}", config, name, species_agents, rows, kind)
    return [replace(world, apart_step=_apart(world, worlds)) for world in worlds]


def _apart(world: WorldRecord, worlds: Sequence[WorldRecord]) -> int | None:
    """Step at which the first of a world's other species was gone [step]."""
    others = [other for other in worlds if other.seed == world.seed and other is not world]
    return min((other.extinct_step for other in others if other.extinct_step is not None), default=None)


def _records(
    run: Run, condition: str, config: Config, species: str, agents: pl.DataFrame, population: pl.DataFrame, kind: Kind
) -> list[WorldRecord]:
    worlds, planned_step = [], _planned_step(run, population)
    for index, seed in enumerate(run.manifest.seeds):
        # Contiguous: sums must not depend on the chunks in which rows were written.
        world_agents = agents.filter(pl.col("world") == index).sort("agent_id").rechunk()
        rows = population.filter(pl.col("world") == index).rechunk()
        steps = [rows["step"].max(), world_agents["birth_step"].max(), world_agents["death_step"].max()]
        last_step = max((int(end) for end in steps if isinstance(end, int)), default=0)
        worlds.append(
            WorldRecord(
                condition,
                run.path.name,
                seed,
                config,
                kind.foods,
                kind.rewards,
                kind.neutral,
                world_agents,
                rows,
                last_step,
                gone_step(run, index, world_agents, rows),
                prey=kind.prey,
                species=species,
                first_step=run.manifest.parent.step if run.manifest.parent else 0,
                planned_step=planned_step,
                hunts=bool(run.columns.prey),
            )
        )
    return worlds


def _planned_step(run: Run, population: pl.DataFrame) -> int:
    """Last step planned for all worlds of a run, or reached so far if it is unfinished; at least 1 [step]."""
    manifest = run.manifest
    longest = max(manifest.steps_done, default=0)
    recorded = int(population["step"].to_numpy().max(initial=0))
    return max(manifest.steps_asked if manifest.status == "finished" else max(longest, recorded), 1)


def gone_step(run: Run, index: int, agents: pl.DataFrame, population: pl.DataFrame) -> int | None:
    """Step at which the last agent of one species of a world was gone [step]; None while any is alive."""
    manifest_step = run.manifest.extinct_steps[index] if run.manifest.extinct_steps else None
    if not run.columns.several:  # the world's end is that of its species
        return extinct_step(population) if manifest_step is None else manifest_step
    gone = extinct_step(population)
    deaths = agents["death_step"]
    if gone is None or not len(deaths) or deaths.null_count():
        return gone
    return int(deaths.to_numpy().max())  # within the interval of the rows


def _labels(runs: Sequence[Run]) -> dict[str, str]:
    """A unique short name of each condition, by `_key`: "baseline (released)", or with the settings that differ."""
    first_runs: dict[str, Run] = {}
    for run in runs:
        first_runs.setdefault(_key(run), run)
    keys_by_name: dict[str, list[str]] = {}
    for key, run in first_runs.items():
        name = run.manifest.name or run.manifest.preset or run.path.name
        keys_by_name.setdefault(f"{name} ({run.manifest.fidelity})" if run.manifest.fidelity else name, []).append(key)
    labels: dict[str, str] = {}
    for label, keys in keys_by_name.items():
        differences = _differences([first_runs[key] for key in keys]) if len(keys) > 1 else [""]
        for key, words in zip(keys, differences, strict=True):
            unique_label = (
                f"{label}: {words}" if words else f"{label}, modified" if first_runs[key].manifest.modified else label
            )
            while unique_label in labels.values():
                unique_label += f" [{first_runs[key].path.name}]"
            labels[key] = unique_label
    return labels


def _key(run: Run) -> str:
    """Key of a run's condition: the digest of its config, or its folder if there is none."""
    return run.manifest.config_digest or str(run.path)


def _differences(runs: Sequence[Run]) -> list[str]:
    """A phrase for each run with the settings that distinguish it; empty if these are too many for a name."""
    values = [flatten(run.config) for run in runs]
    paths = dict.fromkeys(path for settings in values for path in settings)
    varied = [path for path in paths if any(settings.get(path) != values[0].get(path) for settings in values)]
    if len(varied) > MOST_DIFFERENCES:
        return [""] * len(runs)
    return [", ".join(f"{path} {_formatted(settings.get(path))}" for path in varied) for settings in values]


def _formatted(value: Any) -> str:
    return "absent" if value is None else brief(format_value(value), 40)
