"""How many independent worlds a number needs before it is shown: the one source for tools, scoreboards and guides."""

FOR_INTERVAL = 5
"""Smallest number of worlds for a confidence interval over worlds; with fewer, the output states how many it needs."""
FOR_PAIRS = 6
"""Smallest number of pairs of worlds for which a sign-flip test can have a p value below 0.05: 2 / 2⁶ is 0.03."""
FOR_VERDICT = 30
"""Smallest number of worlds, or pairs of worlds, with which a study answers yes or no."""
FOR_FULL_LENGTH = 6
"""Smallest number of worlds for a verdict on full-length runs: if six agree, the share is bounded above one half."""


def worlds_needed_note(worlds: int, needed: int = FOR_INTERVAL) -> str:
    """Why a number is withheld: "needs 5 worlds, has 3"; empty if there are enough."""
    return "" if worlds >= needed else f"needs {needed} worlds, has {worlds}"


def few_seeds_note(seeds: int, *, compared: bool) -> str:
    """What an experiment with few seeds cannot show, for a note before it runs; empty if there are enough.

    Args:
        seeds: Number of seeds of each condition.
        compared: Whether conditions are compared, in pairs of equal seeds.
    """
    needs = {"intervals": FOR_INTERVAL} | ({"differences between conditions": FOR_PAIRS} if compared else {})
    lacking = [f"{purpose} need {needed}" for purpose, needed in needs.items() if seeds < needed]
    if not lacking:
        return ""
    number = f"{seeds} {'seed' if seeds == 1 else 'seeds'}{' per condition' if compared else ''}"
    return f"{number}: {', and '.join(lacking)}. You can add seeds later; finished worlds are kept."
