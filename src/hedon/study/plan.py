"""Plans the runs for some items: existing runs are used, those that are too short are continued, others begin."""

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from hedon.analysis.world.record import read_worlds
from hedon.config import Config, digest
from hedon.experiment.plan import RunPlan, free_folder, seed_span
from hedon.jobs.run import RunJob
from hedon.record.reader import Run
from hedon.study.request import RunRequirement, setting_name

LONGEST_NAME = 150
"""Most characters of a setting in the name of a run's folder."""


def plan_jobs(wanted: Iterable[RunRequirement], runs: Sequence[Run], folder: Path) -> list[RunJob]:
    """The runs that are missing or too short, the longest first.

    A world that died out has all the steps that it can have. It counts, and no other world replaces it.

    Args:
        wanted: the worlds that are needed.
        runs: existing runs.
        folder: where to make new runs.
    """
    jobs: list[RunJob] = []
    for need in wanted:
        mine = [run for run in runs if run.manifest.config_digest == need.digest and need.has_frames(run)]
        reach = {run.path: _reach(run) for run in mine}
        too_short: dict[Path, int] = {}
        missing: dict[int, list[int]] = {}
        for seed, steps in need.steps.items():
            holders = [run for run in mine if seed in run.manifest.seeds]
            longest = max(holders, key=lambda run: reach[run.path][seed], default=None)
            if longest is None:
                missing.setdefault(steps, []).append(seed)
            elif reach[longest.path][seed] < steps:
                too_short[longest.path] = max(too_short.get(longest.path, 0), steps)
        for run in mine:
            if (steps := too_short.get(run.path)) is not None:
                left = sum(max(0, steps - int(min(done, steps))) for done in reach[run.path].values())
                again = RunPlan(need.config, run.manifest.seeds, steps, run.path, founders=need.founders)
                jobs.append(RunJob(again, left))
        for steps, seeds in missing.items():
            name = f"{folder_name(need.config)}-{seed_span(seeds)}"
            free = free_folder(folder / name, [job.folder for job in jobs])
            plan = RunPlan(need.config, seeds, steps, free, frames=need.frames, founders=need.founders)
            jobs.append(RunJob(plan, steps * len(seeds)))
    return sorted(jobs, key=lambda job: -job.world_steps)


def folder_name(config: Config) -> str:
    """A name for the run of a setting that tells it from the others: "baseline-corrected-learning.entropy_coef-0.0"."""
    name = re.sub(r"[^A-Za-z0-9_.-]+", "-", setting_name(config)).replace("--", "-").strip("-")
    # A setting with many changes can make a name longer than file systems allow.
    return name if len(name) <= LONGEST_NAME else f"{config.preset}-{config.fidelity}-{digest(config)[:8]}"


def _reach(run: Run) -> dict[int, float]:
    """Steps that a run has of each seed's world; infinite if the world died out."""
    manifest = run.manifest
    if manifest.status in ("finished", "interrupted"):
        done = [
            math.inf if extinct is not None else steps
            for steps, extinct in zip(manifest.steps_done, manifest.extinct_steps, strict=True)
        ]
        return dict(zip(manifest.seeds, done, strict=True))
    # The manifest of a run that is still running, or was killed, does not say how far it came; its records do.
    reach: dict[int, float] = {}
    for world in read_worlds([run]):  # one for each species
        reach[world.seed] = min(reach.get(world.seed, math.inf), world.recorded_step())
    return reach
