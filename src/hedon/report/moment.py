"""The notice at the top of the report of an unfinished run: which steps its numbers cover."""

from collections.abc import Iterable, Sequence

from hedon.analysis.world.record import Conditions, WorldRecord
from hedon.record.reader import Run


def unfinished(runs: Iterable[Run], conditions: Conditions) -> list[str]:
    """A sentence for each run that has not finished.

    Rows of intervals and rows of agents are written at different times, so the two tables of such a run may cover
    different steps.
    """
    worlds = [world for group in conditions.values() for world in group]
    return [
        _sentence(run, [world for world in worlds if world.run == run.path.name])
        for run in runs
        if run.manifest.status != "finished"
    ]


def _sentence(run: Run, worlds: Sequence[WorldRecord]) -> str:
    opening = f"The run {run.path.name} has not finished (status {run.manifest.status})"
    last_steps = [int(world.population["step"].to_numpy().max(initial=0)) for world in worlds]
    latest_step = max(last_steps, default=0)
    recorded_steps = [world.recorded_step() for world in worlds]
    lagging = [step for step, end in zip(recorded_steps, last_steps, strict=True) if step < end]
    if not lagging or run.damaged_parts():
        return f"{opening}: this is of what its records hold up to step {latest_step:,}."
    return (
        f"{opening}: births, deaths, foods eaten and agents alive are those up to step {latest_step:,}; lifetimes, "
        f"weights and whatever else is of single agents, those up to step {min(lagging):,}."
    )
