"""Worlds in which every slot is taken by a founder that learns: time to make one, and a window with its learning."""

from benchmarks.check import check_world, require
from benchmarks.growth import scaled, sizes
from benchmarks.machine import Calibration
from benchmarks.measure import Row, Table, seconds_of
from benchmarks.plan import Plan
from hedon.config.config import Config
from hedon.experiment.memory import MemoryNeedError, require_memory
from hedon.experiment.simulation import Simulation

PARTS = ("sense_and_act", "physics", "life", "learning")


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per size and number of threads, smallest and largest; a size without enough memory gets a remark.

    Raises:
        PlanError: The plan asks for an unknown size, or the density of its preset is not uniform.
        CheckError: The state of a world at the end is wrong.
    """
    rows: list[Row] = []
    for slots, (across, up) in sizes(plan).items():
        foods = plan.config().food.items()
        first = [f"food.{kind}.initial_count={food.initial_count * across * up}" for kind, food in foods]
        config = plan.config(*scaled(plan, across, up), f"population.initial_count={slots}", *first)
        try:
            require_memory(config, 1, plan.threads[-1])
        except MemoryNeedError as error:
            rows.append({"slots": slots, "refused": str(error)})
            continue
        threads = sorted({plan.threads[0], plan.threads[-1]})
        measured = [_measure_one(plan, config, count) for count in threads]
        require(len({row["digest"] for row in measured}) == 1, f"crowd, {slots} slots: it depends on the threads")
        rows += [{"slots": slots, **row} for row in measured]
    return rows


def _measure_one(plan: Plan, config: Config, threads: int) -> Row:
    made: list[Simulation] = []
    making = seconds_of(lambda: made.append(Simulation(config, [1], threads, plan.kernel)))
    simulation, world = made[0], made[0].worlds[0]
    seconds = seconds_of(lambda: simulation.run(config.world.rollout_steps))
    check_world(world)
    return {
        "threads": threads,
        "making_seconds": making,
        "window_seconds": seconds,
        "agent_steps": world.counters["agent_steps"],
        "learners": world.counters["learners"],
        **{f"{part}_seconds": world.seconds[part] for part in PARTS},
        "digest": world.digest(),
    }


def table(rows: list[Row], _: Calibration) -> Table:
    """Agent-steps per second, with learning, and nanoseconds of each part."""
    headings = ("agents", "threads", "making [s]", "window [s]", "agent-steps/s", *(f"{part} [ns]" for part in PARTS))
    lines = [
        (
            f"{row['slots']:,}",
            str(row["threads"]),
            f"{row['making_seconds']:.1f}",
            f"{row['window_seconds']:.1f}",
            f"{row['agent_steps'] / row['window_seconds']:,.0f}",
            *(f"{row[f'{part}_seconds'] / row['agent_steps'] * 1e9:,.0f}" for part in PARTS),
        )
        for row in rows
        if "refused" not in row
    ]
    notes = tuple(f"{row['slots']:,} agents: skipped: {row['refused']}." for row in rows if "refused" in row)
    return Table("crowd: the first window of a world full of learning founders", headings, lines, notes)
