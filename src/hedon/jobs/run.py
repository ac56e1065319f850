"""The job of making one run."""

from dataclasses import dataclass, replace
from pathlib import Path

from hedon.experiment.plan import Display, RunPlan
from hedon.experiment.resume import make
from hedon.record.folder import checkpoint_paths


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
        """The run's folder."""
        return self.plan.out

    @property
    def seeds(self) -> tuple[int, ...]:
        """Of its worlds."""
        return self.plan.seeds

    @property
    def steps(self) -> int:
        """Of each world in the end [step]."""
        return self.plan.steps

    @property
    def threads(self) -> int:
        """One for each world."""
        return len(self.plan.seeds)

    def newest(self) -> str:
        """The name of its last checkpoint; empty where there is none."""
        return max((path.name for path in checkpoint_paths(self.folder)), default="")

    def describe(self) -> str:
        """Its config and seeds."""
        return f"{self.plan.config.name}, seed {', '.join(map(str, self.plan.seeds))}"

    def make(self, threads: int, display: Display | None) -> str:
        """Begins, continues, or only reads the run; see `hedon.experiment.resume.make`."""
        return make(replace(self.plan, threads=threads), display).status
