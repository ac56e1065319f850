"""How the time of a step grows with the world: arenas up to 500 times as large, with the same densities."""

import numpy as np

from benchmarks.check import check_world, require
from benchmarks.machine import Calibration, memory_bytes
from benchmarks.measure import Row, Table, median, seconds_of
from benchmarks.plan import Plan, PlanError
from benchmarks.scene import peopled, scene_of
from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_input
from hedon.config.schema.species import ONLY
from hedon.experiment.simulation import Simulation

TILES = ((1, 1), (2, 5), (10, 10), (20, 25))
"""Copies of the preset's arena along x and y: 200, 2,000, 20,000 and 100,000 slots of the baseline."""
QUICK_TILES = ((1, 1), (2, 1))
PIECES = 5
"""Timed pieces."""
TRIALS = 4
"""Single steps before them, in which the engine compares, in turn, the speed of the team and of one member alone."""
MAX_PIECE_STEPS = 200
ROLLOUT_ROWS = 2_400_000
"""Slots times steps: 500 MB of rollouts at every size, and half a million agent-steps per piece."""
PARTS = ("sense_and_act", "physics", "life")


def scaled(plan: Plan, across: int, up: int) -> list[str]:
    """Overrides that give the preset an arena `across` times as wide and `up` times as high, with the same densities.

    Args:
        plan: The plan with the preset.
        across: Factor of the width.
        up: Factor of the height.

    Raises:
        PlanError: The preset has inner walls, or food that does not grow everywhere: its density is not uniform.
    """
    base = plan.config()
    if base.arena.inner_walls or any(food.placement.form != "uniform" for food in base.food.values()):
        raise PlanError(f"growth: {plan.preset} has inner walls or food around centers, so its density is not uniform")
    factor = across * up
    overrides = [
        f"arena.width={base.arena.width * across}",
        f"arena.height={base.arena.height * up}",
        f"population.capacity={base.species[ONLY].population.capacity * factor}",
    ]
    for kind, food in base.food.items():
        overrides += [
            f"food.{kind}.capacity={food.capacity * factor}",
            f"food.{kind}.growth_rate={food.growth_rate * factor}",
            f"food.{kind}.candidates={food.candidates * factor}",
        ]
    return overrides


def scaled_config(plan: Plan, across: int, up: int, steps: int) -> Config:
    """The preset as `scaled` makes it, without learning: a window is one step longer than the timed steps.

    There is one founder and no food, because the scene brings them.

    Args:
        plan: The plan with the preset.
        across: Factor of the width.
        up: Factor of the height.
        steps: Steps that will be run.

    Raises:
        PlanError: As `scaled`.
        ConfigError: The scaled numbers are out of range.
    """
    alone = ["population.initial_count=1", *(f"food.{kind}.initial_count=0" for kind in plan.config().food)]
    window = [f"world.rollout_steps={steps + 1}", f"learning.minibatch_size={steps + 1}"]
    return plan.config(*scaled(plan, across, up), *alone, *window)


def measure(plan: Plan, _: Calibration) -> list[Row]:
    """One row per size and number of threads, smallest and largest; a size without enough memory gets a remark.

    Raises:
        PlanError: The plan asks for an unknown size, or the density of its preset is not uniform.
        CheckError: The state of a world at the end is wrong.
    """
    base = plan.config()
    rows: list[Row] = []
    for slots, (across, up) in sizes(plan).items():
        piece = 4 if plan.quick else max(1, min(MAX_PIECE_STEPS, (ROLLOUT_ROWS // slots - TRIALS) // PIECES))
        config = scaled_config(plan, across, up, TRIALS + piece * PIECES)
        threads = sorted({plan.threads[0], plan.threads[-1]})
        needed, free = bytes_needed(config, threads[-1]), memory_bytes("MemAvailable")
        size = base.species[ONLY].learning.minibatch_size
        steps = config.with_("learning.minibatch_size", 1)
        full = steps.with_("world.rollout_steps", base.world.rollout_steps).with_("learning.minibatch_size", size)
        bare = steps.with_("world.rollout_steps", 1)
        head = {
            "slots": slots,
            "reserved_bytes": needed,
            "bytes_per_slot": bytes_needed(bare, threads[-1]) / slots,
            "bytes_per_slot_with_rollouts": bytes_needed(full, threads[-1]) / slots,
        }
        if needed > free:
            rows.append(
                {**head, "refused": f"needs {needed / 1e9:.1f} GB of memory, but only {free / 1e9:.1f} GB are free"}
            )
            continue
        measured = [_measure_one(plan, config, (across, up), count, piece) for count in threads]
        require(
            len({row["digest"] for row in measured}) == 1,
            f"growth, {slots} slots: the world depends on the number of threads",
        )
        rows += [{**head, **row} for row in measured]
    return rows


def sizes(plan: Plan) -> dict[int, tuple[int, int]]:
    """The tiles that the plan asks for, by numbers of slots.

    Raises:
        PlanError: It asks for a size that there is not.
    """
    capacity = plan.config().species[ONLY].population.capacity
    sizes = {capacity * across * up: (across, up) for across, up in (QUICK_TILES if plan.quick else TILES)}
    for slots in plan.slots or ():
        if slots not in sizes:
            known = ", ".join(str(size) for size in sizes)
            raise PlanError(f"--slots: {slots} is not one of the sizes for {plan.preset}: {known}")
    return {slots: tiles for slots, tiles in sizes.items() if plan.slots is None or slots in plan.slots}


def _measure_one(plan: Plan, config: Config, tiles: tuple[int, int], threads: int, piece: int) -> Row:
    arena = plan.config().arena
    simulation = Simulation(config, [1], threads, plan.kernel)
    scene_of(peopled(plan)).tiled(*tiles, arena.width, arena.height).put_into(simulation)
    world = simulation.worlds[0]
    for _ in range(TRIALS):
        simulation.run(1)
    alive, foods, counters = world.alive, int(world.view("food_stock.present").sum()), world.counters
    agent_steps, pieces = [], []
    parts: dict[str, list[float]] = {part: [] for part in PARTS}
    for _ in range(PIECES):
        counted, seconds = world.counters["agent_steps"], world.seconds
        pieces.append(seconds_of(lambda: simulation.run(piece)))
        agent_steps.append(world.counters["agent_steps"] - counted)
        for part, times in parts.items():
            times.append(world.seconds[part] - seconds[part])
    check_world(world)
    after = world.counters
    return {
        "threads": threads,
        "alive": alive,
        "foods": foods,
        "piece_steps": piece,
        "piece_seconds": pieces,
        "piece_agent_steps": agent_steps,
        **{f"{part}_seconds": times for part, times in parts.items()},
        **{name: after[name] - counters[name] for name in ("births", "deaths")},
        "digest": world.digest(),
    }


def bytes_needed(config: Config, threads: int) -> int:
    """Memory that one world reserves [byte]."""
    given = engine_input(config)
    return sum(_engine.memory_needed(given.settings, len(given.walls), 1, threads).values())


def table(rows: list[Row], _: Calibration) -> Table:
    """Nanoseconds per agent and step."""
    headings = ("slots", "threads", "alive", "foods", "step [ms]", "agent-step [ns]", "sense+act", "physics", "life")
    headings += ("bytes/agent", "with rollouts")
    lines, notes = [], []
    for row in rows:
        slots = f"{row['slots']:,}"
        if "refused" in row:
            notes.append(f"{slots} slots: skipped, {row['refused']}.")
            continue
        lines.append(
            (
                slots,
                str(row["threads"]),
                f"{row['alive']:,}",
                f"{row['foods']:,}",
                f"{median(row['piece_seconds']) / row['piece_steps'] * 1e3:.3f}",
                *(_per_agent_step(row, name) for name in ("piece", *PARTS)),
                f"{row['bytes_per_slot']:,.0f}",
                f"{row['bytes_per_slot_with_rollouts']:,.0f}",
            )
        )
    notes.append("Parts in ns per agent-step, medians of pieces. Bytes are those reserved per slot.")
    return Table("growth: one world without learning, at equal density", headings, lines, tuple(notes))


def _per_agent_step(row: Row, name: str) -> str:
    return f"{np.median(np.array(row[f'{name}_seconds']) / row['piece_agent_steps']) * 1e9:,.0f}"
