"""The native programs of long tests fit the engine: else one that changes a call is not seen before a release."""

import os
import shlex
import subprocess

from project_files import ROOT


def test_the_program_of_lives_compiles():
    compiler = shlex.split(os.environ.get("CXX") or "c++")
    command = [*compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-Iengine"]
    done = subprocess.run([*command, "tests/native/life.cpp"], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
