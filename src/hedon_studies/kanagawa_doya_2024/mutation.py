"""Tables and figure of the drift that a world's mutations predict, for several studies."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from hedon.analysis import ResultTable, generator, make_table
from hedon.figure import NamedFigure
from hedon.statistic import FOR_INTERVAL
from hedon.study import Condition, ItemInputs, sentences
from hedon_studies.kanagawa_doya_2024 import figure
from hedon_studies.kanagawa_doya_2024.analysis.bias import COMPARISONS, Drift, compare, gene_drift

GENES = {"w_normal": "weight of food", "w_action": "weight of action", "neutral_1": "neutral gene"}
_ALL = "all genes"

_PREDICTION = (
    "bias: mean mutation per birth, which each generation of a line without selection adds to its weight. Slopes are "
    "of seen = slope · predicted, through the origin, with Student's t interval; p_sign is exact binomial. Genes of "
    "one world have tables of their own but share its pedigree. A weight that has reached the limit drifts no further, "
    "which the second comparison accounts for. A bias is there with either noise, but with independent noise it is "
    "that of mutations that happened once, and does not recur; near the limit it leans inward, as clipping does."
)
_DRAWN = (
    "A point is one gene of one world; on the line both are equal. The scale of mutations is linear around 0 and "
    "logarithmic beyond."
)
_GENE = (
    "numbers: births within a window that have an entry. bounds: entries of which all children were clipped at the "
    "limit. disagreement: largest difference between mutations of equal number; rounding is 1e-6 for weights up to "
    "10. line_mean, line_low, line_high: weight of lines without selection after the generations given, mean and 95 % "
    "of them. slope: of mean weight against mean generation; displacement: from the founders' mean to the end, per "
    "generation."
)

_BRIEF = ("weight", "numbers", "bias", "slope", "displacement", "generations", "line_mean", "end")

Drifts = Mapping[str, Sequence[tuple[int, Drift]]]
"""For each condition, pairs of a world's seed and the drift of one of its genes."""


def condition_drifts(inputs: ItemInputs, conditions: Sequence[Condition]) -> Drifts:
    """The drift of all genes in all worlds of some conditions."""
    return {
        condition.label: [
            (world.seed, drift)
            for world in inputs.worlds.get(condition.label, ())
            for weight in GENES
            if weight in world.weight_names and (drift := gene_drift(world, weight, generator(world))) is not None
        ]
        for condition in conditions
    }


def drift_parts(name: str, drifts: Drifts, note: str) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and the two tables of a study.

    Args:
        name: Name of the item.
        drifts: Drift of genes, by condition.
        note: Remark below the tables.
    """
    drifts_by_label = {label: [drift for _, drift in seed_drifts] for label, seed_drifts in drifts.items()}
    question = "Do weights go where mutations push them?"
    yield NamedFigure(f"{name}_prediction", question, figure.draw_predictions(drifts_by_label, GENES), _DRAWN)
    yield make_table(
        f"{name}_prediction",
        "Mutations: predicted and seen",
        [
            row
            for label, seed_drifts in drifts.items()
            for row in _prediction_rows(label, drifts_by_label[label], len({seed for seed, _ in seed_drifts}))
        ],
        sentences(_PREDICTION, note),
    )
    rows = [
        {"condition": label, "seed": seed} | drift
        for label, seed_drifts in drifts.items()
        for seed, drift in seed_drifts
    ]
    brief_rows = [{column: row[column] for column in ("condition", "seed", *_BRIEF)} for row in rows]
    yield make_table(f"{name}_gene", "Mutations, world by world", brief_rows, _GENE)
    yield make_table(f"{name}_gene_all", "Mutations, world by world, in full", rows, _GENE, shown=False)


def _prediction_rows(label: str, drifts: Sequence[Drift], worlds: int) -> Iterator[dict[str, Any]]:
    """Rows with bounds and p values from five worlds up, not three pairs, since a world's genes share a pedigree."""
    for comparison in COMPARISONS:
        for weight in (*GENES, _ALL):
            weight_drifts = [drift for drift in drifts if weight in (drift["weight"], _ALL)]
            if weight_drifts:
                row = {"condition": label, "compared": comparison, "weight": weight, "worlds": worlds}
                row |= compare(weight_drifts, comparison)
                yield row if worlds >= FOR_INTERVAL else row | dict.fromkeys(("low", "high", "p_sign"))
