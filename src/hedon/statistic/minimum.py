"""How many independent worlds a number needs before it is shown: the one source for tools, scoreboards and guides."""

FOR_INTERVAL = 5
"""Smallest number of worlds for a confidence interval over worlds; with fewer, the output states how many it needs."""
FOR_VERDICT = 30
"""Smallest number of worlds, or pairs of worlds, with which a study answers yes or no."""
FOR_FULL_LENGTH = 6
"""Smallest number of worlds for a verdict on full-length runs: if six agree, the share is bounded above one half."""


def worlds_needed_note(worlds: int, needed: int = FOR_INTERVAL) -> str:
    """Why a number is withheld: "needs 5 worlds, has 3"; empty if there are enough."""
    return "" if worlds >= needed else f"needs {needed} worlds, has {worlds}"
