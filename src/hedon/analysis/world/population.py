"""The state of a world over time: numbers, births, deaths, failed births, hunger.

If there are several species, each has its own rows: every function here takes rows of one species, and raises
`ArgumentError` for rows of several.
"""

from collections.abc import Sequence

import polars as pl

from hedon.analysis.world.species import require_one_species

TAIL = 0.1  # final share of a run over which its state is averaged

_COUNTS = ("births", "deaths", "births_failed_full", "births_failed_space")


def history(
    population: pl.DataFrame,
    food_kinds: Sequence[str],
    weight_names: Sequence[str] = (),
    points: int = 200,
    end: float = 0.0,
) -> pl.DataFrame:
    """Course of each world, in at most `points` intervals of equal length.

    A run that ends within a window has a short last row in the table. Counts in it, such as one birth in 16 steps, say
    nothing about a rate, so its rates also cover the interval before.

    Args:
        population: Table `population`.
        food_kinds: Names of the food kinds.
        weight_names: Genome columns whose means to include.
        points: Maximum number of rows per world.
        end: Earliest end of the last interval, so that histories of several conditions can have the same intervals
            [step].

    Returns:
        By world and bin (index of the interval): step (its end [step]); alive, energy_mean, generation_mean and
        <weight>_mean (means over the interval); births, deaths, births_failed_full and births_failed_space per 1000
        steps; eaten_<kind> per 1000 agent steps. Values are null if no agent was alive to define them.
    """
    require_one_species(population)
    groups = population.group_by("world", _bin(population, points, end))
    means = ("alive", "energy_mean", "generation_mean", *(f"{name}_mean" for name in weight_names))
    eaten = [f"eaten_{kind}" for kind in food_kinds]
    sums = ("steps", "agent_steps", *_COUNTS, *eaten)
    rows = groups.agg(pl.col("step").max(), pl.col(means).mean(), pl.col(sums).cast(pl.Int64).sum())
    rows = rows.sort("world", "bin")
    is_part = pl.col("steps") < whole_window(population)
    previous = pl.col(sums).shift(1, fill_value=0).over("world")
    rows = rows.with_columns(pl.when(is_part).then(pl.col(sums) + previous).otherwise(pl.col(sums)))
    agent_steps = pl.when(pl.col("agent_steps") > 0).then(pl.col("agent_steps"))
    rates = (pl.col(_COUNTS) * 1000.0 / pl.col("steps"), pl.col(eaten) * 1000.0 / agent_steps)
    return rows.select("world", "bin", "step", *means, *rates)


def whole_window(population: pl.DataFrame) -> int:
    """Length of a whole window [step], which is that of the longest interval; 0 without intervals."""
    return int(population["steps"].to_numpy().max(initial=0))


def run_tail(population: pl.DataFrame) -> pl.DataFrame:
    """Rows of the last tenth of one world, which end after nine tenths of its steps."""
    if population.is_empty():
        return population
    return population.filter(pl.col("step") > (1 - TAIL) * pl.col("step").max())


def mean_alive(population: pl.DataFrame) -> float | None:
    """Mean number of agents alive over the steps of the given intervals of one world; None without intervals."""
    require_one_species(population)
    steps = int(population["steps"].sum())
    return int(population["agent_steps"].sum()) / steps if steps else None


def alive_after_extinction(population: pl.DataFrame, end: int) -> float:
    """Mean number of agents alive over the last tenth of the planned steps of an extinct world.

    Steps after its last agent count as empty, so a world that died out before that tenth has 0.

    Args:
        population: Table `population` of one extinct world, with at least one interval.
        end: Planned number of steps [step], above 0.
    """
    require_one_species(population)
    first = int(population["step"][0]) - int(population["steps"][0])  # a branch may start within the tenth
    begin = max((1 - TAIL) * end, first)
    return int(population.filter(pl.col("step") > begin)["agent_steps"].sum()) / (end - begin)


def mean_energy(population: pl.DataFrame) -> float | None:
    """Mean energy of living agents over the ends of the given intervals, weighted by the number alive.

    Returns:
        None if no agent was alive.
    """
    require_one_species(population)
    alive = int(population["alive"].sum())
    return float((population["energy_mean"] * population["alive"]).sum()) / alive if alive else None


def last_generation(population: pl.DataFrame) -> float | None:
    """Mean generation of the agents alive at the end, or when any was last alive; None if that is not recorded."""
    require_one_species(population)
    recorded = population["generation_mean"].drop_nulls()
    return float(recorded[-1]) if len(recorded) else None


def extinct_step(population: pl.DataFrame) -> int | None:
    """End of the last interval with living agents [step]; None while any is alive.

    If no agent ever lived, as in a species without founders, the step at which the rows start.
    """
    require_one_species(population)
    if population.is_empty() or population["alive"][-1]:
        return None
    inhabited = population.filter(pl.col("agent_steps") > 0)
    return int(population["step"][0] - population["steps"][0]) if inhabited.is_empty() else int(inhabited["step"][-1])


def death_rates(population: pl.DataFrame, points: int = 100) -> pl.DataFrame:
    """Death rates by cause of one species, in at most `points` intervals.

    Args:
        population: Table `population` of one species, from worlds where agents starve to death or eat agents.
        points: Maximum number of rows per world.

    Returns:
        By world and bin: step (its end [step]); age_energy, starved and eaten, deaths per 10,000 agent steps, null if
        no steps were lived.
    """
    require_one_species(population)
    if "deaths_eaten" not in population.columns:  # no agents are eaten there
        population = population.with_columns(deaths_eaten=pl.lit(0, pl.Int32))
    count_columns = ("deaths", "deaths_starved", "deaths_eaten", "agent_steps")
    rows = population.group_by("world", _bin(population, points)).agg(
        pl.col("step").max(), pl.col(count_columns).cast(pl.Int64).sum()
    )
    scale = 10_000.0 / pl.when(pl.col("agent_steps") > 0).then(pl.col("agent_steps"))
    starved, eaten = pl.col("deaths_starved"), pl.col("deaths_eaten")
    rates = {"age_energy": pl.col("deaths") - starved - eaten, "starved": starved, "eaten": eaten}
    table = rows.sort("world", "bin").with_columns((count * scale).alias(name) for name, count in rates.items())
    return table.select("world", "bin", "step", *rates)


def _bin(population: pl.DataFrame, points: int, end: float = 0.0) -> pl.Expr:
    """Index of a row's interval, of at most `points` from 0 to the end of the rows or a later one [step]."""
    width = max((max(_last_step(population), end) + 1) / points, 1.0)
    return ((pl.col("step") - 1) / width).floor().cast(pl.Int64).alias("bin")


def _last_step(population: pl.DataFrame) -> int:
    return 0 if population.is_empty() else int(population["step"].to_numpy().max())
