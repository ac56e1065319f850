"""Do two conditions of a sweep differ? Worlds are the units, in pairs where their seeds are equal."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.config.problem import format_value, nearest
from hedon.figure.style import BLUE, INK, MUTED, head, new_figure, say_empty, styled
from hedon.report.answer import Answer
from hedon.statistic.contrast import Contrast, independent_contrast, paired_contrast
from hedon.statistic.correction import holm
from hedon.statistic.minimum import FOR_INTERVAL
from hedon.sweep.collect import table_value
from hedon.sweep.error import SweepError
from hedon.sweep.match import Matched, match
from hedon.sweep.plan import SweepPlan
from hedon.sweep.response import responses

MOST_TOLD = 8
"""Most values of a factor that a message lists."""


@dataclass(frozen=True, eq=False)
class Compared:
    """One measure in two conditions.

    Attributes:
        title: what the measure is called.
        matched: the values that are compared.
        contrast: how they differ.
    """

    title: str
    matched: Matched
    contrast: Contrast


def choose_levels(plan: SweepPlan, by: str, between: str | None) -> tuple[Any, Any]:
    """The two values of a factor that are compared.

    Args:
        plan: of the sweep.
        by: name of the factor.
        between: the two values, with a comma between them; None where there are only two.

    Raises:
        SweepError: there is no such factor, or there are not two such values.
    """
    if by not in plan.factors:
        near = nearest(by, plan.factors)
        hint = f"; did you mean {near}?" if near else f" (there are {', '.join(plan.factors) or 'none'})"
        raise SweepError(f"--by {by}: is not a factor of the sweep{hint}")
    return two_of(by, (each.settings[by] for each in plan.conditions), between)


def two_of(by: str, every: Iterable[Any], between: str | None) -> tuple[Any, Any]:
    """Two of the values of a factor or column.

    Args:
        by: its name.
        every: its values, each as often as it comes.
        between: the two values, with a comma between them; None where there are only two.

    Raises:
        SweepError: there are not two such values.
    """
    values = {format_value(each).strip('"'): each for each in every}
    asked = list(values) if between is None else [_as_written(part.strip(), values) for part in between.split(",")]
    if len(asked) == 2 and set(asked) <= values.keys() and asked[0] != asked[1]:
        return values[asked[0]], values[asked[1]]
    there = ", ".join(list(values)[:MOST_TOLD]) + (
        f" and {len(values) - MOST_TOLD} more" if len(values) > MOST_TOLD else ""
    )
    if len(values) < 2:
        raise SweepError(f"--by {by}: has one value, {there}: a comparison needs two")
    said = f"--by {by}" if between is None else f"--between {between}"
    raise SweepError(f"{said}: name two of the values of {by} with --between A,B: there are {there}")


def _as_written(asked: str, values: Mapping[str, Any]) -> str:
    """The value as the sweep writes it: 30 and 3e1 name 30.0."""
    for written, value in values.items():
        with suppress(ValueError):
            if isinstance(value, int | float) and not isinstance(value, bool) and float(asked) == value:
                return written
    return asked


def comparable(
    plan: SweepPlan, table: pl.DataFrame, by: str, levels: tuple[Any, Any]
) -> tuple[pl.DataFrame, pl.DataFrame, list[str]]:
    """The worlds of two values of a factor, with the same values of all others where these are crossed.

    Args:
        plan: of the sweep.
        table: of its worlds.
        by: name of the factor.
        levels: its two values.

    Returns:
        The worlds of each value, and the other factors in which they differ, if they are not crossed.
    """
    held = [table_value(level) for level in levels]
    held = list(map(str, held)) if table.schema[by] == pl.String else held
    first, second = (table.filter(pl.col(by) == value) for value in held)
    others = [name for name in plan.factors if name != by]
    if not others:
        return first, second, []
    rows = [each.select(others).rows() for each in (first, second)]
    shared = set(rows[0]) & set(rows[1])
    if not shared:
        return first, second, others
    one, other = (each.filter([row in shared for row in own]) for each, own in zip((first, second), rows, strict=True))
    return one, other, []


def compare(
    first: pl.DataFrame,
    second: pl.DataFrame,
    shown: Mapping[str, str],
    factors: Sequence[str] = (),
    *,
    paired: bool = True,
) -> list[Compared]:
    """Compares two groups of worlds. Worlds of one seed count once, by their mean.

    Args:
        first: of the first condition, a row per world.
        second: of the second.
        shown: columns, and what they are called.
        factors: columns of the other factors, in whose settings worlds are matched.
        paired: whether to compare in pairs where both have worlds of the same seeds.
    """
    found = []
    for name, title in shown.items():
        matched = match(first, second, name, factors, paired=paired)
        test = paired_contrast if matched.paired else independent_contrast
        found.append(Compared(title, matched, test(matched.values, matched.others)))
    return found


def contrast_answer(
    plan: SweepPlan,
    table: pl.DataFrame,
    by: str,
    between: str | None = None,
    only: Sequence[str] = (),
    *,
    paired: bool = True,
) -> Answer:
    """What two conditions of a sweep differ in.

    Args:
        plan: of the sweep.
        table: of its worlds so far.
        by: the factor that tells the conditions apart.
        between: its two values, with a comma between them; None where it has two.
        only: columns to compare; by default the usual ones.
        paired: whether to compare in pairs where seeds are equal.

    Raises:
        SweepError: there is no such factor, value or column, or no world of a value.
    """
    levels = choose_levels(plan, by, between)
    names = [format_value(level).strip('"') for level in levels]
    if table.is_empty():
        raise SweepError("no batch of the sweep is done yet: there is nothing to compare")
    first, second, others = comparable(plan, table, by, levels)
    for worlds, name in ((first, names[0]), (second, names[1])):
        if worlds.is_empty():
            raise SweepError(f"no world with {by} = {name} is done yet: there is nothing to compare")
    held = [name for name in plan.factors if name not in (by, *others)]
    found = compare(first, second, responses(table, only, plan.factors), held, paired=paired)
    tables = [_contrasts(found, names, by, others), _extinct(first, second, names, by)]
    content = {"sweep": plan.name, "by": by, "between": list(levels), "steps": plan.steps, "also_differs": others}
    intro = f"{by} = {names[1]} against {names[0]}, worlds of {plan.steps:,} steps."
    title = f"Sweep {plan.name}: {by}, {names[0]} and {names[1]}"
    return Answer("contrast", title, content, tables, intro, draw_contrasts(found, by, names))


def _contrasts(found: Sequence[Compared], names: Sequence[str], by: str, others: Sequence[str]) -> ResultTable:
    rows = []
    for each, corrected in zip(found, holm([each.contrast.p for each in found]), strict=True):
        contrast, values, second = each.contrast, each.matched.values, each.matched.others
        rows.append(
            {
                "measure": each.title,
                "difference": contrast.difference,
                "low": contrast.low,
                "high": contrast.high,
                "effect size": contrast.effect,
                names[0]: float(values.mean()) if len(values) else None,
                names[1]: float(second.mean()) if len(second) else None,
                "worlds": len(values) if each.matched.paired else len(values) + len(second),
                "paired": "yes" if each.matched.paired else "no",
                "left out": each.matched.left_out,
                "p": contrast.p,
                "p Holm": corrected,
            }
        )
    note = (
        f"Differences: {by} = {names[1]} minus {by} = {names[0]}, within equal settings of all other factors; worlds "
        f"of one seed count once. Intervals need {FOR_INTERVAL} pairs, or {FOR_INTERVAL} worlds of each condition. "
        "Effect size: in standard deviations of the pairs, or within conditions. Left out: worlds without a "
        "counterpart. p: of pairs, by exchanging their signs, exact if there are few; otherwise Welch's t test; p "
        f"Holm: corrected for these {len(found)} measures. Worlds that died out count if they have a value."
    )
    note += f" The conditions differ in {', '.join(others)} too: the design does not cross them." if others else ""
    return make_table("contrast", f"What {by} changes", rows, note)


def _extinct(first: pl.DataFrame, second: pl.DataFrame, names: Sequence[str], by: str) -> ResultTable:
    pairs = zip(names, (first, second), strict=True)
    rows = [{by: name, "worlds": each.height, "died out": int(each["extinct"].sum())} for name, each in pairs]
    return make_table("extinct", "Worlds that died out", rows)


def draw_contrasts(found: Sequence[Compared], by: str, names: Sequence[str]) -> Figure:
    """The size of each effect with its 95 % interval.

    Args:
        found: the measures.
        by: the factor that tells the conditions apart.
        names: its two values.
    """
    with styled():
        figure = new_figure(6.4, 1.2 + 0.34 * len(found))
        axes = figure.subplots()
        known = [each for each in found if np.isfinite(each.contrast.effect)]
        if not known:
            say_empty(axes, "no measure has an effect size")
        for i, each in enumerate(reversed(known)):
            contrast = each.contrast
            scale = contrast.effect / contrast.difference if contrast.difference else 0.0
            axes.plot([scale * contrast.low, scale * contrast.high], [i, i], color=BLUE, linewidth=1.6)
            axes.plot(contrast.effect, i, "o", color=INK, markersize=5)
        axes.axvline(0.0, color=MUTED, linewidth=0.8)
        axes.set_yticks(range(len(known)), [each.title for each in reversed(known)])
        axes.set_xlabel("difference, in standard deviations")
        head(axes, f"{by}: {names[1]} against {names[0]}", "dots: effect size; bars: 95 % interval over worlds")
    return figure
