"""Whole worlds with learning: steps per second, the time of each part, and the ratio to the floor."""

from dataclasses import asdict

import numpy as np

from benchmarks.check import check_same_lives, check_world
from benchmarks.floor import step_floor
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, median, seconds_of
from benchmarks.plan import Plan
from benchmarks.scene import go_on_from_peopled
from hedon.experiment.simulation import Simulation

PARTS = ("sense_and_act", "physics", "life", "learning")


def measure(plan: Plan, calibration: Calibration) -> list[Row]:
    """One row per number of threads and worlds, and one with one world for each further instruction set.

    All continue from the same populated world, each with its own seed, and are timed in turn, window by window.
    """
    config = plan.config()
    cases = [(plan.kernel, *case) for case in plan.cases()]
    cases += [(kernel, plan.threads[-1], 1) for kernel in plan.kernels[1:]]
    simulations = [Simulation(config, range(1, worlds + 1), threads, kernel) for kernel, threads, worlds in cases]
    window = config.world.rollout_steps
    for simulation in simulations:
        go_on_from_peopled(plan, simulation)
        simulation.run(window)

    begun = [_counted(simulation) for simulation in simulations]
    alive: list[list[float]] = [[] for _ in simulations]
    seconds: list[list[float]] = [[] for _ in simulations]
    for _ in range(plan.windows):
        for i, simulation in enumerate(simulations):
            seconds[i].append(seconds_of(lambda s=simulation: s.run(window)))
            alive[i].append(float(np.mean([world.alive for world in simulation.worlds])))
    for simulation in simulations:
        for world in simulation.worlds:
            check_world(world)
    check_same_lives(simulations)

    rows = []
    for (kernel, threads, worlds), simulation, first, times, living in zip(
        cases, simulations, begun, seconds, alive, strict=True
    ):
        counted = {name: value - first[name] for name, value in _counted(simulation).items()}
        steps = window * plan.windows
        learners = counted["learners"] / plan.windows
        floor = step_floor(
            config,
            float(np.mean(living)),
            learners,
            calibration.multiply_add_gflops[kernel][threads],
            calibration.cache_read_gbytes_per_s[threads],
        )
        rows.append(
            {
                "kernel": kernel,
                "threads": threads,
                "worlds": worlds,
                "window_steps": window,
                "window_seconds": times,
                "alive": living,
                "learners_per_window": learners,
                **{f"{part}_seconds_per_step": counted[part] / steps for part in PARTS},
                **{f"floor_{name}": value for name, value in asdict(floor).items()},
                "digests": [world.digest() for world in simulation.worlds],
                "bytes_per_world": simulation.engine.bytes_per_world,
            }
        )
    return rows


def _counted(simulation: Simulation) -> dict[str, float]:
    """Seconds of each part, and learners, so far; means over the worlds."""
    seconds = {part: float(np.mean([world.seconds[part] for world in simulation.worlds])) for part in PARTS}
    return {**seconds, "learners": float(np.mean([world.counters["learners"] for world in simulation.worlds]))}


def table(rows: list[Row], _: Calibration) -> Table:
    """Milliseconds per step and world-steps per second."""
    headings = ("kernel", "threads", "worlds", "alive", "learners", "sense+act", "physics", "life", "learning")
    headings += ("steps/s", "lowest", "highest", "floor", "x floor")
    lines = []
    for row in rows:
        rates = [row["window_steps"] * row["worlds"] / t for t in row["window_seconds"]]
        floor = row["floor_learning_seconds"] + row["floor_forward_seconds"]
        lines.append(
            (
                row["kernel"],
                str(row["threads"]),
                str(row["worlds"]),
                f"{np.mean(row['alive']):.0f}",
                f"{row['learners_per_window']:.0f}",
                *(f"{row[f'{part}_seconds_per_step'] * 1e3:.3f}" for part in PARTS),
                f"{median(rates):,.0f}",
                f"{min(rates):,.0f}",
                f"{max(rates):,.0f}",
                f"{floor * 1e3:.3f}",
                f"{1 / median(rates) / floor:.2f}",
            )
        )
    learning = rows[0]["floor_learning_seconds"] * 1e3
    forward = rows[0]["floor_forward_seconds"] * 1e3
    notes = (
        "Parts in ms per step of one world, on its own threads; steps/s are steps of all worlds together.",
        f"floor [ms per step]: products of learning and reads of weights for acting, at the machine's rates (first line"
        f" {learning:.3f} + {forward:.3f}); rays, physics and life are counted as 0.",
        "x floor: the time of a step as a multiple of its floor.",
    )
    return Table("world: whole worlds with learning", headings, lines, notes)
