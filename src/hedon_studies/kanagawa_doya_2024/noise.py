"""Study: where does tabulated mutation noise drive the weights?"""

from collections.abc import Iterator

from hedon.analysis import ResultTable
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, Scale, missing_note
from hedon_studies.kanagawa_doya_2024.fault import FACTORS
from hedon_studies.kanagawa_doya_2024.mutation import condition_drifts, drift_parts

CONDITIONS = (
    Condition("tabulated", overrides=(FACTORS["noise"],), fidelity="corrected"),
    Condition("released", fidelity="released"),
    Condition("independent", fidelity="corrected"),
)
SCALE = Scale((1, 2), 1_024_000)


def make_noise(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    drifts = condition_drifts(inputs, CONDITIONS)
    tables = [
        f"{label}: births of equal number {_agreement([drift['is_table'] for _, drift in seed_drifts])}"
        for label, seed_drifts in drifts.items()
        if seed_drifts
    ]
    notes = [f"{'; '.join(tables)}." if tables else "", missing_note(inputs, CONDITIONS, SCALE)]
    yield from drift_parts("noise", drifts, " ".join(filter(None, notes)))


def _agreement(agreements: list[bool]) -> str:
    if all(agreements):
        return "agree to rounding"
    return (
        "do not agree" if not any(agreements) else f"agree in {sum(agreements)} of {len(agreements)} genes and worlds"
    )


NOISE = Item(
    "noise",
    "Tabulated mutation noise",
    "The released program draws the mutations of each window from the same small table. Does the table's mean "
    "predict where the weights go, the neutral gene's included?",
    make_noise,
    CONDITIONS,
    SCALE,
)
