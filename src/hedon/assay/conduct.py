"""Makes the runs of an assay: those that are there are used or continued, others begin."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hedon.experiment.plan import Display, RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.record.error import RecordError
from hedon.record.folder import holds_run
from hedon.record.manifest import Manifest
from hedon.record.reader import Run, open_run
from hedon.text import brief

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

    Raises:
        RecordError: A folder holds a run with other settings, founders or seeds.
        HedonError: As `run` and `resume`.
    """
    for plan in plans:
        _require_same(plan)
    made: list[Run] = []
    for plan in plans:
        manifest = _make(plan, show)
        made.append(open_run(plan.out))
        if manifest.status != "finished":
            return AssayRuns(tuple(made), finished=False)
    return AssayRuns(tuple(made), finished=True)


def _make(plan: RunPlan, show: Show) -> Manifest:
    if not holds_run(plan.out):
        return show(plan, lambda display: run(plan, display))
    manifest = open_run(plan.out).manifest
    over = bool(manifest.extinct_steps) and None not in manifest.extinct_steps
    if manifest.status == "finished" and (over or max(manifest.steps_done) >= plan.steps):
        return manifest
    steps, threads, seconds = max(plan.steps, *manifest.steps_done, 1), plan.threads, plan.checkpoint_seconds
    return show(plan, lambda display: resume(plan.out, steps, threads, display, seconds))


def _require_same(plan: RunPlan) -> None:
    if not holds_run(plan.out):
        return
    from hedon.config.dump import digest

    manifest = open_run(plan.out).manifest
    if manifest.config_digest != digest(plan.config) or manifest.seeds != plan.seeds:
        raise RecordError(
            f"{brief(str(plan.out))} holds a run with other settings, founders or seeds than this assay: "
            "give another folder with --out"
        )
