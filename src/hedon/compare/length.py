"""The step at which runs of different lengths are compared, and why."""

from collections.abc import Sequence
from dataclasses import dataclass

_STATES = {"running": "is still running or was killed", "interrupted": "was interrupted", "failed": "failed"}
"""What the status of an unfinished run means."""
MOST_NAMED = 4
"""Largest number of runs in the sentence."""


@dataclass(frozen=True)
class RunLength:
    """The length of a run.

    Attributes:
        name: Its folder, as the user named it.
        steps: Last step that its records cover for all of its worlds [step].
        status: Status in its manifest.
    """

    name: str
    steps: int
    status: str


def step_sentence(step: int | None, lengths: Sequence[RunLength]) -> str:
    """At which step worlds are compared; the reason too if runs differ in length or one of them has not finished.

    Args:
        step: The step at which they are compared [step]; None if the source does not know it.
        lengths: Lengths of the runs that hold the worlds; none for other sources.

    Returns:
        The sentence; empty if the step is unknown.
    """
    if step is None:
        return ""
    unfinished = [each for each in lengths if each.status in _STATES]
    longer = [each for each in lengths if each.status not in _STATES and each.steps > step]
    reasons = [_reason(each, step) for each in (*unfinished, *longer)]
    if len(reasons) > MOST_NAMED:
        others = f"and {len(reasons) - MOST_NAMED + 1} other runs are longer or unfinished"
        reasons = [*reasons[: MOST_NAMED - 1], others]
    shortest = ", the length of the shortest" if any(each.steps > step for each in lengths) else ""
    return f"Compared at step {step:,}{shortest}{': ' if reasons else ''}{'; '.join(reasons)}."


def _reason(run: RunLength, step: int) -> str:
    """What is special about a run: that it has not finished, or has more steps."""
    more = f"has {run.steps:,}" if run.steps > step else ""
    return f"{run.name} {' and '.join(filter(None, (_STATES.get(run.status), more)))}"
