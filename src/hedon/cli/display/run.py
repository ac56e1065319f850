"""Progress of a run: a live table on a terminal, plain lines elsewhere."""

import math
from collections import deque
from typing import Any

from rich.console import Console, Group
from rich.progress_bar import ProgressBar
from rich.text import Text

from hedon.cli.display.screen import Screen
from hedon.cli.display.table import PrintedTable
from hedon.experiment.plan import Moment
from hedon.record.schema import Columns
from hedon.text import count

FIRST_LINE_SECONDS = 1.0
LINE_SECONDS = 10.0


def duration(seconds: float) -> str:
    """Formats a time for readers: "42 s", "3 min 05 s", "2 h 07 min"."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    return f"{whole // 3600} h {whole % 3600 // 60:02d} min"


class _Speed:
    """Steps per second over the last seconds, and at least one window, because learning at its end takes most time."""

    SPAN = 10.0  # [s]

    def __init__(self) -> None:
        self._seen: deque[tuple[float, int]] = deque()

    def update(self, moment: Moment) -> float | None:
        """Speed, or None before the end of the session's first window."""
        if not self._seen:
            self._seen.append((0.0, moment.first))
        self._seen.append((moment.seconds, moment.step))
        while self._seen[1][0] < moment.seconds - self.SPAN and self._seen[1][1] <= moment.step - moment.window:
            self._seen.popleft()
        (begun, first), (now, last) = self._seen[0], self._seen[-1]
        return (last - first) / max(now - begun, 1e-9) if last - first >= moment.window else None


def _head(moment: Moment, speed: float | None, gap: str) -> str:
    """The run's step, speed and remaining time."""
    place = f"step {moment.step:,} of {moment.steps:,}"
    if speed is None:
        return f"{place}{gap}the speed is known after a window of {moment.window:,} steps"
    return gap.join([place, f"{speed:,.0f} steps/s", f"{duration((moment.steps - moment.step) / speed)} left"])


def _labels(columns: Columns, seeds: tuple[int, ...]) -> list[str]:
    """Labels of the rows: the seed of the world and, if there are several, the species."""
    species = [f" {name}" for name in columns.species] if columns.several else [""]
    return [f"{seed}{name}" for seed in seeds for name in species]


def _when(row: dict[str, Any], extinct: int | None, moment: Moment) -> str:
    """Step of the row's numbers, if it differs from the run's: the end of the last window."""
    return "" if extinct is not None or row["step"] == moment.step else f" at step {row['step']:,}"


def _describe(row: dict[str, Any], extinct: int | None, weights: tuple[str, ...]) -> str:
    if extinct is not None:
        return f"extinct at step {extinct:,}"
    parts = [f"{row['alive']} alive", count(row["births"], "birth"), count(row["deaths"], "death")]
    parts += [f"energy {row['energy_mean']:.2f}"] if row["alive"] else []
    parts += [f"{name} {row[f'{name}_mean']:+z.2f}" for name in weights if not math.isnan(row[f"{name}_mean"])]
    return ", ".join(parts)


class RunDisplay(Screen):
    """Progress of one run: a progress bar and a table of the worlds on a terminal, plain lines elsewhere.

    Args:
        console: Console to print on.
        columns: Columns of the run's tables.
        seeds: Seeds of the worlds.
    """

    def __init__(self, console: Console, columns: Columns, seeds: tuple[int, ...]) -> None:
        self._seconds = 0.0
        super().__init__(console, LINE_SECONDS, lambda: self._seconds)
        self._due = 0.0 if console.is_terminal else FIRST_LINE_SECONDS
        self._weights = columns.shown_names
        self._labels = _labels(columns, seeds)
        self._speed = _Speed()
        self._printed: list[tuple[int | None, int | None] | None] = [None] * len(self._labels)

    def update(self, moment: Moment) -> None:
        """Shows the moment, if enough time has passed or the run is at its end."""
        self._seconds = moment.seconds
        speed = self._speed.update(moment)
        if self.is_due() or moment.step >= moment.steps:
            self.show(lambda: self._lines(moment, speed), lambda: self._draw(moment, speed))

    def _lines(self, moment: Moment, speed: float | None) -> str:
        """The run's progress and its only world in one line, or a line below it for each of several that changed."""
        worlds = [
            f"  seed {label}{_when(row, end, moment)}: {_describe(row, end, self._weights)}"
            for label, row, end in zip(self._labels, moment.rows, moment.extinct, strict=True)
        ]
        head = _head(moment, speed, "  ")
        if len(worlds) == 1:
            return head + worlds[0]
        # An extinct world does not change any more, whatever the step of its row.
        states = [
            (row["step"] if end is None else None, end) for row, end in zip(moment.rows, moment.extinct, strict=True)
        ]
        changed = [world for world, old, new in zip(worlds, self._printed, states, strict=True) if old != new]
        self._printed[:] = states
        return "\n".join([head, *changed])

    def _draw(self, moment: Moment, speed: float | None) -> Group:
        head = Text(_head(moment, speed, "   "))
        bar = ProgressBar(total=moment.steps, completed=moment.step, width=72)
        headers = ("seed", "alive", "births", "deaths", "energy", "generation", "food eaten", *self._weights)
        worlds = list(zip(self._labels, moment.rows, moment.extinct, strict=True))
        ends = [f"Seed {label} died out at step {extinct:,}." for label, _, extinct in worlds if extinct is not None]
        return Group(
            head,
            bar,
            PrintedTable(headers, [self._cells(*world) for world in worlds]),
            *map(Text, ends),
            Text(
                "Births, deaths, food: of the last window. Weights: means of the living. Ctrl-C ends after the window.",
                style="dim",
            ),
        )

    def _cells(self, label: str, row: dict[str, Any], extinct: int | None) -> list[str]:
        if extinct is not None:
            return [label, "0"]
        eaten = sum(value for name, value in row.items() if name.startswith("eaten_"))
        cells = [label, *(f"{row[name]:,}" for name in ("alive", "births", "deaths"))]
        known = row["alive"] > 0  # a species may be extinct while its world is alive
        cells += [f"{row['energy_mean']:.2f}" if known else "", f"{row['generation_mean']:.1f}" if known else ""]
        cells.append(f"{eaten:,}")
        means = [row[f"{name}_mean"] for name in self._weights]
        return cells + ["" if math.isnan(mean) else f"{mean:+.3f}" for mean in means]
