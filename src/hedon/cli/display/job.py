"""Shows the progress of several runs: a live table on a terminal, plain lines elsewhere."""

import time
from collections import deque
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console, Group
from rich.progress_bar import ProgressBar
from rich.text import Text

from hedon.cli.display.run import duration
from hedon.cli.display.screen import Screen
from hedon.cli.display.table import PrintedTable
from hedon.experiment.plan import Moment
from hedon.jobs.run import RunJob
from hedon.jobs.work import Outcome

SPAN = 60.0
"""Time over which the speed is measured, so that the forecast follows the sizes of the populations [s]."""
SURE_SECONDS = 5.0
"""Time before which no forecast is made [s]."""


class JobDisplay(Screen):
    """Progress of all runs of a plan together, and of each current run. Use it as a context manager.

    Args:
        console: to print on.
        jobs: the plan.
    """

    def __init__(self, console: Console, jobs: Sequence[RunJob]) -> None:
        super().__init__(console)
        self._total = sum(job.world_steps for job in jobs)
        self._count = len(jobs)
        self._jobs = {job.folder: job for job in jobs}
        self._moments: dict[Path, Moment] = {}
        self._done = dict.fromkeys(self._jobs, 0)
        self._ended = 0
        self._seen: deque[tuple[float, int]] = deque()

    def update(self, job: RunJob, moment: Moment) -> None:
        """Notes a moment of a run. Draws all runs at most five times a second, or prints a line every half minute.

        Args:
            job: That goes on.
            moment: How far it is.
        """
        self._moments[job.folder] = moment
        living = sum(step is None for step in _ends(job, moment).values())
        # Only worlds with living agents have steps still to run.
        self._done[job.folder] = max(0, job.world_steps - living * (job.plan.steps - moment.step))
        if not self.is_due():
            return
        now = time.monotonic()
        self._seen.append((now, sum(self._done.values())))
        while len(self._seen) > 2 and self._seen[1][0] < now - SPAN:
            self._seen.popleft()
        self.show(lambda: f"{self._head()}: {'; '.join(map(self._describe, self._moments))}", self._draw)

    def end(self, job: RunJob, outcome: Outcome) -> None:
        """Notes the end of a run and prints a line that says how it ended.

        Args:
            job: That ended.
            outcome: How it ended.
        """
        moment = self._moments.pop(job.folder, None)
        self._ended += 1
        if outcome.status == "finished":
            self._done[job.folder] = job.world_steps
        words = [f"{job.folder}: {outcome.status}"]
        if moment is not None:
            words.append(f"step {moment.step:,}")
            words += [f"seed {seed} died out" for seed, step in _ends(job, moment).items() if step is not None]
        if outcome.fault:
            words.append(outcome.fault)
        self._console.print(", ".join(words), soft_wrap=True)

    def _head(self) -> str:
        done = sum(self._done.values())
        (begun, first), (now, last) = self._seen[0], self._seen[-1]
        text = f"{100 * done / max(self._total, 1):.1f} %, {self._ended} of {self._count} runs done"
        if now - begun < SURE_SECONDS or last == first:
            return text
        rate = (last - first) / (now - begun)
        return f"{text}, {rate:,.0f} world-steps/s, {duration((self._total - done) / rate)} left"

    def _describe(self, folder: Path) -> str:
        moment = self._moments[folder]
        return f"{folder.name} step {moment.step:,} of {moment.steps:,}, {_alive(moment)} alive"

    def _draw(self) -> Group:
        done = sum(self._done.values())
        rows = [
            (folder.name, f"{moment.step:,}", f"{moment.steps:,}", _alive(moment))
            for folder, moment in self._moments.items()
        ]
        table = PrintedTable(("run", "step", "of", "alive"), rows, text=(0, 3))
        hint = Text("Ctrl-C ends all runs after their current windows; the same command continues.", style="dim")
        bar = ProgressBar(total=max(self._total, 1), completed=done, width=72)
        return Group(Text(self._head()), bar, table, hint)


def _ends(job: RunJob, moment: Moment) -> dict[int, int | None]:
    """The step at which the world of each seed died out, or None."""
    species = len(moment.extinct) // len(job.plan.seeds)
    return dict(zip(job.plan.seeds, moment.extinct[::species], strict=True))


def _alive(moment: Moment) -> str:
    pairs = zip(moment.rows, moment.extinct, strict=True)
    return " / ".join("died out" if extinct is not None else str(row["alive"]) for row, extinct in pairs)
