"""The paper's conditions, and the number and length of its worlds."""

from hedon.study import Condition, Scale
from hedon_studies.kanagawa_doya_2024.paper import SEEDS, STEPS

PAPER_SCALE = Scale(tuple(range(1, SEEDS + 1)), STEPS)
BASELINE = Condition("baseline")
SIZES = (Condition("small", "small"), BASELINE, Condition("large", "large"))
"""Arenas, from small to large."""
PLACES = (Condition("uniform"), Condition("centered", "centered"), Condition("relocation", "relocation"))
"""Places of food: anywhere, around the center, and around one of four places, which changes."""
POOR = Condition("poor", "poor")
POISON = Condition("poison", "poison")
