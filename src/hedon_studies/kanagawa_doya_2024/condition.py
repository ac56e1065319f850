"""The paper's conditions as arms of items, and the scale at which it ran them."""

from hedon.study.item import Arm, Scale
from hedon_studies.kanagawa_doya_2024.paper import SEEDS, STEPS

PAPER_SCALE = Scale(tuple(range(1, SEEDS + 1)), STEPS)
BASELINE = Arm("baseline")
SIZES = (Arm("small", "small"), BASELINE, Arm("large", "large"))
"""Arenas, from the smallest on."""
PLACES = (Arm("uniform"), Arm("centered", "centered"), Arm("relocation", "relocation"))
"""Places of food: anywhere, around the center, and around one of four places, which moves on."""
POOR = Arm("poor", "poor")
POISON = Arm("poison", "poison")
