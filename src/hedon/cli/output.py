"""What a command prints, where it cannot be printed: a full disk, a closed terminal."""

import errno
import io
import os
import sys
from collections.abc import Callable
from typing import Any, TextIO

from hedon.error import HedonError


class OutputError(HedonError):
    """What a command prints cannot be written."""


class _Guarded(io.TextIOWrapper):
    """A stream whose first failure is its last word: a second try, if only to flush, raises it too."""

    _failure: OutputError | None = None

    def write(self, text: str, /) -> int:
        return self._try(super().write, text)

    def flush(self) -> None:
        self._try(super().flush)

    def _try(self, act: Callable[..., Any], *given: str) -> Any:
        if self._failure is not None:
            raise self._failure
        try:
            return act(*given)
        except OSError as error:
            if error.errno == errno.EPIPE:  # its reader has what it wants, as `head` does: no fault
                raise
            self._failure = OutputError(f"cannot write what it prints: {error.strerror}")
            raise self._failure from error

    def give_up(self) -> None:
        """Lets all that is still written go nowhere, or Python would complain at its end."""
        if self._failure is not None:
            self._failure = None
            os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())


def give_up() -> None:
    """Gives up the streams that have failed."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, _Guarded):
            stream.give_up()


def guard(stream: TextIO | None) -> TextIO:
    """The stream with failures as `OutputError`; where a terminal or file cannot show a character, as "?"."""
    if stream is None:  # it was closed, as by `>&-`: nobody wants to read it
        return open(os.devnull, "w", encoding="utf-8")
    if type(stream) is not io.TextIOWrapper:  # of a test or a notebook
        return stream
    encoding, lines, through = stream.encoding, stream.line_buffering, stream.write_through
    return _Guarded(stream.detach(), encoding, "replace", line_buffering=lines, write_through=through)
