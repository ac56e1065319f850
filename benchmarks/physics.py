"""Time of one physics step in a full arena, on one and more threads.

150 bodies and 100 circles in the baseline arena (480 × 360 u, 20 walls), driven by motor forces that change
every 20 steps. The end state must be finite, inside the arena and the same for every number of threads.

Run: python benchmarks/physics.py [steps] [bodies]
"""

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from physics_scene import arena_walls, crowd, drive, read

CHUNK = 20


def measure(steps, bodies, threads, circles=100):
    """Seconds per step (best and median over chunks), contacts per substep, and the end state."""
    scene = crowd(7, bodies, circles)
    rng = np.random.default_rng(8)
    times = []
    for _ in range(steps // CHUNK):
        forces = rng.uniform(-20.0, 80.0, (2, bodies))
        drive(scene, forces[0], forces[1])
        start = time.perf_counter()
        scene.step(CHUNK, threads, record=False)
        times.append((time.perf_counter() - start) / CHUNK)
    builds = scene.counters()["builds"]
    listed = sum(len(scene.pairs(kind)) for kind in ("body", "circle", "wall"))
    scene.step(1, threads)
    contacts = sum(1 if row[0] else 0.5 for row in scene.contacts()) / 5
    return np.array(times), contacts, listed, builds / len(times) / CHUNK, read(scene)


def check(state):
    """Raises if a number is not finite or a body stands deeper in a wall than the solver may leave it."""
    if not np.isfinite(state).all():
        raise SystemExit("not finite")
    for ax, ay, bx, by in arena_walls():
        length = np.hypot(bx - ax, by - ay)
        inward = ((bx - ax) * (state[1] - ay) - (by - ay) * (state[0] - ax)) / length
        if inward.min() < 9.0:
            raise SystemExit(f"a body is {10.0 - inward.min():.2f} u deep in a wall")


def main():
    """Measures and prints one line per number of threads."""
    steps = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    bodies = int(sys.argv[2]) if len(sys.argv) > 2 else 150
    first = None
    for threads in (1, 2):
        times, contacts, listed, builds, state = measure(steps, bodies, threads)
        check(state)
        if first is not None and not np.array_equal(first, state):
            raise SystemExit("the end state depends on the number of threads")
        first = state
        print(
            f"{bodies} bodies, {threads} threads: {1e3 * np.median(times):.4f} ms per step, "
            f"best {1e3 * times.min():.4f}; "
            f"{contacts:.0f} contacts of {listed} listed pairs, {builds:.2f} rebuilds per step"
        )


if __name__ == "__main__":
    main()
