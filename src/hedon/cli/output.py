"""Handles output that cannot be written: a full disk, a closed terminal or pipe."""

import errno
import io
import os
import sys
from collections.abc import Callable
from typing import Any, TextIO

from hedon.error import HedonError


class OutputError(HedonError):
    """A command's output cannot be written."""


class _Guarded(io.TextIOWrapper):
    """A stream that raises its first failure again on every later use, even a flush."""

    pipe_closed = False
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
            if error.errno == errno.EPIPE:  # its reader needs no more, as with `head`
                self._close_pipe()
                return act(*given)
            self._failure = OutputError(f"cannot write what it prints: {error.strerror}")
            raise self._failure from error

    def _close_pipe(self) -> None:
        """Discards all further output, and ends the current work as a signal would."""
        from hedon.experiment.interrupt import PIPE, note

        if not pipe_closed():
            note(PIPE)
        self.pipe_closed = True
        self._go_nowhere()

    def _go_nowhere(self) -> None:
        os.dup2(os.open(os.devnull, os.O_WRONLY), self.fileno())

    def give_up(self) -> None:
        """Discards all further output, since Python would otherwise complain at exit."""
        if self._failure is not None:
            self._failure = None
            self._go_nowhere()


def pipe_closed() -> bool:
    """Whether this command's output is no longer read."""
    return any(isinstance(stream, _Guarded) and stream.pipe_closed for stream in (sys.stdout, sys.stderr))


def give_up() -> None:
    """Gives up the streams that have failed."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, _Guarded):
            stream.give_up()


def guard(stream: TextIO | None) -> TextIO:
    """Wraps a stream: failures raise `OutputError`, and characters that it cannot show become "?"."""
    if stream is None:  # the caller closed it, as with `>&-`
        return open(os.devnull, "w", encoding="utf-8")
    if type(stream) is not io.TextIOWrapper:  # from a test or a notebook
        return stream
    encoding, lines, through = stream.encoding, stream.line_buffering, stream.write_through
    return _Guarded(stream.detach(), encoding, "replace", line_buffering=lines, write_through=through)
