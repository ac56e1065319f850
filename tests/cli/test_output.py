"""A command whose output cannot be written reports it in one line with exit code 2; a closed pipe gives 141."""

import json
import os
import subprocess
import sys

import pytest

from hedon.check import check_run

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
def test_output_to_a_full_disk_is_reported_in_one_line(arguments, tmp_path):
    with open("/dev/full", "w") as full:
        answer = call(arguments, full, tmp_path / "out", unbuffered=arguments == ("--help",))
    assert answer == (2, "hedon: cannot write what it prints: No space left on device\n")


@pytest.mark.parametrize("unbuffered", [False, True])
@pytest.mark.parametrize("arguments", COMMANDS[:-1], ids=" ".join)
def test_a_reader_that_has_enough_is_no_fault(arguments, unbuffered, tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    try:
        assert call(arguments, writing, tmp_path / "out", unbuffered=unbuffered) == (141, "")
    finally:
        os.close(writing)


@pytest.mark.parametrize("command", ["run", "resume"])
def test_a_run_is_interrupted_if_its_output_is_no_longer_read(command, tmp_path):
    folder = tmp_path / "out"
    begin = ("run", "small", "--steps", "64", "--out", "{out}", "--threads", "1", "--no-report")
    if command == "resume":
        assert call(begin, subprocess.DEVNULL, folder, unbuffered=False)[0] == 0
    long = ("--steps", "200000", "--threads", "1", "--no-report")
    words = ("run", "small", "--out", "{out}", *long) if command == "run" else ("resume", "{out}", *long)
    reading, writing = os.pipe()
    os.close(reading)
    try:
        code, said = call(words, writing, folder, unbuffered=True)
    finally:
        os.close(writing)
    assert (code, said) == (141, "hedon: interrupted: its output is no longer read\n")
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["status"] == "interrupted"
    assert not check_run(folder).findings
