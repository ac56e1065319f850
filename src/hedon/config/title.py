"""Titles of genes for readers."""

from collections.abc import Sequence

from hedon.config.layout import EXTRA

_ADJECTIVES = ("normal", "poor")
"""Names of food kinds in presets that need a noun."""


def weight_titles(reward_names: Sequence[str], neutral_names: Sequence[str]) -> dict[str, str]:
    """Titles of weights' panels: those in the reward, and the first neutral gene."""
    return {name: weight_title(name) for name in reward_names} | dict.fromkeys(neutral_names[:1], "neutral gene")


def weight_title(name: str) -> str:
    """Title of a gene: the weight of action, of a food or another term, of seeing or smelling, or else its name."""
    for ending, words in (("_old", ", when old"), ("_scale", ", power of ten")):
        if name.startswith("w_") and name.endswith(ending):
            return weight_title(name.removesuffix(ending)) + words
    if name == "w_action":
        return "weight of action"
    if name.startswith(EXTRA):
        return f"{name.removeprefix(EXTRA)}, read by a rule"
    if name.startswith("g_"):
        return f"{name.removeprefix('g_').replace('_', ' ')}, power of ten"
    subject = name.removeprefix("w_")
    for start, words in (("see_", "seeing"), ("smell_", "smelling")):
        if subject.startswith(start):
            return f"weight of {words} {subject.removeprefix(start)}"
    if subject in _ADJECTIVES:
        subject += " food"
    return f"weight of {subject.replace('_', ' ')}" if name.startswith("w_") else f"gene {name}"
