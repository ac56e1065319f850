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
    begin = f"The run {run.path.name} has not finished (status {run.manifest.status})"
    ends = [int(world.population["step"].to_numpy().max(initial=0)) for world in worlds]
    shown = max(ends, default=0)
    known = [world.recorded_step() for world in worlds]
    behind = [step for step, end in zip(known, ends, strict=True) if step < end]
    if not behind or run.damaged_parts():
        return f"{begin}: this is of what its records hold up to step {shown:,}."
    return (
        f"{begin}: births, deaths, foods eaten and agents alive are those up to step {shown:,}; lifetimes, weights and "
        f"whatever else is of single agents, those up to step {min(behind):,}."
    )
