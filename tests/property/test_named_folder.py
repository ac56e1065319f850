"""Every command prints a folder's name unchanged, whatever its characters, and never reads it as anything else."""

import io
import shutil
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from synthetic_run import write_run

from hedon.cli.main import main
from hedon.text import printable

SPECIAL = "[]()<>{}*_`~#:;,.!?'\"\\|&%$@=+^ é漢"
NAMES = st.text(st.sampled_from(f"ab{SPECIAL}"), min_size=1, max_size=12).map(lambda text: f"r{text}x")
COMMANDS = {
    "check": ("check", "{run}"),
    "analyze": ("analyze", "{run}", "--only", "generation", "--out", "{run}-answers"),
    "export": ("export", "population", "{run}", "--out", "{run}.csv"),
    "missing": ("check", "{run}-nowhere"),
    "taken": ("run", "small", "--steps", "64", "--out", "{run}"),
}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_run(tmp_path_factory.mktemp("recorded") / "run", intervals=4, snapshot=False)


def _said(words: list[str]) -> str:
    """The output of a command on both streams."""
    out, err = io.StringIO(), io.StringIO()
    argv = patch.object(sys, "argv", ["hedon", *words])
    with argv, redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code in (None, 0, 1, 2)
    return out.getvalue() + err.getvalue()


@pytest.mark.parametrize("command", COMMANDS)
@settings(max_examples=15, deadline=None)
@given(name=NAMES)
def test_a_name_is_printed_as_it_is(command, name, recorded):
    folder = recorded.parent / command
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    run = folder / name
    run.symlink_to(recorded)
    said = _said([word.format(run=run) for word in COMMANDS[command]])
    assert "Traceback" not in said
    assert printable(name) in said.replace("\\\n", "")
