"""Shows the progress of a video: one line that changes on a terminal, a line from time to time elsewhere."""

import time
from typing import Self

from rich.console import Console

from hedon.cli.display.run import duration

LINE_SECONDS = 10.0
TERMINAL_SECONDS = 0.2


class FilmDisplay:
    """Progress of one video. Use it as a context manager.

    Args:
        console: to print on.
        rate: pictures per second of the video.
    """

    def __init__(self, console: Console, rate: int) -> None:
        self._rate = rate
        self._console = console
        self._status = console.status("reading the frames") if console.is_terminal else None
        self._gap = TERMINAL_SECONDS if console.is_terminal else LINE_SECONDS
        self._begun = time.monotonic()
        self._due = self._begun + self._gap

    def __enter__(self) -> Self:
        if self._status is not None:
            self._status.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        if self._status is not None:
            self._status.__exit__(None, None, None)

    def update(self, number: int, pictures: int, step: int) -> None:
        """Shows how far the video is, if enough time has passed.

        Args:
            number: Pictures made so far.
            pictures: Of the whole video.
            step: That the last one shows.
        """
        now = time.monotonic()
        if now < self._due:
            return
        self._due = now + self._gap
        left = (now - self._begun) / number * (pictures - number)
        seen = f"{number / self._rate:.0f} s of video"
        text = f"picture {number:,} of {pictures:,}, step {step:,}, {seen}; {duration(left)} left"
        if self._status is None:
            self._console.print(text)
        else:
            self._status.update(text)
