"""Study: where does frozen mutation noise carry the weights?"""

from collections.abc import Iterator

from hedon.analysis.table import ResultTable
from hedon.figure.named import NamedFigure
from hedon.study.change import missing_note
from hedon.study.item import Arm, Item, Material, Scale
from hedon_studies.kanagawa_doya_2024.fault import FACTORS
from hedon_studies.kanagawa_doya_2024.mutation import arm_drifts, drift_parts

ARMS = (
    Arm("frozen", overrides=(FACTORS["noise"],), fidelity="corrected"),
    Arm("released", fidelity="released"),
    Arm("independent", fidelity="corrected"),
)
SCALE = Scale((1, 2), 1_024_000)


def make_noise(material: Material) -> Iterator[NamedFigure | ResultTable]:
    """The figure and tables of the study."""
    drifts = arm_drifts(material, ARMS)
    tables = [
        f"{label}: births of equal number {_agreement([drift.is_table for _, drift in found])}"
        for label, found in drifts.items()
        if found
    ]
    notes = [f"{'; '.join(tables)}." if tables else "", missing_note(material, ARMS, SCALE)]
    yield from drift_parts("noise", drifts, " ".join(filter(None, notes)))


def _agreement(agree: list[bool]) -> str:
    if all(agree):
        return "agree to rounding"
    return "do not agree" if not any(agree) else f"agree in {sum(agree)} of {len(agree)} genes and worlds"


NOISE: tuple[Item, ...] = (
    Item(
        "noise",
        "Frozen mutation noise",
        "study",
        "The released program draws the mutations of each window from the same small table. Does the table's mean "
        "predict where the weights go, the neutral marker's included?",
        make_noise,
        ARMS,
        SCALE,
    ),
)
