"""Whole worlds with learning on a device: steps per second over numbers of worlds, and the time of each kernel."""

import numpy as np

from benchmarks.check import check_world, require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, median, seconds_of
from benchmarks.plan import Plan
from benchmarks.scene import go_on_from_peopled
from hedon.experiment.memory import memory_needed, memory_present
from hedon.experiment.simulation import Simulation

WORLDS = (1, 16, 64, 128, 256, 512)
KERNELS = ("step", "learn", "close", "copying")


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per number of worlds that this machine's memory can hold. All continue from the same populated world.

    The first world of each row must have the digest that the processor gives it.
    """
    config = plan.config()
    window = config.world.rollout_steps
    expected = _digest_here(plan)
    rows = []
    for worlds in plan.worlds or ((1, 2) if plan.quick else WORLDS):
        if sum(memory_needed(config, worlds).values()) > memory_present():
            continue
        simulation = Simulation(config, range(1, worlds + 1), backend=plan.device)
        go_on_from_peopled(plan, simulation)
        simulation.run(window)
        begun = simulation.engine.device_seconds
        seconds, alive = [], []
        for _window in range(plan.windows):
            seconds.append(seconds_of(lambda s=simulation: s.run(window)))
            alive.append(float(np.mean([world.alive for world in simulation.worlds])))
        ended = simulation.engine.device_seconds
        check_world(simulation.worlds[0])
        digest = simulation.worlds[0].digest()
        require(digest == expected, f"the first of {worlds} worlds on {plan.device} is not as on the processor")
        rows.append(
            {
                "kernel": plan.device,
                "devices": simulation.engine.device_count,
                "worlds": worlds,
                "window_steps": window,
                "window_seconds": seconds,
                "alive": alive,
                **{f"{name}_seconds": ended[name] - begun[name] for name in KERNELS},
                "digest": digest,
                "bytes_per_world": simulation.engine.bytes_per_world,
            }
        )
    return rows


def _digest_here(plan: Plan) -> str:
    """What the processor makes of the first world."""
    simulation = Simulation(plan.config(), [1], plan.threads[-1], plan.kernel)
    go_on_from_peopled(plan, simulation)
    simulation.run((plan.windows + 1) * plan.config().world.rollout_steps)
    return simulation.worlds[0].digest()


def table(rows: list[Row], _: Calibration) -> Table:
    """World-steps per second, and microseconds per world-step of each kernel."""
    headings = (
        "device",
        "devices",
        "worlds",
        "alive",
        "step",
        "learn",
        "close",
        "copying",
        "world-steps/s",
        "lowest",
        "highest",
    )
    lines = []
    for row in rows:
        rates = [row["window_steps"] * row["worlds"] / seconds for seconds in row["window_seconds"]]
        steps = row["window_steps"] * row["worlds"] * len(row["window_seconds"])
        lines.append(
            (
                row["kernel"],
                str(row["devices"]),
                str(row["worlds"]),
                f"{np.mean(row['alive']):.0f}",
                *(f"{row[f'{name}_seconds'] / steps * 1e6:.3f}" for name in KERNELS),
                *(f"{rate:,.0f}" for rate in (median(rates), min(rates), max(rates))),
            )
        )
    notes = (
        "Kernels and copies in µs per step of one world, summed over devices. The first world has the processor's "
        "bits.",
        "Numbers of worlds that do not fit into this machine's memory are left out.",
    )
    return Table("device: whole worlds with learning", headings, lines, notes)
