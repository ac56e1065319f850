"""Shows the progress of a sweep: one line on a terminal, a plain line now and then elsewhere."""

import time

from rich.console import Console

from hedon.cli.display.run import duration
from hedon.cli.display.screen import Screen
from hedon.experiment.plan import Moment
from hedon.jobs.work import Outcome
from hedon.sweep.work import Task
from hedon.text import printable


class SweepDisplay(Screen):
    """Progress of a sweep. Use it as a context manager.

    Args:
        console: to print on.
        batches: to be made now.
        world_steps: of these batches, if no world dies out.
    """

    def __init__(self, console: Console, batches: int, world_steps: int) -> None:
        super().__init__(console)
        self._batches, self._total = batches, world_steps
        self._begun = time.monotonic()
        self._current: dict[str, tuple[int, int]] = {}
        self._ended = self._done = self._made = 0

    def update(self, job: Task, moment: Moment) -> None:
        """Notes a moment of a batch.

        Args:
            job: That goes on.
            moment: How far it is.
        """
        worlds = len(job.batch.seeds)
        self._current[job.batch.name] = (moment.step * worlds, (moment.step - moment.first) * worlds)
        if self.is_due():
            self.show(self._line)

    def end(self, job: Task, outcome: Outcome) -> None:
        """Notes the end of a batch; says why one failed.

        Args:
            job: That ended.
            outcome: How it ended.
        """
        self._ended += 1
        whole = job.steps * len(job.batch.seeds) if outcome.status == "finished" else 0
        # A cluster tells no moments.
        _, made = self._current.pop(job.batch.name, (0, whole))
        self._made += made
        self._done += whole
        if outcome.status == "failed":
            self._console.print(f"  {job.batch.name} failed: {printable(outcome.fault)}", soft_wrap=True)
        if self.is_due() or self._ended == self._batches:
            self.show(self._line)

    def _line(self) -> str:
        done = self._done + sum(at for at, _ in self._current.values())
        made = self._made + sum(made for _, made in self._current.values())
        seconds = max(time.monotonic() - self._begun, 1e-9)
        left = (
            f", {duration((self._total - done) * seconds / made)} left" if made and self._ended < self._batches else ""
        )
        share = 100 * done / self._total if self._total else 100.0
        return (
            f"  {self._ended} of {self._batches} batches, {share:.0f} % of their world-steps, "
            f"{made / seconds:,.0f} world-steps/s{left}"
        )
