"""Times whole worlds, part by part, beside what the machine can do in the same minute.

A world is first run until it is well peopled, then timed. Run `uv run python benchmarks/world.py`; compare figures only
within one run, since machines are shared. The end state is checked before anything is printed.
"""

import argparse
import resource
import threading
import time

import numpy as np

from hedon import _engine
from hedon.config.load import load_config
from hedon.experiment.simulation import Simulation

CALIBRATION_ROUNDS = 2_000_000
COPY_BYTES = 1 << 28


def multiply_add_rate(kernel: str, threads: int) -> float:
    """Float32 multiply-adds in registers, all threads together [GF/s]."""
    rates = [0.0] * threads

    def measure(index: int) -> None:
        rates[index] = _engine.kernel.calibrate(kernel, CALIBRATION_ROUNDS)

    workers = [threading.Thread(target=measure, args=(i,)) for i in range(threads)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return sum(rates)


def copy_rate() -> float:
    """Memory copied on one thread [GB/s]."""
    source, target = np.ones(COPY_BYTES, np.uint8), np.empty(COPY_BYTES, np.uint8)
    times = []
    for _ in range(4):
        before = time.perf_counter()
        np.copyto(target, source)
        times.append(time.perf_counter() - before)
    return COPY_BYTES / min(times) / 1e9


def check(simulation: Simulation) -> None:
    """Raises where a world is not what it should be at the end."""
    for world in simulation.worlds:
        agents, arena = world.agents(), world.config.arena
        inside = (agents["x"] > 0) & (agents["x"] < arena.width) & (agents["y"] > 0) & (agents["y"] < arena.height)
        finite = all(np.isfinite(world.view(name)).all() for name in ("params", "first_moment", "second_moment"))
        if world.extinct or not inside.all() or not finite:
            raise RuntimeError(f"the world of seed {world.seed} did not end as it should")


def main() -> None:
    """Prints a table of parts and rates."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--preset", default="baseline")
    parser.add_argument("--worlds", type=int, default=1)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--kernel", default="")
    parser.add_argument("--warm-up", type=int, default=20, help="windows before the clock starts")
    parser.add_argument("--windows", type=int, default=10, help="windows that are timed")
    options = parser.parse_args()

    config = load_config(options.preset)
    simulation = Simulation(config, range(1, options.worlds + 1), options.threads, options.kernel)
    window = config.learning.rollout_steps
    simulation.run(options.warm_up * window)
    world = simulation.worlds[0]
    rates, alive, learners = [], [], world.counters["learners"]
    before = world.seconds
    for _ in range(options.windows):
        begun = time.perf_counter()
        simulation.run(window)
        rates.append(window * options.worlds / (time.perf_counter() - begun))
        alive.append(np.mean([each.alive for each in simulation.worlds]))
    after = world.seconds
    learners = (world.counters["learners"] - learners) / options.windows
    check(simulation)

    engine, steps = simulation.engine, options.windows * window
    print(f"{options.preset}, {options.worlds} worlds, {engine.threads} threads, kernel {engine.kernel}")
    print(f"alive {np.mean(alive):.0f}, learners per window {learners:.0f}, {steps:,} steps timed")
    for part in after:
        print(f"  {part:14s} {1e3 * (after[part] - before[part]) / steps:7.3f} ms per step")
    low, median, high = np.min(rates), np.median(rates), np.max(rates)
    print(f"world-steps/s: median {median:,.0f} (lowest window {low:,.0f}, highest {high:,.0f})")
    fma = [multiply_add_rate(engine.kernel, threads) for threads in (1, 2)]
    print(f"machine: multiply-add {fma[0]:.0f} GF/s on 1 thread, {fma[1]:.0f} on 2; copy {copy_rate():.1f} GB/s")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"memory: {engine.bytes_per_world / 1e6:.1f} MB per world reserved; peak of this process {peak:.0f} MB")


if __name__ == "__main__":
    main()
