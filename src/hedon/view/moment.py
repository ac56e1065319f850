"""The part of the page's link that leads to a moment of a run."""

from hedon.record.reader import Run
from hedon.view.page import ViewError


def fragment(run: Run, step: int | None, seed: int | None, agent: int | None) -> str:
    """The end of a link that opens the page at a moment of a run; "" if nothing is given.

    Args:
        run: The run that the page shows.
        step: Moment to show [step]; None for the page's first.
        seed: Seed of the world; None for the run's first.
        agent: `agent_id` of the agent to choose; None for no agent.

    Raises:
        ViewError: The run has no world of this seed, or its world does not contain this step.
    """
    if step is None and seed is None and agent is None:
        return ""
    manifest = run.manifest
    if seed is not None and seed not in manifest.seeds:
        raise ViewError(f"--seed {seed}: the run has the seeds {', '.join(map(str, manifest.seeds))}")
    world = 0 if seed is None else manifest.seeds.index(seed)
    first = manifest.parent.step if manifest.parent else 0
    last = manifest.steps_done[world]
    if step is not None and not first <= step <= last:
        limit = f"starts at step {first}" if step < first else f"ends at step {last}"
        raise ViewError(f"--step {step}: the world of seed {manifest.seeds[world]} {limit}")
    values = {"world": world, "step": step, "agent": agent}
    return "#" + "&".join(f"{name}={value}" for name, value in values.items() if value is not None)
