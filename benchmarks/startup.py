"""How long a user waits for the first step, from the start of a new process."""

import json
import subprocess
import sys
import time

from benchmarks.check import require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, spread
from benchmarks.plan import Plan

REPEATS = 7
STAGES = ("interpreter", "imports", "config", "world", "first_step")
PROGRAM = """
import sys, time
seen = [time.monotonic()]
import hedon.cli.main, hedon.cli.display.run, hedon.experiment.run
from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation
seen.append(time.monotonic())
config = load_config(sys.argv[1])
seen.append(time.monotonic())
simulation = Simulation(config, [1], int(sys.argv[2]))
seen.append(time.monotonic())
simulation.run(1)
seen.append(time.monotonic())
print([*seen, simulation.worlds[0].step])
"""
"""Loads what `hedon run` loads. All processes of a machine share the clock."""


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row: seconds of each stage, a list per stage."""
    stages: dict[str, list[float]] = {stage: [] for stage in STAGES}
    command = [sys.executable, "-c", PROGRAM, plan.preset, str(plan.threads[-1])]
    for _repeat in range(1 if plan.quick else REPEATS):
        last = time.monotonic()
        answer = subprocess.run(command, capture_output=True, text=True, check=False)
        require(answer.returncode == 0, f"startup: the process failed: {answer.stderr.strip()}")
        *seen, step = json.loads(answer.stdout)
        require(step == 1, f"startup: the world is at step {step}, not 1")
        for stage, now in zip(STAGES, seen, strict=True):
            stages[stage].append(now - last)
            last = now
    return [{"threads": plan.threads[-1], **{f"{stage}_seconds": times for stage, times in stages.items()}}]


def table(rows: list[Row], _: Calibration) -> Table:
    """Milliseconds of each stage and of all."""
    times = [rows[0][f"{stage}_seconds"] for stage in STAGES]
    total = [sum(stages) for stages in zip(*times, strict=True)]
    headings = ("first step after [ms]", *(stage.replace("_", " ") for stage in STAGES))
    line = (spread(total, 0, 1e3), *(spread(stage, 0, 1e3) for stage in times))
    return Table("startup: from the start of a process to its first step", headings, [line])
