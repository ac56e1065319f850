"""The measures of a world: the catalogue, and those that its config adds with `[measure.NAME]`."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from typing import Any

import polars as pl
from polars.exceptions import ColumnNotFoundError, PolarsError

from hedon.analysis.world.record import WorldRecord
from hedon.config.config import Config
from hedon.config.problem import ConfigError, Problem, format_value, nearest
from hedon.config.schema.measure import MeasureConfig
from hedon.measure.catalogue import MEASURES, gene_mean
from hedon.measure.measure import Measure
from hedon.measure.summary_key import RESERVED
from hedon.record.schema import Columns, columns_of, run_tables


def measures_of(config: Config) -> Mapping[str, Measure]:
    """All measures of the worlds of a config, except those of genes: hedon's first, then the config's own.

    Raises:
        ConfigError: An expression is invalid, or a name is taken; the error lists all problems.
    """
    return {**MEASURES, **own_measures(config)} if config.measure else MEASURES


def own_measures(config: Config) -> dict[str, Measure]:
    """The measures that a config adds, by name. Raises the same errors as `measures_of`."""
    columns, measures, problems = columns_of(config), {}, []
    for name, definition in config.measure.items():
        problem = _name_problem(name, columns) or _expression_problem(name, definition, columns)
        if problem is None:
            measures[name] = _measure(name, definition)
        else:
            problems.append(problem)
    if problems:
        raise ConfigError(config.name, problems)
    return measures


def titles_of(configs: Iterable[Config]) -> dict[str, str]:
    """The titles of the measures that these configs add, by name."""
    return {name: definition.title or name for config in configs for name, definition in config.measure.items()}


def own_measure(name: str) -> Measure:
    """A config's own measure by its name, for claims; a world whose config lacks it has no value."""

    def of(world: WorldRecord) -> float | None:
        definition = world.config.measure.get(name)
        return None if definition is None else _value(definition, world)

    return Measure(name, name, of)


def _measure(name: str, definition: MeasureConfig) -> Measure:
    return Measure(name, definition.title or name, lambda world: _value(definition, world), usual=True, averaged=True)


def _value(definition: MeasureConfig, world: WorldRecord) -> float | None:
    table = world.population if definition.table == "population" else world.agents
    try:
        value = table.select(_expression(definition.of)).item()
    except PolarsError:  # this species lacks a column that other species have
        return None
    return None if value is None or not math.isfinite(value) else float(value)


@cache
def _expression(text: str) -> pl.Expr:
    return pl.sql_expr(text).alias("value")


def _name_problem(name: str, columns: Columns) -> Problem | None:
    if not re.fullmatch(r"[a-z][a-z0-9_]{0,39}", name):
        rule = "must have from 1 to 40 lower-case letters, digits and underscores, and begin with a letter"
        return Problem(f"measure.{name}", rule)
    genes = name.startswith(("w_", "neutral_", "g_")) or name in (*columns.species, *columns.food_kinds)
    if name in MEASURES or name in RESERVED or genes:
        return Problem(f"measure.{name}", "is the name of something that summaries have already: choose another one")
    return None


def _expression_problem(name: str, definition: MeasureConfig, columns: Columns) -> Problem | None:
    """The problem with an expression, if any, found by evaluating it on an empty table of a run."""
    place, value = f"measure.{name}.of", format_value(definition.of)
    schema = run_tables(columns)[definition.table].polars_schema
    if not definition.of.strip():
        return Problem(place, 'must be an expression, as in "sum(births) / sum(agent_steps)"', value)
    try:
        result = pl.DataFrame(schema=schema).select(_expression(definition.of))
    except ColumnNotFoundError as error:
        column = next(iter(re.findall(r'"([^"]+)"', str(error))), "")
        rule = f"the table {definition.table} has no column {column} (docs/records.md lists them)"
        return Problem(place, rule, value, nearest(column, list(schema)))
    except PolarsError as error:
        return Problem(place, f"cannot be computed: {str(error).partition(chr(10))[0][:200]}", value)
    if result.height != 1:
        return Problem(place, "must give one number for all rows: use aggregates such as sum, avg, min or max", value)
    kind = result.dtypes[0]
    return None if kind.is_numeric() or kind == pl.Boolean else Problem(place, f"must give a number, not {kind}", value)


def world_row(records: Sequence[WorldRecord]) -> dict[str, Any]:
    """Every measure of one world, as a row of a table of worlds.

    Args:
        records: The records of the world, one per species.

    Returns:
        The seed, whether the world is extinct, and each measure under its name. With several species, names of
        measures start with the species, as in "prey.alive_mean", and a world is extinct if all species are.
    """
    row: dict[str, Any] = {"seed": records[0].seed, "extinct": all(each.extinct_step is not None for each in records)}
    for record in records:
        prefix = f"{record.species}." if len(records) > 1 else ""
        measures = [each for each in measures_of(record.config).values() if each.applies(record)]
        measures += map(gene_mean, record.weight_names)
        row |= {f"{prefix}{measure.name}": measure.of(record) for measure in measures}
    return row
