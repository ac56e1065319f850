"""How often the process of a job may be lost before the job is given up."""

from dataclasses import dataclass, field
from pathlib import Path

from hedon.jobs.work import Job

TRIES = 5
"""How often in a row a job may be begun without getting further. One that writes a checkpoint may be lost again."""


@dataclass
class RetryLimit:
    """Counts how often each job was lost, with its node or alone, without getting further."""

    _seen: dict[Path, tuple[str, int]] = field(default_factory=dict)

    def may_go_on(self, job: Job) -> bool:
        """Notes that a job was lost. Whether it is worth another try."""
        place = job.newest()
        before, count = self._seen.get(job.folder, (place, 0))
        count = count + 1 if place == before else 1
        self._seen[job.folder] = place, count
        return count < TRIES

    def reason(self, job: Job, error: Exception) -> str:
        """Why a job is given up: which worlds, what was seen last, and what to do."""
        first = str(error).strip().partition("\n")[0]
        return (
            f"its process was lost {TRIES} times in a row without a new checkpoint, the last time with: {first} Its "
            f"worlds: {job.describe()}. If memory runs out, take nodes with more, or fewer `worlds` in a batch; if "
            "nodes live too briefly, lower --checkpoint"
        )
