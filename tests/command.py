"""Runs the command line inside the test process: the entry point of the installed command, without a new process.

Tests of the process itself (signals, limits, environment, exit) start a real one. Tests of messages, files and numbers
need not: imports alone would cost a second or two each time.
"""

import os
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from subprocess import CompletedProcess
from unittest import mock

from hedon.cli.start import main


class Captured(TextIOWrapper):
    """A stream whose text stays readable; the command line changes only the process's own streams."""

    def __init__(self) -> None:
        self.kept = BytesIO()
        super().__init__(self.kept, encoding="utf-8", write_through=True)

    @property
    def text(self) -> str:
        return self.kept.getvalue().decode("utf-8")


def hedon(*arguments: object, cwd: Path | str = ".", **environment: str) -> "CompletedProcess[str]":
    """Runs `hedon ARGUMENTS` in a folder, with environment variables set, and returns its exit code and output."""
    words = ["hedon", *map(str, arguments)]
    out, err = Captured(), Captured()
    code: object = 0
    with (
        chdir(cwd),
        mock.patch.object(sys, "argv", words),
        mock.patch.dict(os.environ, environment),
        redirect_stdout(out),
        redirect_stderr(err),
    ):
        try:
            main()
        except SystemExit as end:
            code = end.code
    return CompletedProcess(words, code if isinstance(code, int) else int(code is not None), out.text, err.text)
