"""Draws and encodes the pictures of a video, one at a time."""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from hedon.config.color import meal_colors
from hedon.figure.film import Film
from hedon.video.encoder import Encoder, check_target, find_ffmpeg
from hedon.video.error import VideoError
from hedon.video.moment import Footage

Progress = Callable[[int, int, int], None]
"""Called after each picture with its number, the number of all pictures, and its step."""


@dataclass(frozen=True)
class FrameRange:
    """The part of a world that a video shows.

    Attributes:
        first: Step of the first picture.
        last: Latest step of the last picture.
        speed: Steps from one picture to the next.
        follow: ID of the agent in the center of the view; None for the whole arena.
    """

    first: int
    last: int
    speed: int
    follow: int | None = None

    @property
    def pictures(self) -> int:
        """The number of pictures."""
        return (self.last - self.first) // self.speed + 1


def choose_range(
    footage: Footage, first: int | None, last: int | None, speed: int, follow: int | None = None
) -> FrameRange:
    """The range to show; by default everything recorded, or the whole life of the followed agent.

    Args:
        footage: The world.
        first: Step of the first picture; None for the default.
        last: Latest step of the last picture; None for the default.
        speed: Steps from one picture to the next.
        follow: ID of the agent to follow; None for the whole arena.

    Raises:
        VideoError: There are no frames of these steps or of this agent.
    """
    begin, end = (footage.first, footage.last) if follow is None else footage.lifetime(follow)
    what = "the frames reach" if follow is None else f"agent {follow} is in the frames"
    shown = FrameRange(begin if first is None else first, end if last is None else last, speed, follow)
    for option, step in (("--from", shown.first), ("--to", shown.last)):
        if not begin <= step <= end:
            raise VideoError(f"{option} {step}: {what} from step {begin} to {end}")
    if shown.first > shown.last:
        raise VideoError(f"--from {shown.first} is later than --to {shown.last}")
    return shown


def make_video(footage: Footage, shown: FrameRange, out: Path, width: int, rate: int, progress: Progress) -> None:
    """Writes a video.

    Args:
        footage: The world.
        shown: The part of it to show.
        out: Path of the new file, .mp4 or .gif.
        width: Width of a picture [pixel].
        rate: Pictures per second.
        progress: Called after each picture.

    Raises:
        VideoError: ffmpeg is not installed, or the file cannot be written.
    """
    check_target(out)
    find_ffmpeg()
    moments = footage.moments(shown.first, shown.last, shown.speed)
    opening = next(moments)
    film = Film(opening, meal_colors(footage.config), width, footage.usual_energy(), shown.follow)
    with Encoder(out, film.width, film.height, rate) as encoder:
        for number, moment in enumerate(chain((opening,), moments), 1):
            encoder.add(film.draw(moment))
            progress(number, shown.pictures, moment.step)
