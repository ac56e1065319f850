"""Plans runs for the worlds that are needed: those that are there are used, too short ones go on, others begin."""

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from hedon.config import Config, digest
from hedon.experiment.plan import RunPlan, free_folder, seed_span
from hedon.experiment.resume import require_setting
from hedon.jobs.requirement import RunRequirement, setting_name, steps_reached
from hedon.jobs.run import RunJob
from hedon.record.folder import CHECKPOINT_SECONDS
from hedon.record.reader import Run

LONGEST_NAME = 150
"""Most characters of a setting in the name of a run's folder."""


def plan_jobs(
    wanted: Iterable[RunRequirement],
    runs: Sequence[Run],
    folder: Path,
    checkpoint_seconds: float = CHECKPOINT_SECONDS,
) -> list[RunJob]:
    """The runs that are missing or too short, the longest first.

    A world that died out has all the steps that it can have. It counts, and no other world replaces it.

    Args:
        wanted: the worlds that are needed.
        runs: existing runs.
        folder: where to make new runs.
        checkpoint_seconds: time between two checkpoints [s].

    Raises:
        RecordError: the folder of a requirement's name holds a run with other settings.
    """
    jobs: list[RunJob] = []
    for need in wanted:
        mine = [run for run in runs if run.manifest.config_digest == need.digest and need.has_frames(run)]
        reach = {run.path: steps_reached(run) for run in mine}
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
                jobs.append(_job(need, run.manifest.seeds, steps, run.path, checkpoint_seconds, left))
        for steps, seeds in missing.items():
            if need.name:
                require_setting(folder / need.name, need.digest)
            name = need.name or f"{folder_name(need.config)}-{seed_span(seeds)}"
            free = free_folder(folder / name, [job.folder for job in jobs])
            jobs.append(_job(need, seeds, steps, free, checkpoint_seconds, steps * len(seeds)))
    return sorted(jobs, key=lambda job: -job.world_steps)


def _job(need: RunRequirement, seeds: Sequence[int], steps: int, out: Path, checkpoint: float, left: int) -> RunJob:
    plan = RunPlan(need.config, seeds, steps, out, 0, need.frames, checkpoint, need.founders, rules=need.rules)
    return RunJob(plan, left)


def folder_name(config: Config) -> str:
    """A name for the run of a setting that tells it from the others: "baseline-corrected-learning.entropy_coef-0.0"."""
    name = re.sub(r"[^A-Za-z0-9_.-]+", "-", setting_name(config)).replace("--", "-").strip("-")
    # A setting with many changes can make a name longer than file systems allow.
    return name if len(name) <= LONGEST_NAME else f"{config.preset}-{config.fidelity}-{digest(config)[:8]}"
