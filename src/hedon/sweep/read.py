"""Reads the file of a sweep and reports all of its problems."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hedon.config.load import DEFAULT_PRESET, FIDELITIES
from hedon.config.problem import ConfigError, Problem, format_value, nearest
from hedon.config.toml import read_toml
from hedon.ensemble.plan import SweepFile, SweepPlan, rounds_of
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_STEPS, MAX_WORLDS, different, integer, parse_seeds, seed_list
from hedon.sweep.condition import Loader, make_conditions
from hedon.sweep.design import DRAWS, Design, all_settings
from hedon.sweep.factor import FIDELITY, PRESET, Factor, read_factor

KEYS = ("base", "fidelity", "steps", "seeds", "worlds", "keep", "set", "factor", "design")
DESIGN = ("draw", "points", "seed", "zip")
KEEP = ("agents", "population", "run")
"""Records that a sweep may keep in addition to its table: tables of each batch, or its whole run folder."""
MOST_CONDITIONS = 100_000
WORLDS = 4
"""Default number of worlds in a batch."""


def read_sweep(path: Path | str, *, skip_invalid: bool = False) -> SweepFile:
    """Reads and checks the file of a sweep, and the config of every condition.

    Args:
        path: Path of the file.
        skip_invalid: Whether to leave out conditions with an invalid config instead of raising an error.

    Raises:
        ConfigError: The file cannot be read or is invalid; the error lists all problems of the file, or those of all
            invalid conditions.
    """
    path = Path(path)
    tables, origin = read_toml(path), str(path)
    problems = [
        Problem(key, f"is not a part of a sweep ({', '.join(KEYS)})", nearest=nearest(key, KEYS))
        for key in tables
        if key not in KEYS
    ]
    parsed = [read_factor(name, value) for name, value in _flat(_table(tables, "factor", problems), keep_factors=True)]
    factors = tuple(each for each in parsed if isinstance(each, Factor))
    problems += [each for each in parsed if isinstance(each, Problem)]
    design = _design(_table(tables, "design", problems), factors, problems)
    steps = _whole(tables, "steps", 1, MAX_STEPS, problems)
    worlds = _whole(tables, "worlds", 1, MAX_WORLDS, problems, WORLDS)
    seeds = _seeds(tables.get("seeds", 1), problems)
    keep = _keep(tables.get("keep", []), problems)
    fixed = list(_flat(_table(tables, "set", problems)))
    problems += [
        Problem(f"set.{name}", "is a factor too: leave one of them out")
        for name, _ in fixed
        if any(factor.name == name for factor in factors)
    ]
    base = _base(tables, factors, problems)
    if problems:
        raise ConfigError(origin, problems)
    settings = all_settings(factors, design)
    if len(settings) > MOST_CONDITIONS:
        problem = Problem("factor", f"gives {len(settings):,} settings: at most {MOST_CONDITIONS:,} are allowed")
        raise ConfigError(origin, [problem])
    conditions = make_conditions(Loader(path, base, tables.get("fidelity"), fixed), settings)
    if conditions.invalid and not (skip_invalid and conditions.found):
        raise _refusal(origin, conditions.invalid, len(settings))
    plan = SweepPlan(
        name=path.stem,
        steps=steps,
        seeds=seeds,
        rounds=rounds_of(seeds, worlds),
        keep=keep,
        order_seed=design.seed,
        factors=tuple(factor.name for factor in factors),
        ranged=tuple(factor.name for factor in factors if factor.drawn),
        places={name: each.places for name, each in conditions.bases.items()},
        conditions=conditions.found,
    )
    return SweepFile(plan, conditions.bases, worlds, tuple(map(str, conditions.invalid)))


def _refusal(origin: str, invalid: Sequence[ConfigError], count: int) -> ConfigError:
    """The error for invalid conditions; if there is only one, its own error."""
    if len(invalid) == 1 == count:
        return invalid[0]
    if len(invalid) == count and all(fault.problems == invalid[0].problems for fault in invalid):
        return ConfigError(origin, invalid[0].problems)  # for example a misspelled name, whatever the values
    problems = [Problem("", str(error).removeprefix(f"{origin}, ")) for error in invalid]
    message = f"{len(invalid):,} of {count:,} settings cannot be; --skip-invalid leaves them out"
    return ConfigError(origin, [Problem("factor", message), *problems])


def _table(tables: dict[str, Any], key: str, problems: list[Problem]) -> dict[str, Any]:
    table = tables.get(key, {})
    if isinstance(table, dict):
        return table
    problems.append(Problem(key, "must be a table", format_value(table)))
    return {}


def _flat(table: dict[str, Any], prefix: str = "", *, keep_factors: bool = False) -> Iterator[tuple[str, Any]]:
    """Values by path, for quoted paths and nested tables alike; `keep_factors` leaves tables that are factors whole."""
    for name, value in table.items():
        path = f"{prefix}.{name}" if prefix else name
        if isinstance(value, dict) and not (keep_factors and {"values", "range", "log", "count"} & set(value)):
            yield from _flat(value, path, keep_factors=keep_factors)
        else:
            yield path, value


def _base(tables: dict[str, Any], factors: Sequence[Factor], problems: list[Problem]) -> str:
    base, fidelity = tables.get("base", DEFAULT_PRESET), tables.get("fidelity")
    if not isinstance(base, str) or not base:
        problems.append(Problem("base", "must be the name of a preset, or of a file (.toml)", format_value(base)))
    if fidelity is not None and fidelity not in FIDELITIES:
        suggestion = nearest(fidelity, FIDELITIES) if isinstance(fidelity, str) else None
        message = f"must be one of {', '.join(FIDELITIES)}"
        problems.append(Problem("fidelity", message, format_value(fidelity), suggestion))
    for name, key in ((PRESET, "base"), (FIDELITY, "fidelity")):
        if key in tables and any(factor.name == name for factor in factors):
            problems.append(Problem(key, f"cannot be set beside the factor {name}, which chooses it: leave one out"))
    return base


def _design(table: dict[str, Any], factors: Sequence[Factor], problems: list[Problem]) -> Design:
    for key in table:
        if key not in DESIGN:
            message = f"is not a part of a design ({', '.join(DESIGN)})"
            problems.append(Problem(f"design.{key}", message, nearest=nearest(key, DESIGN)))
    draw = table.get("draw", DRAWS[-1])
    if draw not in DRAWS:
        suggestion = nearest(draw, DRAWS) if isinstance(draw, str) else None
        problems.append(Problem("design.draw", f"must be one of {', '.join(DRAWS)}", format_value(draw), suggestion))
    drawn_names = [factor.name for factor in factors if factor.drawn]
    if drawn_names and "points" not in table:
        problems.append(Problem("design.points", f"is missing: how many values to draw for {', '.join(drawn_names)}"))
    elif not drawn_names and "points" in table:
        problems.append(Problem("design.points", "has nothing to draw: every factor has its values"))
    points = _whole(table, "points", 1, MOST_CONDITIONS, problems, 1, "design.") if drawn_names else 0
    seed = _whole(table, "seed", 0, 2**32 - 1, problems, 1, "design.")
    return Design(draw, points, seed, _zipped(table.get("zip", []), factors, problems))


def _zipped(groups: Any, factors: Sequence[Factor], problems: list[Problem]) -> tuple[tuple[str, ...], ...]:
    counts = {factor.name: len(factor.values) for factor in factors if not factor.drawn}
    if not isinstance(groups, list) or not all(isinstance(group, list) and len(group) > 1 for group in groups):
        form = 'must be a list of groups of two factors or more, such as [["a.b", "c.d"]]'
        problems.append(Problem("design.zip", form, format_value(groups)))
        return ()
    seen: set[str] = set()
    for group in groups:
        for name in group:
            if name not in counts:
                suggestion = nearest(name, counts) if isinstance(name, str) else None
                problems.append(Problem("design.zip", "is not a factor with values", format_value(name), suggestion))
            elif name in seen:
                problems.append(Problem("design.zip", "is zipped twice", format_value(name)))
            else:
                seen.add(name)
        lengths = {name: counts[name] for name in group if name in seen}
        if len(set(lengths.values())) > 1:
            length_text = ", ".join(f"{name} {count}" for name, count in lengths.items())
            problems.append(
                Problem("design.zip", f"needs equally many values of each factor of a group, not {length_text}")
            )
    # Each group is sorted in the order of the factors, so that its first factor represents it.
    order = list(counts)
    return tuple(tuple(sorted(group, key=order.index)) for group in groups if set(group) <= seen)


def _whole(
    table: dict[str, Any],
    key: str,
    low: int,
    high: int,
    problems: list[Problem],
    default: int | None = None,
    prefix: str = "",
) -> int:
    value = table.get(key, default)
    if isinstance(value, int) and not isinstance(value, bool) and low <= value <= high:
        return value
    opening = "is missing: it" if value is None else ""
    text = None if value is None else format_value(value)
    message = f"{opening} must be a whole number from {low:,} to {high:,}".strip()
    problems.append(Problem(prefix + key, message, text))
    return low


def _seeds(value: Any, problems: list[Problem]) -> tuple[int, ...]:
    """Seeds from a list, from a text as for `hedon run`, or from their number: 4 means 1, 2, 3 and 4."""
    try:
        if isinstance(value, int):
            return tuple(range(1, integer("seeds", value, 1, MAX_WORLDS) + 1))
        return parse_seeds(value) if isinstance(value, str) else different(seed_list(value))
    except ArgumentError as error:
        form = f'must be how many (1 to {MAX_WORLDS:,}), a list of different seeds, or a text such as "1-4,9"'
        problems.append(Problem("seeds", f"{form}: {error}", format_value(value)))
    return (1,)


def _keep(value: Any, problems: list[Problem]) -> tuple[str, ...]:
    if not isinstance(value, list):
        problems.append(Problem("keep", f"must be a list of {', '.join(KEEP)}", format_value(value)))
        return ()
    for name in value:
        if name not in KEEP:
            suggestion = nearest(name, KEEP) if isinstance(name, str) else None
            problems.append(Problem("keep", f"must be a list of {', '.join(KEEP)}", format_value(name), suggestion))
    return tuple(value)
