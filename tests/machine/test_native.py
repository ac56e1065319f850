"""The native programs of long tests fit the engine: else one that changes a call is not seen before a release."""

import os
import shlex
import subprocess

from project_files import ROOT


def test_the_program_of_lives_compiles():
    compiler = shlex.split(os.environ.get("CXX") or "c++")
    warnings = ["-Wall", "-Wextra", "-Werror", "-Wno-unused-command-line-argument"]  # Zig adds some of its own
    command = [*compiler, "-std=c++20", "-fsyntax-only", *warnings, "-Iengine"]
    done = subprocess.run([*command, "tests/native/life.cpp"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
