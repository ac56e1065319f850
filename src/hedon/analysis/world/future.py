"""Detects worlds that are futures of one world, and are therefore not independent."""

from collections.abc import Sequence

from hedon.record.reader import Run


def shared_pasts(runs: Sequence[Run]) -> list[str]:
    """A sentence for each run whose worlds are futures of one world: they are not independent."""
    sentences = []
    for run in runs:
        parent = run.manifest.parent
        if parent is not None and parent.seed is not None:
            sentences.append(
                f"The worlds of {run.path.name} are futures of one world (seed {parent.seed} of {parent.folder}) from "
                f"step {parent.step:,} on. They share its past, so intervals and tests are about its futures, "
                "not about independent worlds."
            )
    return sentences
