"""Builds what can be published from one Linux machine: the source, and wheels of Linux for x86-64 and ARM.

`make wheels` calls it, with the dependency groups `viewer` (Zig's Clang) and `wheel`. Zig links against glibc 2.28,
whatever this machine has, and its own C++ library goes into the wheel, so that it runs on every Linux since 2018. There
is a wheel for each Python that is installed here. The headers of Python for x86-64 serve ARM too: what they say of the
system differs in assembly of the x87 alone, which no extension uses.
"""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PYTHONS = ("3.11", "3.12", "3.13")
PROCESSORS = ("x86_64", "aarch64")
GLIBC = (2, 28)
OUT = ROOT / "dist"


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
    """A wheel of the source for a Python, as "3.11", and a processor, under the name that says where it runs."""
    tag = "cp" + python.replace(".", "")
    raw = out / "raw" / f"{tag}-{processor}"
    shutil.rmtree(raw, ignore_errors=True)
    defined = {
        "HEDON_ZIG": str(zig()),
        "HEDON_TARGET": f"{processor}-linux-gnu.{GLIBC[0]}.{GLIBC[1]}",
        "NB_SUFFIX": f".{tag.replace('cp', 'cpython-')}-{processor}-linux-gnu.so",
        "NB_SUFFIX_S": ".abi3.so",
    }
    call(
        *(uv(), "build", "--quiet", "--wheel", "--python", python, "--out-dir", raw, source),
        CMAKE_TOOLCHAIN_FILE=str(ROOT / "cmake" / "zig.cmake"),
        SKBUILD_CMAKE_DEFINE=";".join(f"{name}={value}" for name, value in defined.items()),
    )
    here = next(raw.glob("*.whl"))
    call(sys.executable, "-m", "wheel", "tags", "--remove", "--platform-tag", f"linux_{processor}", here)
    # auditwheel takes the name of a platform for its own processor alone: it says which C library is needed, for any.
    call(sys.executable, "-m", "auditwheel", "repair", "--wheel-dir", raw / "found", next(raw.glob("*.whl")))
    found = next((raw / "found").glob("*.whl"))
    needed = max((int(a), int(b)) for a, b in re.findall(r"manylinux_(\d+)_(\d+)", found.name))
    if needed > GLIBC:
        sys.exit(f"{found.name} needs a newer C library than {GLIBC[0]}.{GLIBC[1]}")
    policy = f"manylinux_{GLIBC[0]}_{GLIBC[1]}_{processor}"
    call(sys.executable, "-m", "wheel", "tags", "--remove", "--platform-tag", policy, found)
    return Path(shutil.copy(next((raw / "found").glob("*.whl")), out))


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


if __name__ == "__main__":
    main()
