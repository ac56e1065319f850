"""Passes pictures one by one to ffmpeg, which encodes them as a video."""

import os
import secrets
import subprocess
import tempfile
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import Self

from hedon.text import brief
from hedon.video.error import VideoError

FORMATS = {
    ".mp4": ("-c:v", "libx264", "-preset", "medium", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart"),
    # Each picture has its own palette, since a common one would require all pictures at once.
    ".gif": ("-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none"),
}
"""Arguments for ffmpeg, by suffix of the file."""


def find_ffmpeg() -> str:
    """The path of ffmpeg.

    Raises:
        VideoError: ffmpeg is not installed.
    """
    try:
        return import_module("imageio_ffmpeg").get_ffmpeg_exe()
    except (ImportError, RuntimeError):
        raise VideoError('a video needs ffmpeg: pip install "hedon[video]", or `uv sync --extra video` here') from None


def check_target(out: Path) -> None:
    """Refuses a path at which no video can be written.

    Raises:
        VideoError: The suffix is not supported, the file already exists, or its folder does not.
    """
    name = brief(str(out))
    if out.suffix.lower() not in FORMATS:
        raise VideoError(f"{name}: a video ends in " + " or ".join(FORMATS))
    if out.exists() or out.is_symlink():
        raise VideoError(f"{name} is there already: choose another file, or remove it")
    if not out.parent.is_dir():
        raise VideoError(f"cannot write {name}: there is no folder {brief(str(out.parent))}")


class Encoder:
    """A video that is being written. The file gets its name once the last picture is written.

    Args:
        out: Path of the new file, with a suffix in `FORMATS`.
        width: Width of a picture [pixel], even.
        height: Height of a picture [pixel], even.
        rate: Pictures per second.

    Raises:
        VideoError: `out` cannot be written, or ffmpeg is not installed or fails.
    """

    def __init__(self, out: Path, width: int, height: int, rate: int) -> None:
        check_target(out)
        self.out = out
        self._draft = out.with_name(f".{secrets.token_hex(6)}-{os.getpid()}{out.suffix.lower()}")
        given = ("-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{width}x{height}", "-r", str(rate), "-i", "-")
        command = (find_ffmpeg(), "-hide_banner", "-loglevel", "error", *given, *FORMATS[out.suffix.lower()])
        self._log = tempfile.TemporaryFile()  # noqa: SIM115 - it lives as long as the program: `__exit__` closes it
        # In a separate session, so that Ctrl-C reaches only this program, which then removes the draft.
        self._program = subprocess.Popen(
            [*command, str(self._draft)], stdin=subprocess.PIPE, stderr=self._log, start_new_session=True
        )

    def add(self, picture: memoryview) -> None:
        """Appends a picture: four bytes for each pixel, red, green, blue and opacity, row by row from the top."""
        assert self._program.stdin is not None
        try:
            self._program.stdin.write(picture)
        except BrokenPipeError:
            raise self._failure() from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        try:
            if kind is not None:
                self._program.kill()
            with suppress(BrokenPipeError):
                self._program.communicate()
            if kind is None and self._program.returncode != 0:
                raise self._failure()
            if kind is None:
                self._draft.replace(self.out)
        finally:
            self._draft.unlink(missing_ok=True)
            self._log.close()

    def _failure(self) -> VideoError:
        self._program.wait()
        self._log.seek(0)
        said = self._log.read().decode(errors="replace").strip().splitlines()
        return VideoError(
            f"cannot write {brief(str(self.out))}: ffmpeg says: " + brief(said[-1] if said else "nothing")
        )
