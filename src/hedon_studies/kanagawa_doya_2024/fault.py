"""Study: what are the effects and interactions of the faults and the contact solver of the paper's program?"""

from collections.abc import Iterator, Mapping
from typing import Any

from hedon.analysis import ResultTable, make_table
from hedon.figure import NamedFigure
from hedon.measure import RESPONSES, Measure
from hedon.statistic import Cell, FactorialFit, Factors, all_effects, fit_factorial
from hedon.study import Condition, Item, ItemInputs, Scale, missing_note, sentences, shown_interval, world_rows
from hedon_studies.kanagawa_doya_2024 import figure

FACTORS = {
    "growth": "food.normal.growth_rate=1.0",
    "noise": "world.mutation_noise=tabulated",
    "critic": "learning.critic_target=batch_mean",
    "solver": "physics.solver=jacobi",
}
"""The factors, each with the override that enables it. The other differences of the fidelity `released` are smaller
and not included in any cell."""

SCALE = Scale((1, 2, 3), 512_000)
_MAIN = (
    "alive_mean",
    "restricted_lifetime",
    "food_per_agent_step",
    "w_normal_last",
    "w_action_last",
    "neutral_1_last",
)
_SHOWN = tuple(measure for measure in RESPONSES if measure.name in _MAIN)

_EFFECT = (
    "A main effect is the mean of the eight cells with a fault minus the mean of the eight without; an interaction "
    "of A and B is A's effect with B minus A's effect without B, and that of more is likewise the interaction of all "
    "but one with that one minus without it (coding ±1/2, products of columns; cells count alike). Lifetimes and rates "
    "of food are compared by their logarithms, so effects are ratios and interactions ratios of ratios. Intervals and "
    "p: Student's t with the variance of each cell's worlds and Satterthwaite's degrees of freedom (Welch), where each "
    "cell has three worlds or all have equally many; p_holm is corrected for all effects on one measure. seed_low and "
    "seed_high are the least and largest of the "
    "same effect within single seeds."
)
_CELLS_DRAWN = (
    "A line per combination of faults: a point is a world, hollow where it died out, and the bar is their mean, "
    "geometric for lifetimes and rates of food. A fault matters where the lines with it lie apart from those without."
)
_DRAWN = "An arrow at the edge of a panel ends an interval that goes on beyond it."
_CELL = (
    "Means over worlds, geometric for lifetimes and rates of food. An extinct world counts as 0 alive from its end on. "
    "Lifetimes with the living counted are means of min(lifetime, an age common to all worlds, {until:,.0f} steps); "
    "weights are means over the 5000 agents born last."
)


def cell_label(cell: Cell) -> str:
    """The label of a combination of faults."""
    present_faults = [name for name, is_present in zip(FACTORS, cell, strict=True) if is_present]
    return "all" if len(present_faults) == len(FACTORS) else " + ".join(present_faults) or "none"


def _in_order() -> list[Cell]:
    """No fault, single faults, pairs and so on, in the order of `all_effects`."""
    effects = [(), *all_effects(len(FACTORS))]
    return [tuple(i in group for i in range(len(FACTORS))) for group in effects]


CELLS = {cell_label(cell): cell for cell in _in_order()}
"""All combinations, by label."""


def _condition(label: str, cell: Cell) -> Condition:
    overrides = tuple(setting for setting, is_present in zip(FACTORS.values(), cell, strict=True) if is_present)
    return Condition(label, "baseline", overrides, fidelity="corrected")


CONDITIONS = tuple(_condition(label, cell) for label, cell in CELLS.items())


def make_faults(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figures and tables of the study."""
    rows = world_rows(inputs, CONDITIONS, RESPONSES)
    missing = missing_note(inputs, CONDITIONS, SCALE)
    fits = {measure.name: _fit(rows, measure) for measure in RESPONSES}
    rows_of_effects = {measure.name: list(_effect_rows(measure, fits[measure.name])) for measure in RESPONSES}
    effects = make_table(
        "fault_effects",
        "Effects of the released code's faults",
        [row for measure in _SHOWN for row in rows_of_effects[measure.name]],
        sentences(_EFFECT, _missing_effects(fits), missing),
    )
    worlds = make_table("fault_worlds", "The worlds of the study of faults", rows, missing, shown=False)
    until = max((row["until"] for row in rows), default=0.0)
    shown_effects = set(effects.rows["effect"]) if effects.rows.height else set()
    if rows:
        present_labels = [label for label in CELLS if inputs.worlds.get(label)]
        cells = figure.draw_cells(worlds.rows, present_labels, _SHOWN)
        yield NamedFigure("fault_cells", "What do the faults of the released code do?", cells, _CELLS_DRAWN)
    if shown_effects:
        names = [name for name in map(effect_name, all_effects(len(FACTORS))) if name in shown_effects]
        effects_figure = figure.draw_effects(effects.rows, names, _SHOWN)
        yield NamedFigure("fault_effects", "What does each do, alone and together?", effects_figure, _DRAWN)
    yield effects
    yield make_table(
        "fault_cells",
        "Worlds with and without the faults",
        _cell_rows(rows),
        sentences(_CELL.format(until=until), missing),
    )
    all_rows = [row for effect_rows in rows_of_effects.values() for row in effect_rows]
    yield make_table("fault_effects_all", "Effects on everything that is measured", all_rows, _EFFECT, shown=False)
    yield worlds


def effect_name(factors: Factors) -> str:
    """The name of an effect or interaction."""
    names = list(FACTORS)
    return " \N{MULTIPLICATION SIGN} ".join(names[i] for i in factors)


def _fit(rows: list[dict[str, Any]], measure: Measure) -> FactorialFit:
    cells: dict[Cell, dict[int, float]] = {}
    for row in rows:
        if row[measure.name] is not None:
            cells.setdefault(CELLS[row["condition"]], {})[row["seed"]] = measure.scaled(row[measure.name])
    return fit_factorial(cells, len(FACTORS))


def _effect_rows(measure: Measure, fit: FactorialFit) -> Iterator[dict[str, Any]]:
    for effect in fit.effects:
        statistics = {name: getattr(effect, name) for name in ("low", "high", "p", "p_holm")}
        bounds = dict.fromkeys(statistics) if measure.binary else statistics
        values = {"estimate": effect.estimate} | bounds
        values |= {"seed_low": effect.seed_low, "seed_high": effect.seed_high}
        for name in ("estimate", "low", "high", "seed_low", "seed_high"):
            values[name] = measure.unscaled(values[name])
        head = {"measure": measure.name, "effect": effect_name(effect.factors)}
        yield head | {"scale": "ratio" if measure.ratio else "difference"} | values | {"seeds": effect.seeds}


def _missing_effects(fits: Mapping[str, FactorialFit]) -> str:
    """A note on effects that could not be estimated, or only without interactions, for measures with equal gaps."""
    gaps: dict[str, list[str]] = {}
    for name, fit in fits.items():
        reduced_effects = [effect_name(effect.factors) for effect in fit.effects if effect.order < len(FACTORS)]
        parts = [f"left out: {', '.join(map(effect_name, fit.left_out))}"] if fit.left_out else []
        parts += [f"estimated from some cells only: {', '.join(reduced_effects)}"] if reduced_effects else []
        if parts:
            gaps.setdefault(" and ".join(parts), []).append(name)
    notes = [
        f"Since cells are missing, {gap} (of {'all measures' if len(names) == len(fits) else ', '.join(names)})."
        for gap, names in gaps.items()
    ]
    return " ".join(notes)


def _cell_rows(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    results = []
    for label in CELLS:
        cell_rows = [row for row in rows if row["condition"] == label]
        if cell_rows:
            means = {
                r.name: shown_interval([row[r.name] for row in cell_rows], r).mean for r in RESPONSES if not r.binary
            }
            results.append(
                {"condition": label, "worlds": len(cell_rows), "died_out": sum(row["died_out"] for row in cell_rows)}
                | means
            )
    return results


FAULTS = Item(
    "faults",
    "The faults of the released code and its contact solver",
    "The paper's program grew food faster than it was set to, repeated the same mutations, trained its critic "
    "towards the mean of a batch, and let bodies overlap. What does each do, and what do they do together?",
    make_faults,
    CONDITIONS,
    SCALE,
)
