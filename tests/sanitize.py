"""Builds the engine with sanitizers and runs tests on it: `python tests/sanitize.py asan|tsan [PYTEST ARGUMENTS]`.

With `--cuda` instead of pytest arguments, it runs windows of the emulated CUDA kernels: see `cuda_windows.py`.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from cuda_windows import run_windows

ROOT = Path(__file__).parents[1]
RUNTIMES = {"asan": ("libasan.so", "libubsan.so"), "tsan": ("libtsan.so",)}
TESTS = {
    "asan": [
        "tests/unit/test_life.py",
        "tests/crosscheck/test_sensor.py",
        "tests/property/test_world.py",
        "tests/property/test_untrusted_checkpoint.py",
        # Its input is refused before it reaches the engine.
        "--deselect=tests/property/test_untrusted_checkpoint.py::test_every_array_is_checked",
        "tests/physics",
    ],
    "tsan": ["tests/contract/test_determinism.py"],
}
OPTIONS = {
    # The interpreter itself never frees everything, and its own threads are not under test.
    "ASAN_OPTIONS": "detect_leaks=0:halt_on_error=1:abort_on_error=0",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
    # Mutex deadlocks are not checked: the engine has no mutexes, and the allocator of Polars has more than the
    # sanitizer can count.
    "TSAN_OPTIONS": "halt_on_error=1:exitcode=66:detect_deadlocks=0",
    # That allocator also starts a thread that is unknown to the sanitizer and makes it crash.
    "_RJEM_MALLOC_CONF": "background_thread:false",
}


def build(preset: str) -> Path:
    """Builds the extension module with a preset from CMakePresets.json and returns its path."""
    configure = ["cmake", "--preset", preset, f"-DPython_EXECUTABLE={sys.executable}"]
    subprocess.run(configure, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    folder = ROOT / "build" / preset
    subprocess.run(["cmake", "--build", str(folder), "--target", "_engine"], check=True, stdout=subprocess.DEVNULL)
    return next(folder.glob("_engine*.so"))


def runtime(name: str) -> str:
    """Path of a sanitizer's runtime library, according to the compiler."""
    return subprocess.run(
        ["g++", f"-print-file-name={name}"], capture_output=True, text=True, check=True
    ).stdout.strip()


def main(preset: str, arguments: list[str]) -> int:
    """Builds, then runs the tests in a process that loads the sanitizer's runtime first."""
    if arguments == ["--cuda"]:
        with tempfile.TemporaryDirectory() as folder:
            return run_windows(preset, OPTIONS, Path(folder))
    module = build(preset)
    libraries = [runtime(name) for name in (*RUNTIMES[preset], "libstdc++.so")]
    # In files, since pytest keeps what workers print, and loses it when they end.
    report = module.with_name("report")
    options = {name: f"{value}:log_path={report}" for name, value in OPTIONS.items() if name.endswith("SAN_OPTIONS")}
    environment = os.environ | OPTIONS | options
    environment |= {"LD_PRELOAD": " ".join(libraries), "HEDON_SANITIZED": str(module)}
    environment["PYTHONPATH"] = str(ROOT / "tests")
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "sanitized_engine"]
    command += ["--numprocesses", "2", "--dist", "worksteal", *(arguments or TESTS[preset])]
    for old in report.parent.glob("report.*"):
        old.unlink()
    code = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
    for path in report.parent.glob("report.*"):
        print(path.read_text(errors="replace"), file=sys.stderr)
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
