"""Callbacks of runs: the numbers of each window for other tools or TensorBoard, and a progress bar for notebooks.

A callback is a function of a `hedon.Moment`: `hedon.run(plan, callbacks=[print])`.
"""

import math
from collections.abc import Iterator
from numbers import Real
from pathlib import Path
from typing import Any

from hedon.error import HedonError
from hedon.experiment.plan import Moment

NAMED = ("world", "seed", "step", "species")
"""Columns that identify a row."""


class Metrics:
    """Gives the numbers of each window once, after it has ended, for logging by experiment trackers.

    Use a separate object for each run, since it remembers what it has given.

    Example:
        >>> import hedon, hedon.callback
        >>> metrics = hedon.callback.Metrics()
        >>> def log(moment):
        ...     for step, values in metrics(moment):
        ...         print(step, values["seed_1/alive"])
        >>> plan = hedon.RunPlan(hedon.load_config("small"), seeds=(1,), steps=2048, out="runs/logged")
        >>> hedon.run(plan, callbacks=[log])
    """

    def __init__(self) -> None:
        self._last: dict[int, int] = {}

    def __call__(self, moment: Moment) -> list[tuple[int, dict[str, float]]]:
        """Returns new steps with their values, by names such as "seed_1/alive" or "seed_1/prey.births"."""
        found: dict[int, dict[str, float]] = {}
        for index, row in enumerate(moment.rows):
            step = int(row["step"])
            if step > self._last.get(index, 0):
                self._last[index] = step
                found.setdefault(step, {}).update(_values(row))
        return sorted(found.items())


def _values(row: Any) -> Iterator[tuple[str, float]]:
    place = f"seed_{row['seed']}/" + (f"{row['species']}." if "species" in row else "")
    for name, value in row.items():
        if name not in NAMED and isinstance(value, Real) and math.isfinite(value):
            yield f"{place}{name}", float(value)


class TensorBoard:
    """Writes the numbers of each window as scalars; `tensorboard --logdir FOLDER` shows them during the run.

    Args:
        folder: Folder for the event file.

    Raises:
        HedonError: tensorboardX is not installed.
    """

    def __init__(self, folder: Path | str) -> None:
        try:
            from tensorboardX import SummaryWriter
        except ModuleNotFoundError as error:
            raise HedonError(
                f'hedon.callback.TensorBoard needs {error.name}: pip install "hedon[tensorboard]"'
            ) from error
        self._writer = SummaryWriter(str(folder))
        self._metrics = Metrics()

    def __call__(self, moment: Moment) -> None:
        """Writes new values; at the end of the run all of them are on disk."""
        for step, values in self._metrics(moment):
            for name, value in values.items():
                self._writer.add_scalar(name, value, step)
        self._writer.flush()


class ProgressBar:
    """A progress bar in a notebook: steps, speed, remaining time, and numbers alive.

    Raises:
        HedonError: IPython is not installed.
    """

    def __init__(self) -> None:
        try:
            from IPython.display import HTML, display
        except ModuleNotFoundError as error:
            raise HedonError(f"hedon.callback.ProgressBar is for notebooks, which have {error.name}") from error
        self._html, self._display = HTML, display
        self._handle: Any = None

    def __call__(self, moment: Moment) -> None:
        """Updates the bar."""
        done = moment.step - moment.first
        speed = done / max(moment.seconds, 1e-9)
        left = (moment.steps - moment.step) / speed if speed > 0 else math.inf
        alive = ", ".join(f"{row['alive']}" for row in moment.rows)
        said = f"step {moment.step:,} of {moment.steps:,}"
        said += f", {speed:,.0f} steps/s, {left:,.0f} s left" if moment.step < moment.steps else ""
        bar = f'<progress value="{moment.step}" max="{moment.steps}" style="width: 20em"></progress>'
        shown = self._html(f"{bar} {said}; alive: {alive}")
        if self._handle is None:
            self._handle = self._display(shown, display_id=True)
        else:
            self._handle.update(shown)
