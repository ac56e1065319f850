"""How often the process of a batch may be lost before the batch is given up."""

from dataclasses import dataclass, field

from hedon.config.problem import format_value
from hedon.sweep.store import Store
from hedon.sweep.work import Task, newest_checkpoint

TRIES = 5
"""How often in a row a batch may be begun without getting further. One that writes a checkpoint may be lost again."""


@dataclass
class Losses:
    """Counts how often each batch was lost, with its node or alone, without getting further.

    Attributes:
        store: where the sweep lives.
    """

    store: Store
    _seen: dict[str, tuple[str, int]] = field(default_factory=dict)

    def may_go_on(self, task: Task) -> bool:
        """Notes that a batch was lost. Whether it is worth another try."""
        place = newest_checkpoint(self.store, task)
        before, count = self._seen.get(task.batch.name, (place, 0))
        count = count + 1 if place == before else 1
        self._seen[task.batch.name] = place, count
        return count < TRIES

    def reason(self, task: Task, error: Exception) -> str:
        """Why a batch is given up: which worlds, what was seen last, and what to do.

        Args:
            task: Of the batch.
            error: What was seen last.
        """
        settings = ", ".join(f"{name} = {format_value(value)}" for name, value in task.settings.items())
        worlds = f"{settings or 'all settings'}, seed {', '.join(map(str, task.batch.seeds))}"
        first = str(error).strip().partition("\n")[0]
        return (
            f"its process was lost {TRIES} times in a row without a new checkpoint, the last time with: {first} Its "
            f"worlds: {worlds}. If memory runs out, take nodes with more, or fewer `worlds` in a batch; if nodes live "
            "too briefly, lower --checkpoint"
        )
