"""How many worlds are needed to find an effect, given the variation among the worlds of a pilot?"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.compare.contrast import choose_factor, choose_levels
from hedon.compare.error import CompareError
from hedon.compare.match import known_values
from hedon.compare.response import responses
from hedon.compare.source import WorldTable
from hedon.figure.named import NamedFigure
from hedon.figure.style import BLUE, GREEN, MUTED, ORANGE, VERMILION, head, new_figure, styled
from hedon.report.answer import Answer, simple_answer
from hedon.statistic.interval import distance_interval
from hedon.statistic.power import Design, contrast_power, effect_seen, worlds_needed

PAIRS, APART, ALONE = "pairs", "two conditions", "one condition"
_TESTED: dict[str, Design] = {PAIRS: "pairs", APART: "independent", ALONE: "alone"}
DESIGNS = {
    PAIRS: "two conditions, compared in pairs of equal seeds",
    APART: "two conditions of as many independent worlds each",
    ALONE: "one condition, against a known number such as 0",
}
COUNTS = (5, 10, 20, 50, 100, 200)
"""Numbers of worlds for which the smallest detectable effect is listed if no effect is given."""
_COLORS = (BLUE, VERMILION, GREEN, ORANGE)


@dataclass(frozen=True)
class PilotSpread:
    """The variation of a measure among worlds.

    Attributes:
        measure: Title of the measure.
        design: One of `DESIGNS`.
        sd: Standard deviation between the worlds of a condition, or of the differences within pairs.
        low, high: Bounds of its 95 % interval, as if worlds of equal seeds were identical in all conditions.
        worlds: Number of worlds on which it is based.
    """

    measure: str
    design: str
    sd: float
    low: float
    high: float
    worlds: int


def spreads(
    pilot: WorldTable, by: str | None = None, between: str | None = None, only: Sequence[str] = ()
) -> list[PilotSpread]:
    """The variation of each measure among the worlds of a pilot.

    Args:
        pilot: Worlds of the pilot.
        by: Factor whose values are to be compared; None for none.
        between: Two values of the factor, separated by a comma.
        only: Columns of the measures to use; by default the usual ones.

    Raises:
        CompareError: There are too few worlds, or the factor does not have two values.
    """
    by = None if by is None else choose_factor(pilot, by)
    factors = [*pilot.factors, *([by] if by and by not in pilot.factors else [])]
    _require_one_each(pilot.rows, factors)
    found = []
    for name, title in responses(pilot.rows, only, factors, pilot.titles).items():
        if by is not None:
            found += _spread(title, PAIRS, _changes(pilot, name, by, between))
        groups = pilot.rows.partition_by(factors) if factors else [pilot.rows]
        known = [known_values(rows, name, ()) for rows in groups]
        found += _spread(title, APART, known) + _spread(title, ALONE, known)
    if not found:
        raise CompareError("the worlds do not differ in any measure, or there are fewer than two in each condition")
    return found


def _require_one_each(table: pl.DataFrame, groups: Sequence[str]) -> None:
    """Refuses tables in which, according to their columns, several worlds of a seed belong to one condition."""
    repeated = table.group_by(*dict.fromkeys(["seed", *groups])).len().filter(pl.col("len") > 1)
    if repeated.height:
        row = repeated.sort("seed").row(0, named=True)
        of = "".join(f", {name} = {row[name]}" for name in groups)
        raise CompareError(
            f"{row['len']} worlds have seed {row['seed']}{of}: keep one row per seed and condition, or give the "
            "folder of the sweep, which knows its factors"
        )


def _changes(pilot: WorldTable, name: str, by: str, between: str | None) -> list[pl.DataFrame]:
    """The differences between worlds of equal seeds, one table per combination of the other factors."""
    held = [each for each in pilot.factors if each != by]
    levels = choose_levels(by, pilot.rows[by].unique(maintain_order=True), between)
    one, two = (known_values(pilot.rows.filter(pl.col(by) == value), name, held) for value in levels)
    pairs = one.join(two, on=["seed", *held], suffix="_other")
    changes = pairs.select("seed", *held, value=pl.col("value_other") - pl.col("value"))
    return changes.partition_by(held) if held else [changes]


def _spread(title: str, design: str, groups: Sequence[pl.DataFrame]) -> list[PilotSpread]:
    """The pooled standard deviation of the values within groups; none if it is unknown or 0.

    Worlds of equal seeds can be identical in all groups, and further groups then add no information. The interval
    therefore has fewer degrees of freedom than there are seeds.
    """
    values = [each["value"].to_numpy() for each in groups]
    seeds = len(set[int]().union(*(each["seed"].to_list() for each in groups)))
    within = np.concatenate([each - each.mean() for each in values if len(each)] or [np.zeros(0)])
    freedom = len(within) - sum(len(each) > 0 for each in values)
    if freedom < 1 or not (within**2).sum() > 0:
        return []
    sd = math.sqrt(float((within**2).sum()) / freedom)
    return [PilotSpread(title, design, *distance_interval(np.full(min(freedom, seeds - 1), sd)), len(within))]


def power_answer(
    found: Sequence[PilotSpread],
    effects: Sequence[float] = (),
    power: float = 0.8,
    level: float = 0.05,
    pilot: str = "",
    cautions: Sequence[str] = (),
) -> Answer:
    """The number of worlds needed for each measure and design, or the effects that some numbers of worlds can find.

    Args:
        found: Variation of each measure and design.
        effects: Effects to find, in units of the measure; if empty, the smallest detectable effects are listed.
        power: Required power.
        level: Significance level.
        pilot: Name of the pilot.
        cautions: Sentences about worlds that are not independent.
    """
    table = _needed(found, effects, power, level) if effects else _seen(found, power, level)
    tables = [replace(table, note=" ".join([table.note, *cautions]))]
    content = {"pilot": pilot, "power": power, "level": level, "effects": list(effects)}
    content["spreads"] = [vars(each) for each in found]
    intro = f"From {pilot}. " if pilot else ""
    intro += f"The tests of `hedon compare`, at {level:g}, find an effect with chance {power:g}."
    figure = draw_power(found, effects, power, level)
    drawn = NamedFigure("power", "How likely is an effect found?", figure)
    return simple_answer("power", "How many worlds are needed", content, tables, intro, [drawn])


def _needed(found: Sequence[PilotSpread], effects: Sequence[float], power: float, level: float) -> ResultTable:
    rows = []
    for each in found:
        for effect in effects:
            # The standard deviation of a pilot is uncertain, so the answer includes both of its bounds.
            needed, low, high = (
                worlds_needed(effect / sd, _TESTED[each.design], power, level) for sd in (each.sd, each.low, each.high)
            )
            row = {"measure": each.measure, "design": each.design, "effect": effect, "needed": needed}
            rows.append(row | {"low": low, "high": high, "sd": each.sd, "worlds": each.worlds})
    note = "needed: worlds of each condition, in one setting of all other factors, for a chance of "
    note += f"{power:g} to see the effect at {level:g}; its interval "
    note += "is that of the sd, which comes from few worlds. " + _meanings(found)
    return make_table("power", "Worlds needed", rows, note)


def _seen(found: Sequence[PilotSpread], power: float, level: float) -> ResultTable:
    rows = []
    for each in found:
        head = {"measure": each.measure, "design": each.design, "sd": each.sd, "worlds": each.worlds}
        least = {f"with {count}": effect_seen(count, _TESTED[each.design], power, level) * each.sd for count in COUNTS}
        rows.append(head | least)
    note = f"with N: the least effect that N worlds of each condition find with chance {power:g} at {level:g}; "
    return make_table("power", "Effects that are seen", rows, f"{note}--effect asks the other way. {_meanings(found)}")


def _meanings(found: Sequence[PilotSpread]) -> str:
    designs = dict.fromkeys(each.design for each in found)
    return "; ".join(f"{design}: {DESIGNS[design]}" for design in designs) + "."


def draw_power(found: Sequence[PilotSpread], effects: Sequence[float], power: float, level: float) -> Figure:
    """Draws the power to find an effect against the number of worlds.

    Args:
        found: Variation of each measure and design.
        effects: Effects to find, of which the first is drawn; half a standard deviation if empty.
        power: Required power.
        level: Significance level.
    """
    own = [each for each in found if each.measure == found[0].measure]
    effect = effects[0] if effects else 0.5 * own[0].sd
    most = [worlds_needed(effect / each.sd, _TESTED[each.design], power, level) or 1000 for each in own]
    worlds = np.unique(np.linspace(2, max(10, 1.5 * max(most)), 80).round())
    with styled():
        figure = new_figure(5.6, 3.4)
        axes = figure.subplots()
        for each, color in zip(own, _COLORS, strict=False):
            chance = [contrast_power(effect / each.sd, int(count), _TESTED[each.design], level) for count in worlds]
            axes.plot(worlds, chance, color=color, linewidth=1.6, label=each.design)
        axes.axhline(power, color=MUTED, linewidth=0.8, linestyle="--")
        axes.set_ylim(0.0, 1.02)
        axes.set_xlabel("worlds of each condition")
        axes.set_ylabel("chance to see the effect")
        axes.legend(loc="lower right")
        head(axes, f"{own[0].measure}: an effect of {effect:.3g}", f"sd {own[0].sd:.3g}; dashed: {power:g}")
    return figure
