"""Where what a command prints cannot be written, it says so in one line, and ends with exit code 2."""

import os
import subprocess
import sys

import pytest

COMMANDS = [
    ("presets",),
    ("--help",),
    ("--version",),
    ("config", "show", "baseline"),
    ("forecast", "baseline"),
    ("view", "--live", "small", "--export", "{out}"),
    ("run", "small", "--steps", "64", "--out", "{out}", "--threads", "1", "--no-report"),
]


def call(arguments, stdout, out, unbuffered):
    command = [sys.executable, "-c", "from hedon.cli.start import main; main()"]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
    environment |= {"PYTHONUNBUFFERED": "1"} if unbuffered else {}
    given = [each.format(out=out) for each in arguments]
    done = subprocess.run(
        [*command, *given], stdout=stdout, stderr=subprocess.PIPE, text=True, env=environment, check=False
    )
    return done.returncode, done.stderr


@pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
def test_a_full_disk_behind_what_is_printed_is_one_line(arguments, tmp_path):
    with open("/dev/full", "w") as full:
        answer = call(arguments, full, tmp_path / "out", unbuffered=arguments == ("--help",))
    assert answer == (2, "hedon: cannot write what it prints: No space left on device\n")


def test_a_reader_that_has_enough_is_no_fault(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    try:
        assert call(("config", "show", "baseline"), writing, tmp_path, unbuffered=False) == (1, "")
    finally:
        os.close(writing)
