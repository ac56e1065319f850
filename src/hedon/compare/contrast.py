"""Do two conditions differ? Worlds are the sample, in pairs if their seeds are equal."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.compare.error import CompareError
from hedon.compare.match import Matched, choose_design, match
from hedon.compare.preface import make_preface
from hedon.compare.response import responses
from hedon.compare.source import WorldTable
from hedon.config.problem import did_you_mean, format_value
from hedon.figure.named import NamedFigure
from hedon.figure.style import BLUE, INK, MUTED, head, new_figure, say_empty, styled
from hedon.report.answer import Answer, simple_answer
from hedon.statistic.contrast import Contrast, independent_contrast, paired_contrast
from hedon.statistic.correction import holm
from hedon.statistic.extinction import log_rank
from hedon.statistic.minimum import FOR_INTERVAL, FOR_PAIRS
from hedon.text import count, p_phrase

MOST_LISTED = 8
"""Largest number of a factor's values in a message."""


@dataclass(frozen=True, eq=False)
class Compared:
    """One measure in two conditions.

    Attributes:
        title: Title of the measure.
        matched: The values that are compared.
        contrast: Their difference.
    """

    title: str
    matched: Matched
    contrast: Contrast


def choose_factor(worlds: WorldTable, by: str | None) -> str:
    """The factor that distinguishes the two conditions.

    Args:
        worlds: The worlds.
        by: Factor that the user named; None if there is only one.

    Raises:
        CompareError: The factor does not exist, or must be chosen from several.
    """
    known = [each for each in worlds.rows.columns if each != "seed"]
    if by is None and worlds.factors:
        if len(worlds.factors) == 1:
            return worlds.factors[0]
        raise CompareError(f"{worlds.name}: name the factor with --by: there are {', '.join(worlds.factors)}")
    if by is None:
        raise CompareError(
            f"{worlds.name} holds worlds of one condition: name a second source, or a column with --by NAME"
        )
    if by not in known:
        hint = did_you_mean(by, worlds.factors or known, f" (there are {', '.join(worlds.factors or known)})")
        raise CompareError(f"--by {by}: is not a factor of {worlds.name}{hint}")
    return by


def choose_levels(by: str, every: Iterable[Any], between: str | None) -> tuple[Any, Any]:
    """The two values of a factor to compare.

    Args:
        by: The factor.
        every: All of its values.
        between: Two values separated by a comma; None if there are only two.

    Raises:
        CompareError: There are not exactly two values, or a value does not exist.
    """
    values = {_written(each): each for each in every if each is not None}
    for asked in [list(values)] if between is None else _halves(between, values):
        if len(asked) == 2 and set(asked) <= values.keys() and asked[0] != asked[1]:
            return values[asked[0]], values[asked[1]]
    there = ("; " if any("," in each for each in values) else ", ").join(list(values)[:MOST_LISTED])
    there += f" and {len(values) - MOST_LISTED} more" if len(values) > MOST_LISTED else ""
    if len(values) < 2:
        raise CompareError(f"--by {by}: has one value, {there}: a comparison needs two")
    given = f"--by {by}" if between is None else f"--between {between}"
    raise CompareError(f"{given}: name two values of {by} with --between A,B: there are {there}")


def _written(value: Any) -> str:
    """A value as the user writes it."""
    return value if isinstance(value, str) else format_value(value)


def _halves(between: str, values: Mapping[str, Any]) -> list[list[str]]:
    """Every way to split a text at a comma, since values such as labels can contain commas."""
    parts = between.split(",")
    return [
        [_as_written(",".join(half).strip(), values) for half in (parts[:i], parts[i:])] for i in range(1, len(parts))
    ]


def _as_written(asked: str, values: Mapping[str, Any]) -> str:
    """The value as the table writes it; for example, 30 and 3e1 both mean 30.0."""
    for written, value in values.items():
        with suppress(ValueError):
            if isinstance(value, int | float) and not isinstance(value, bool) and float(asked) == value:
                return written
    return asked


def comparable(worlds: WorldTable, by: str, levels: tuple[Any, Any]) -> tuple[pl.DataFrame, pl.DataFrame, list[str]]:
    """The worlds of two conditions, restricted to the combinations of all other factors that both have.

    Returns:
        The worlds of each condition and, if they share no combination, the other factors in which they differ.
    """
    first, second = (worlds.rows.filter(pl.col(by) == value) for value in levels)
    others = [name for name in worlds.factors if name != by]
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
    """Compares two groups of worlds, all measures in one design. Worlds of one seed count once, with their mean.

    Args:
        first: Worlds of the first condition.
        second: Worlds of the second condition.
        shown: Columns of the measures to compare, with their titles.
        factors: Columns of all other factors.
        paired: Whether to compare worlds of equal seeds in pairs; see `choose_design`.
    """
    found = []
    for name, title in shown.items():
        matched = match(first, second, name, factors, paired=paired)
        test = paired_contrast if matched.paired else independent_contrast
        found.append(Compared(title, matched, test(matched.values, matched.others)))
    return found


def compare_answer(
    worlds: WorldTable,
    by: str | None = None,
    between: str | None = None,
    only: Sequence[str] = (),
    *,
    paired: bool = True,
) -> Answer:
    """The comparison of two conditions, measure by measure.

    Args:
        worlds: The worlds.
        by: Factor that distinguishes the conditions; None if there is only one.
        between: Its two values, separated by a comma; None if there are only two.
        only: Columns of the measures to show; by default the usual ones.
        paired: Whether to compare worlds of equal seeds in pairs.

    Raises:
        CompareError: The factor, a value or a column does not exist.
    """
    by = choose_factor(worlds, by)
    levels = choose_levels(by, worlds.planned.get(by) or worlds.rows[by].unique(maintain_order=True), between)
    names = [_written(level) for level in levels]
    first, second, others = comparable(worlds, by, levels)
    for name, rows in zip(names, (first, second), strict=True):
        if rows.is_empty():
            raise CompareError(f"no world with {by} = {name} is done yet: there is nothing to compare")
    held = [name for name in worlds.factors if name not in (by, *others)]
    shown = responses(worlds.rows, only, [*worlds.factors, by], worlds.titles)
    if not only:
        known = [name for name in shown if first[name].count() and second[name].count()]
        shown = {name: shown[name] for name in known}
    design = choose_design(first, second, names, held, paired=paired)
    found = compare(first, second, shown, held, paired=design.paired)
    tables = [_contrasts(found, names, others, worlds.cautions), *_extinct(first, second, names, held)]
    preface = make_preface(worlds, by, names, design)
    content = {"source": worlds.name, "by": by, "between": list(levels), "also_differs": others, **preface.content}
    title = f"{worlds.name}: {by}, {names[0]} and {names[1]}"
    figure = NamedFigure("compare", "Which measures differ?", draw_contrasts(found, by, names))
    answer = simple_answer("compare", title, content, tables, preface.lead, [figure])
    return replace(answer, page=preface.on_page(answer.page), lines=preface.lines)


def _contrasts(
    found: Sequence[Compared], names: Sequence[str], others: Sequence[str], cautions: Sequence[str]
) -> ResultTable:
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
        f"Differences: {names[1]} minus {names[0]}, within equal settings of all other factors; worlds "
        f"of one seed count once. Intervals need {FOR_INTERVAL} pairs, or {FOR_INTERVAL} worlds of each condition. "
        "Effect size: in standard deviations of the pairs, or within conditions. Left out: worlds without a "
        "counterpart or a value. p: of pairs, by exchanging their signs, exact if there are few; otherwise Welch's t "
        f"test; p Holm: {_family(len(found))}. Worlds that died out count if they have a value."
    )
    most = max((len(each.matched.values) for each in found if each.matched.paired), default=0)
    if 0 < most < FOR_PAIRS:
        note += f" With {count(most, 'pair')}, no p is below {2 / 2**most:.2g}: take at least {FOR_PAIRS}."
    note += f" The conditions differ in {', '.join(others)} too: the design does not cross them." if others else ""
    return make_table("contrast", f"{names[1]} against {names[0]}", rows, " ".join([note, *cautions]))


def _family(measures: int) -> str:
    return "the same as p, since there is one measure" if measures == 1 else f"corrected for these {measures} measures"


def _extinct(
    first: pl.DataFrame, second: pl.DataFrame, names: Sequence[str], factors: Sequence[str]
) -> list[ResultTable]:
    """How many worlds of each condition died out, how long they lived, and whether the conditions differ."""
    if "extinct" not in first.columns:
        return []
    pairs = zip(names, (first, second), strict=True)
    rows = [{"condition": name, "worlds": each.height, "died out": int(each["extinct"].sum())} for name, each in pairs]
    known = [each for each in (first, second) if "survived" in each.columns]
    if len(known) < 2 or not sum(row["died out"] for row in rows):
        return [make_table("extinct", "Worlds that died out", rows)]
    for row, each in zip(rows, known, strict=True):
        row["mean steps survived"] = float(each["survived"].cast(pl.Float64).to_numpy().mean())
    p = _survival_chance(known, factors)
    note = f"{p_phrase(p)}, by a log-rank test in which worlds exchange their conditions"
    note += " within equal settings of all other factors." if factors else "."
    return [make_table("extinct", "Worlds that died out", rows, note)]


def _survival_chance(groups: Sequence[pl.DataFrame], factors: Sequence[str]) -> float:
    """The p value of the log-rank test for the worlds of two conditions."""
    both = pl.concat([each.with_columns(first=pl.lit(i == 0)) for i, each in enumerate(groups)], how="diagonal_relaxed")
    lived, ended, first = (both[name].to_numpy() for name in ("survived", "extinct", "first"))
    settings = both.select(pl.struct(factors).rank("dense")).to_series().to_numpy() if factors else np.zeros(len(first))
    return log_rank(lived.astype(np.float64), ended.astype(np.bool_), first, settings.astype(np.int64))


def draw_contrasts(found: Sequence[Compared], by: str, names: Sequence[str]) -> Figure:
    """Draws the size of each effect with its 95 % interval."""
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
