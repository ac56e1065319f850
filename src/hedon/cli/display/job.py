"""Progress of several runs: a live table on a terminal, plain lines elsewhere."""

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
from hedon.ensemble.job import Job, Outcome
from hedon.experiment.plan import Moment
from hedon.text import printable

SPAN = 60.0
"""Time over which the speed is measured, so that the remaining time follows changes in population size [s]."""
MOST_TOLD = 20
"""Maximum number of runs for which every end is reported; with more runs, only failures are."""


class JobDisplay(Screen):
    """Progress of all runs of a plan together, and of each current run. Use it as a context manager.

    Args:
        console: Console to print on.
        jobs: Runs of the plan.
    """

    def __init__(self, console: Console, jobs: Sequence[Job]) -> None:
        super().__init__(console)
        self._total = sum(job.world_steps for job in jobs)
        self._count = len(jobs)
        self._moments: dict[Path, Moment] = {}
        self._labels = {job.folder: job.label for job in jobs}
        self._done: dict[Path, int] = {}
        self._before: dict[Path, int] = {}  # world-steps done before this command continued a run
        self._ended = self._ended_done = self._ended_before = 0
        self._seen = deque([(time.monotonic(), 0)])

    def update(self, job: Job, moment: Moment) -> None:
        """Records a moment of a run. Draws all runs at most five times a second, or prints a line every half minute."""
        if not self._moments and not self._ended:  # workers were starting until now
            self._seen = deque([(time.monotonic() - moment.seconds, 0)])
        self._moments[job.folder] = moment
        living = len(job.seeds) - len(_ended(job, moment))
        # Only worlds with living agents have steps left.
        self._done[job.folder] = max(0, job.world_steps - living * (job.steps - moment.step))
        self._before.setdefault(job.folder, max(0, job.world_steps - living * (job.steps - moment.first)))
        if self.is_due():
            self._show()

    def end(self, job: Job, outcome: Outcome) -> None:
        """Records the end of a run, and prints a line with its status."""
        moment = self._moments.pop(job.folder, None)
        done, whole = self._done.pop(job.folder, 0), outcome.status == "finished"
        self._ended += 1
        self._ended_done += job.world_steps if whole else done
        self._ended_before += self._before.pop(job.folder, 0)
        if self.is_due() or self._ended == self._count > MOST_TOLD:
            self._show()
        if whole and self._count > MOST_TOLD:
            return
        words = [f"{job.label}: {outcome.status}"]
        if moment is not None:
            words.append(f"step {moment.step:,}")
            words += [f"seed {seed} died out" for seed in _ended(job, moment)]
        if outcome.fault:
            words.append(outcome.fault)
        self._console.print(printable(", ".join(words)), soft_wrap=True, highlight=False)

    def _show(self) -> None:
        now = time.monotonic()
        self._seen.append((now, self._reached() - self._ended_before - sum(self._before.values())))
        while len(self._seen) > 2 and self._seen[1][0] < now - SPAN:
            self._seen.popleft()
        current = "; ".join(map(self._describe, self._moments))
        self.show(lambda: f"{self._head()}{': ' if current else ''}{current}", self._draw)

    def _reached(self) -> int:
        return self._ended_done + sum(self._done.values())

    def _head(self) -> str:
        done = self._reached()
        (begun, first), (now, last) = self._seen[0], self._seen[-1]
        text = f"{100 * done / max(self._total, 1):.1f} %, {self._ended:,} of {self._count:,} runs done"
        if last <= first:
            return text
        rate = (last - first) / max(now - begun, 1e-9)
        left = f", {duration((self._total - done) / rate)} left" if self._ended < self._count else ""
        return f"{text}, {rate:,.0f} world-steps/s{left}"

    def _describe(self, folder: Path) -> str:
        moment = self._moments[folder]
        return f"{self._labels[folder]} step {moment.step:,} of {moment.steps:,}, {_alive(moment)} alive"

    def _draw(self) -> Group:
        rows = [
            (self._labels[folder], f"{moment.step:,}", f"{moment.steps:,}", _alive(moment))
            for folder, moment in self._moments.items()
        ]
        table = PrintedTable(("run", "step", "of", "alive"), rows, text=(0, 3))
        hint = Text("Ctrl-C ends all runs after their current windows; the same command continues.", style="dim")
        bar = ProgressBar(total=max(self._total, 1), completed=self._reached(), width=72)
        return Group(Text(self._head()), bar, table, hint)


def _ended(job: Job, moment: Moment) -> list[int]:
    """Seeds of the worlds in which all species are extinct."""
    gone = _gone(moment)
    species = len(gone) // len(job.seeds)
    return [seed for i, seed in enumerate(job.seeds) if all(gone[i * species : (i + 1) * species])]


def _gone(moment: Moment) -> list[bool]:
    """For each world and species, whether it is extinct."""
    pairs = zip(moment.rows, moment.extinct, strict=True)
    return [extinct is not None or row["alive"] == 0 for row, extinct in pairs]


def _alive(moment: Moment) -> str:
    pairs = zip(moment.rows, _gone(moment), strict=True)
    return " / ".join("died out" if gone else str(row["alive"]) for row, gone in pairs)
