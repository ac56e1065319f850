"""Builds what can be published from one Linux machine: the source, and wheels of Linux, Windows and macOS.

`make wheels` calls it, with the dependency groups `viewer` (Zig's Clang) and `wheel`. Zig links against glibc 2.28,
whatever this machine has, and its own C++ library goes into the wheel, so that it runs on every Linux since 2018. There
is a wheel for each Python that is installed here. The headers of Python for x86-64 serve ARM too: what they say of the
system differs in assembly of the x87 alone, which no extension uses. Windows' and macOS' come from Maven Central.
"""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from release.foreign import fetch_python

ROOT = Path(__file__).resolve().parents[1]
PYTHONS = ("3.11", "3.12", "3.13")
PROCESSORS = ("x86_64", "aarch64")
GLIBC = (2, 28)
OUT = ROOT / "dist"
FOREIGN = ROOT / "build" / "foreign"
"""Where Pythons for other systems are kept."""
MACOS = (13, 0)
"""The oldest macOS that Zig links for."""


def zig() -> Path:
    """Zig's program in the package `ziglang`."""
    spec = find_spec("ziglang")
    if spec is None or spec.origin is None:
        sys.exit("wheel: needs Zig's compiler and auditwheel: uv sync --group viewer --group wheel")
    return Path(spec.origin).with_name("zig")


def call(*command: str | Path, **variables: str) -> None:
    """Calls a program in the root of the project; ends with its exit status if it fails."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("CMAKE_")} | variables
    done = subprocess.run([str(part) for part in command], cwd=ROOT, env=environment, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode)


def build_source(out: Path) -> Path:
    """The archive of the source."""
    call(uv(), "build", "--quiet", "--sdist", "--out-dir", out)
    return max(out.glob("hedon-*.tar.gz"), key=lambda path: path.stat().st_mtime)


def build_wheel(source: Path, python: str, processor: str, out: Path) -> Path:
    """A wheel of Linux for a Python, as "3.11", and a processor, under the name that says where it runs."""
    raw = out / "raw" / f"{_tag(python)}-{processor}"
    here = _compile(
        *(source, python, raw, f"{processor}-linux-gnu.{GLIBC[0]}.{GLIBC[1]}"),
        NB_SUFFIX=f".{_tag(python).replace('cp', 'cpython-')}-{processor}-linux-gnu.so",
        NB_SUFFIX_S=".abi3.so",
    )
    here = _renamed(here, f"linux_{processor}")
    # auditwheel takes the name of a platform for its own processor alone: it says which C library is needed, for any.
    call(sys.executable, "-m", "auditwheel", "repair", "--wheel-dir", raw / "found", here)
    found = next((raw / "found").glob("*.whl"))
    needed = max((int(a), int(b)) for a, b in re.findall(r"manylinux_(\d+)_(\d+)", found.name))
    if needed > GLIBC:
        sys.exit(f"{found.name} needs a newer C library than {GLIBC[0]}.{GLIBC[1]}")
    return Path(shutil.copy(_renamed(found, f"manylinux_{GLIBC[0]}_{GLIBC[1]}_{processor}"), out))


def build_windows_wheel(source: Path, python: str, out: Path) -> Path:
    """A wheel of Windows for a Python, as "3.11", which is fetched if it is not there."""
    home = fetch_python("windows", python, FOREIGN)
    here = _compile(
        *(source, python, out / "raw" / f"{_tag(python)}-windows", "x86_64-windows-gnu"),
        NB_SUFFIX=f".{_tag(python)}-win_amd64.pyd",
        NB_SUFFIX_S=".pyd",
        Python_INCLUDE_DIR=home / "include",
        Python_LIBRARY=home / "libs" / f"python{python.replace('.', '')}.lib",
    )
    return Path(shutil.copy(_renamed(here, "win_amd64"), out))


def build_macos_wheel(source: Path, python: str, processor: str, out: Path) -> Path:
    """A wheel of macOS for a Python and a processor. Its Python is fetched if it is not there."""
    version = ".".join(map(str, MACOS))
    here = _compile(
        *(source, python, out / "raw" / f"{_tag(python)}-macos-{processor}", f"{processor}-macos.{version}"),
        NB_SUFFIX=f".{_tag(python).replace('cp', 'cpython-')}-darwin.so",
        NB_SUFFIX_S=".abi3.so",
        Python_INCLUDE_DIR=fetch_python("macosx", python, FOREIGN) / "include" / f"python{python}",
    )
    name = f"macosx_{MACOS[0]}_{MACOS[1]}_{processor.replace('aarch64', 'arm64')}"
    return Path(shutil.copy(_renamed(here, name), out))


def _tag(python: str) -> str:
    return "cp" + python.replace(".", "")


def _compile(source: Path, python: str, raw: Path, target: str, **defined: str | Path) -> Path:
    """A wheel with an engine of Zig's, under the name of this machine. `defined` is what CMake is told."""
    shutil.rmtree(raw, ignore_errors=True)
    known = {"HEDON_ZIG": zig(), "HEDON_TARGET": target} | defined
    call(
        *(uv(), "build", "--quiet", "--wheel", "--python", python, "--out-dir", raw, source),
        CMAKE_TOOLCHAIN_FILE=str(ROOT / "cmake" / "zig.cmake"),
        SKBUILD_CMAKE_DEFINE=";".join(f"{name}={value}" for name, value in known.items()),
    )
    return next(raw.glob("*.whl"))


def _renamed(wheel: Path, platform: str) -> Path:
    """The same wheel under the name of another platform."""
    call(sys.executable, "-m", "wheel", "tags", "--remove", "--platform-tag", platform, wheel)
    return next(wheel.parent.glob("*.whl"))


def uv() -> str:
    """The program uv."""
    return shutil.which("uv") or str(ROOT / ".uv" / "bin" / "uv")


def has_python(version: str) -> bool:
    """Whether this Python is installed."""
    command = [uv(), "python", "find", "--no-python-downloads", version]
    return subprocess.run(command, cwd=ROOT, capture_output=True, check=False).returncode == 0


def main() -> None:
    """Builds everything into `dist`."""
    source = build_source(OUT)
    for python in PYTHONS:
        if not has_python(python):
            print(f"wheel: Python {python} is not installed: no wheels for it", file=sys.stderr)
            continue
        for processor in PROCESSORS:
            print(f"wheel: {build_wheel(source, python, processor, OUT)}")
            print(f"wheel: {build_macos_wheel(source, python, processor, OUT)}")
        print(f"wheel: {build_windows_wheel(source, python, OUT)}")


if __name__ == "__main__":
    main()
