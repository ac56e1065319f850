"""Makes the runs of an assay: those that are there are used or continued, others begin."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hedon.experiment.plan import Display, RunPlan
from hedon.experiment.resume import is_finished, make, require_same
from hedon.record.folder import holds_run
from hedon.record.manifest import Manifest
from hedon.record.reader import Run, open_run

Show = Callable[[RunPlan, Callable[[Display], Manifest]], Manifest]
"""Shows the progress of a run while a function makes it."""


@dataclass(frozen=True)
class AssayRuns:
    """The runs of an assay.

    Attributes:
        runs: in the order of the plans, as far as they were made.
        finished: whether all are.
    """

    runs: tuple[Run, ...]
    finished: bool


def conduct(plans: Sequence[RunPlan], show: Show) -> AssayRuns:
    """Makes runs one after the other; stops where one is interrupted.

    Args:
        plans: of the runs; each folder is empty, or holds the same run.
        show: how the progress of a run is shown.

    Raises:
        RecordError: A folder holds a run with other settings, founders or seeds.
        HedonError: As `run` and `resume`.
    """
    for plan in plans:
        require_same(plan)
    made: list[Run] = []
    for plan in plans:
        manifest = _make(plan, show)
        made.append(open_run(plan.out))
        if manifest.status != "finished":
            return AssayRuns(tuple(made), finished=False)
    return AssayRuns(tuple(made), finished=True)


def _make(plan: RunPlan, show: Show) -> Manifest:
    if holds_run(plan.out) and is_finished(manifest := open_run(plan.out).manifest, plan.steps):
        return manifest
    return show(plan, lambda display: make(plan, display))
