"""The jobs that complete an ensemble: existing worlds are used, short ones are continued, and missing ones started."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hedon.config import Config, digest
from hedon.ensemble.demand import Demand, Past, setting_name
from hedon.ensemble.ensemble import Ensemble, steps_reached
from hedon.experiment.branch import plan_branch, start_branch
from hedon.experiment.plan import Callback, RunPlan, free_folder, seed_span
from hedon.experiment.resume import make, require_setting
from hedon.record.folder import CHECKPOINT_SECONDS, checkpoint_paths, holds_run

LONGEST_NAME = 150
"""Largest number of characters of a condition in the name of a run's folder."""


@dataclass(frozen=True)
class RunJob:
    """A run to start or to continue.

    Attributes:
        plan: Plan of the run, without its number of threads, which is set when it starts.
        world_steps: Steps still to run, summed over its worlds [step].
        past: The past that its worlds continue; None if they start at step 0.
    """

    plan: RunPlan
    world_steps: int
    past: Past | None = None

    @property
    def folder(self) -> Path:
        """The run's folder."""
        return self.plan.out

    @property
    def seeds(self) -> tuple[int, ...]:
        """The seeds of its worlds."""
        return self.plan.seeds

    @property
    def steps(self) -> int:
        """The total number of steps of each world [step]."""
        return self.plan.steps

    @property
    def threads(self) -> int:
        """One for each world."""
        return len(self.plan.seeds)

    @property
    def label(self) -> str:
        """Its name in displays: the name of the folder."""
        return str(self.folder)

    def newest(self) -> str:
        """The name of its last checkpoint; empty if it has none."""
        return max((path.name for path in checkpoint_paths(self.folder)), default="")

    def describe(self) -> str:
        """Its config and seeds."""
        return f"{self.plan.config.name}, seed {', '.join(map(str, self.plan.seeds))}"

    def make(self, threads: int, callback: Callback | None) -> str:
        """Starts, continues, or only reads the run; see `hedon.experiment.resume.make`."""
        plan, callbacks = replace(self.plan, threads=threads), () if callback is None else (callback,)
        if self.past is None or holds_run(plan.out):
            return make(plan, callbacks).status
        past, interval = self.past, plan.checkpoint_seconds
        branch = plan_branch(
            past.run,
            plan.out,
            (),
            past.step,
            plan.steps,
            threads,
            plan.frames,
            interval,
            plan.seeds,
            past.seed,
        )
        return start_branch(branch, callbacks).status


def run_jobs(ensemble: Ensemble, checkpoint_seconds: float = CHECKPOINT_SECONDS) -> list[RunJob]:
    """The runs that are missing or too short, the longest first.

    A world that died out is complete: it counts, and no other world replaces it.

    Args:
        ensemble: The worlds that are needed and those that exist.
        checkpoint_seconds: Time between two checkpoints of a run [s].

    Raises:
        RecordError: The folder with the name of a demand contains a run with other settings.
    """
    jobs: list[RunJob] = []
    for demand in ensemble.demands:
        matching = [run for run in ensemble.runs if demand.holds(run.manifest) and demand.has_frames(run)]
        reached = {run.path: steps_reached(run) for run in matching}
        too_short: dict[Path, int] = {}
        missing: dict[int, list[int]] = {}
        for seed, steps in demand.steps.items():
            holders = [run for run in matching if seed in run.manifest.seeds]
            longest = max(holders, key=lambda run: reached[run.path][seed], default=None)
            if longest is None:
                missing.setdefault(steps, []).append(seed)
            elif reached[longest.path][seed] < steps:
                too_short[longest.path] = max(too_short.get(longest.path, 0), steps)

        for run in matching:
            if (steps := too_short.get(run.path)) is not None:
                steps_left = sum(max(0, steps - int(min(done, steps))) for done in reached[run.path].values())
                jobs.append(_job(demand, run.manifest.seeds, steps, run.path, checkpoint_seconds, steps_left))
        for steps, seeds in missing.items():
            if demand.name:
                require_setting(ensemble.folder / demand.name, demand.digest)
            name = demand.name or f"{folder_name(demand.config)}-{seed_span(seeds)}"
            new_folder = free_folder(ensemble.folder / name, [job.folder for job in jobs])
            steps_left = (steps - (demand.past.step if demand.past else 0)) * len(seeds)
            jobs.append(_job(demand, seeds, steps, new_folder, checkpoint_seconds, steps_left))
    return sorted(jobs, key=lambda job: -job.world_steps)


def _job(demand: Demand, seeds: Sequence[int], steps: int, out: Path, checkpoint: float, steps_left: int) -> RunJob:
    initial, rules = (demand.founders, demand.networks), demand.rules
    plan = RunPlan(demand.config, seeds, steps, out, 0, demand.frames, checkpoint, *initial, rules=rules)
    return RunJob(plan, steps_left, demand.past)


def folder_name(config: Config) -> str:
    """The name of a condition's run, unique to its settings: "baseline-corrected-learning.entropy_coef-0.0"."""
    name = re.sub(r"[^A-Za-z0-9_.-]+", "-", setting_name(config)).replace("--", "-").strip("-")
    # With many changed settings, the name could be longer than file systems allow.
    return name if len(name) <= LONGEST_NAME else f"{config.preset}-{config.fidelity}-{digest(config)[:8]}"
