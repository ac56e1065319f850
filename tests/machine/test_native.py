"""The native programs of long tests match the engine; otherwise a changed call would go unnoticed until a release."""

import os
import shlex
import subprocess

from project_files import ROOT


def test_the_program_for_lives_compiles(tmp_path):
    compiler = shlex.split(os.environ.get("CXX") or "c++")
    command = [*compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", "-Iengine", "-c", "tests/native/life.cpp"]
    command += ["-o", str(tmp_path / "life.o")]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
