"""The job of making one run."""

from dataclasses import dataclass, replace
from pathlib import Path

from hedon.experiment.plan import Display, RunPlan
from hedon.experiment.resume import make
from hedon.record.folder import holds_run


@dataclass(frozen=True)
class RunJob:
    """A run to begin or to continue.

    Attributes:
        plan: of the run; its threads are given when it begins.
        world_steps: steps still to run, summed over its worlds [step].
    """

    plan: RunPlan
    world_steps: int

    @property
    def folder(self) -> Path:
        """Of the run."""
        return self.plan.out

    @property
    def threads(self) -> int:
        """One for each world."""
        return len(self.plan.seeds)

    @property
    def begun(self) -> bool:
        """Whether there is a run to continue."""
        return holds_run(self.folder)

    def make(self, threads: int, display: Display | None) -> str:
        """Begins, continues, or only reads the run; see `hedon.experiment.resume.make`."""
        return make(replace(self.plan, threads=threads), display).status
