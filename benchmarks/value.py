"""What it takes to keep a world and to go back to it: save, restore, clone."""

from functools import partial

import hedon
from benchmarks.check import require
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, interleave, spread
from benchmarks.plan import Plan

WAYS = ("save", "restore", "clone")


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row for a driven world and for one that learns: bytes, and seconds of each way, a list per way.

    Both are in the middle of their second window, so that the world that learns has all that it ever has.
    """
    config = plan.config()
    window = config.world.rollout_steps
    driven = hedon.make(config, threads=1, repeat=window * 3 // 2, backend=plan.kernel)
    driven.step(driven.actions)
    learning = hedon.Simulation(config, [0], 1, plan.kernel)
    learning.run(window * 3 // 2)
    rows = []
    for name, world, simulation in (
        ("driven", driven, driven.simulation),
        ("learning", learning, learning),
    ):
        kept = world.save()
        before = simulation.worlds[0].digest()
        bodies = {"save": world.save, "restore": partial(world.restore, kept), "clone": world.clone}
        times = interleave(bodies, 4 * plan.repeats)
        require(simulation.worlds[0].digest() == before, f"value: the {name} world is not the one that was saved")
        agents = simulation.worlds[0].alive
        rows.append(
            {"world": name, "agents": agents, "bytes": len(kept), **{f"{way}_seconds": times[way] for way in WAYS}}
        )
    return rows


def table(rows: list[Row], _: Calibration) -> Table:
    """Milliseconds of each way."""
    lines = [
        (
            row["world"],
            str(row["agents"]),
            f"{row['bytes'] / 1e6:.1f}",
            *(spread(row[f"{way}_seconds"], 2, 1e3) for way in WAYS),
        )
        for row in rows
    ]
    return Table(
        "value: one world as bytes, and back", ("world", "agents", "size [MB]", *(f"{way} [ms]" for way in WAYS)), lines
    )
