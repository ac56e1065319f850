"""The command line within the tests' own process: the same way in as the installed command, without its start.

What is about the process itself (signals, limits, its environment, its exit) starts one; what is about words, files and
numbers has no need to: imports alone cost a second or two each time.
"""

import os
import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from io import BytesIO, TextIOWrapper
from pathlib import Path
from subprocess import CompletedProcess
from unittest import mock

from hedon.cli.start import main


def hedon(*arguments: object, cwd: Path | str = ".", **environment: str) -> "CompletedProcess[str]":
    """What `hedon ARGUMENTS` answers in a folder, with variables of the environment set."""
    words = ["hedon", *map(str, arguments)]
    out, err = (TextIOWrapper(BytesIO(), encoding="utf-8", write_through=True) for _ in range(2))
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
    said, wrong = (stream.buffer.getvalue().decode("utf-8") for stream in (out, err))  # type: ignore[attr-defined]
    return CompletedProcess(words, code if isinstance(code, int) else int(code is not None), said, wrong)
