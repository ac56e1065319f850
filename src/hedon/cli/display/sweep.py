"""Shows the progress of a sweep: one line on a terminal, a plain line now and then elsewhere."""

import time
from typing import Any

from rich.console import Console
from rich.live import Live
from rich.text import Text

from hedon.cli.display.run import duration
from hedon.experiment.plan import Moment
from hedon.replication.run.work import Outcome
from hedon.sweep.work import Task
from hedon.text import printable

LINE_SECONDS = 30.0


class SweepDisplay:
    """Progress of a sweep. Use it as a context manager.

    Args:
        console: to print on.
        batches: to be made now.
        world_steps: of these batches, if no world dies out.
    """

    def __init__(self, console: Console, batches: int, world_steps: int) -> None:
        self._console, self._batches, self._total = console, batches, world_steps
        self._live = Live(console=console, auto_refresh=False, transient=True) if console.is_terminal else None
        self._begun = time.perf_counter()
        self._due = 0.0
        self._current: dict[str, tuple[int, int]] = {}
        self._ended = self._done = self._made = 0

    def __enter__(self) -> "SweepDisplay":
        if self._live is not None:
            self._live.__enter__()
        return self

    def __exit__(self, *error: Any) -> None:
        if self._live is not None:
            self._live.__exit__(*error)

    def update(self, job: Task, moment: Moment) -> None:
        """Notes a moment of a batch."""
        worlds = len(job.batch.seeds)
        self._current[job.batch.name] = (moment.step * worlds, (moment.step - moment.first) * worlds)
        self._show()

    def end(self, job: Task, outcome: Outcome) -> None:
        """Notes the end of a batch; says why one failed."""
        self._ended += 1
        _, made = self._current.pop(job.batch.name, (0, 0))
        self._made += made
        if outcome.status == "finished":
            self._done += job.steps * len(job.batch.seeds)
        elif outcome.status == "failed":
            self._console.print(f"  {job.batch.name} failed: {printable(outcome.fault)}", soft_wrap=True)
        self._show(last=self._ended == self._batches)

    def _show(self, *, last: bool = False) -> None:
        now = time.perf_counter()
        if now < self._due and not last:
            return
        self._due = now + (0.2 if self._live is not None else LINE_SECONDS)
        done = self._done + sum(at for at, _ in self._current.values())
        made = self._made + sum(made for _, made in self._current.values())
        seconds = now - self._begun
        left = f", {duration((self._total - done) * seconds / made)} left" if made and not last else ""
        share = 100 * done / self._total if self._total else 100.0
        line = (
            f"  {self._ended} of {self._batches} batches, {share:.0f} % of their world-steps, "
            f"{made / seconds:,.0f} world-steps/s{left}"
        )
        if self._live is not None:
            self._live.update(Text(line), refresh=True)
        else:
            self._console.print(line, soft_wrap=True)
