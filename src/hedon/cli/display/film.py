"""Progress of a video: one updated line on a terminal, occasional lines elsewhere."""

import time

from rich.console import Console

from hedon.cli.display.run import duration
from hedon.cli.display.screen import Screen

LINE_SECONDS = 10.0


class FilmDisplay(Screen):
    """Progress of one video. Use it as a context manager.

    Args:
        console: Console to print on.
        rate: Pictures per second of the video.
    """

    def __init__(self, console: Console, rate: int) -> None:
        super().__init__(console, LINE_SECONDS)
        self._rate = rate
        self._begun = time.monotonic()
        self._due = self._begun + self._gap

    def update(self, number: int, pictures: int, step: int) -> None:
        """Shows the progress, if enough time has passed."""
        if self.is_due():
            left = (time.monotonic() - self._begun) / number * (pictures - number)
            seen = f"{number / self._rate:.0f} s of video"
            text = f"picture {number:,} of {pictures:,}, step {step:,}, {seen}; {duration(left)} left"
            self.show(lambda: text)
