"""How many independent worlds a number needs before it is shown: the one table for tools, scoreboards and guides."""

FOR_INTERVAL = 5
"""Worlds from which a confidence interval over worlds is shown; below it, the output says how many are needed."""
FOR_VERDICT = 30
"""Worlds, or pairs of worlds, from which a study answers yes or no."""
FOR_FULL_LENGTH = 6
"""Worlds from which a claim about full-length runs gets a verdict: six that agree bound a share above one half."""


def worlds_needed_note(worlds: int, needed: int = FOR_INTERVAL) -> str:
    """Why a number is withheld: "needs 5 worlds, has 3"; empty if there are enough."""
    return "" if worlds >= needed else f"needs {needed} worlds, has {worlds}"
