"""Runs all checks of a CUDA device in under ten minutes, into one JSON: `python3 tests/device.py [--out FILE]`.

It needs a device with its driver, nvcc (from CUDA or the package `nvidia-cuda-nvcc`), a C++ compiler, and Python with
only its standard library. It builds a native program (`native/device_trial.cpp`), compares its bits with the
processor's, looks for invalid addresses and races with compute-sanitizer if installed, and measures times. If this
Python has hedon, it also builds hedon's library, interrupts a run and resumes it on the processor. `--variants` instead
compares the bits and times of all kernel variants. `--emulate` uses the emulated device instead, to try out this
script. Exit status: 0 if all checks pass, 1 if one fails, 2 without a device.
"""

import argparse
import ctypes
import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
import time
from pathlib import Path
from typing import Any

from device_build import PLACE, ROOT, build, build_programs
from device_trial import FEW, FULL, SMALL, WINDOW, Trial, presets, world
from device_variants import compare_variants

SANITIZERS = ("memcheck", "racecheck", "synccheck", "initcheck")


def build_default(emulated: bool) -> Path:
    """The native program with the library's kernels.

    Raises:
        BuildError: A compiler is missing or fails.
    """
    default = build.variants()[0]
    return build_programs(emulated, [default])[default]


def has_device() -> bool:
    """Whether the CUDA driver is installed and finds a device."""
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return False
    count = ctypes.c_int(0)
    return driver.cuInit(0) == 0 and driver.cuDeviceGetCount(ctypes.byref(count)) == 0 and count.value > 0


def compute_sanitizer() -> str | None:
    """NVIDIA's kernel checker, from PATH, CUDA or the package `nvidia-cuda-sanitizer-api`."""
    places = Path(sysconfig.get_path("purelib")) / "nvidia"
    found = [shutil.which("compute-sanitizer"), *map(str, places.rglob("compute-sanitizer"))]
    return next(
        (place for place in [*found, "/usr/local/cuda/bin/compute-sanitizer"] if place and Path(place).is_file()), None
    )


def sanitized(trial: Trial, program: str, folder: Path) -> dict[str, Any]:
    """A short window under each tool of compute-sanitizer."""
    tool = compute_sanitizer()
    command = ["same", "17", "2", world("baseline", folder, FEW)]
    if trial.emulated:
        return {"emulated": trial.call(program, *command)}
    if tool is None:
        return {"skipped": "no compute-sanitizer in PATH, CUDA or the package nvidia-cuda-sanitizer-api"}
    options = ("--error-exitcode", "9", "--print-limit", "5")
    return {name: trial.call(tool, "--tool", name, *options, program, *command, most=60.0) for name in SANITIZERS}


def free_bytes(trial: Trial) -> int:
    """Memory available for worlds, on the device and on this machine, which keeps a copy of each."""
    here = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return min(here, trial.found["device"].get("free_bytes", here))


def times(trial: Trial, program: str, folder: Path) -> dict[str, Any]:
    """World-steps per second for several numbers of worlds; with full learning and with a single epoch."""
    full = world("baseline", folder, {**FULL, **(FEW if trial.emulated else {})})
    acting = world("baseline", folder, {**FULL, "learning.update_epochs": 1, **(FEW if trial.emulated else {})})
    numbers = (1, 2) if trial.emulated else (1, 16, 64, 128, 256, 512)
    seconds = "0.1" if trial.emulated else f"{min(4.0, trial.left() / 100):.2f}"
    found: dict[str, Any] = {}
    for n in numbers:
        room, need = free_bytes(trial), n * found["1"].get("bytes_per_world", 0) if found else 0
        fits = need < 0.9 * room
        found[str(n)] = (
            trial.call(program, "time", seconds, str(n), full, most=75.0) if fits else {"skipped": f"{need:,} bytes"}
        )
    found["one_epoch"] = trial.call(program, "time", seconds, str(numbers[-2]), acting, most=60.0)
    predators = world("predator", folder, SMALL if trial.emulated else {})
    if not trial.emulated:
        found["predator"] = trial.call(program, "time", seconds, "64", predators, most=60.0)
    return found


def commands(trial: Trial, folder: Path) -> dict[str, Any]:
    """Interrupts a run of `hedon run --backend cuda`, resumes it on the processor and checks it."""
    kernel = "cuda-emulated" if trial.emulated else "cuda"
    environment, device = ({"HEDON_BACKEND": kernel}, ()) if trial.emulated else ({}, ("--backend", kernel))
    if subprocess.run([sys.executable, "-c", "import hedon"], capture_output=True, check=False).returncode != 0:
        return {"skipped": "this Python has no hedon"}
    if trial.emulated:
        sys.path.insert(0, str(ROOT / "tests"))
        import cuda_emulation

        environment["HEDON_CUDA_EMULATION"] = str(cuda_emulation.build())
    elif not build.beside_engine().exists():
        build.build(build.beside_engine())
    hedon = [sys.executable, "-c", "from hedon.cli.start import main; main()"]
    settings = [f"--set={path}={value}" for path, value in (FEW if trial.emulated else FULL).items()]
    steps = str(30 * SMALL["world.rollout_steps"] if trial.emulated else 64 * WINDOW)
    arguments = ["baseline", "--seeds", "1-4", "--steps", steps, *settings]
    out, whole = folder / "run", folder / "whole"
    begun = time.monotonic()
    run = subprocess.Popen(
        [*hedon, "run", *arguments, *device, "--out", str(out)], env=os.environ | environment, stdout=subprocess.DEVNULL
    )
    while not list(out.glob("checkpoints/*")) and run.poll() is None and time.monotonic() < begun + 60:
        time.sleep(0.02)
    time.sleep(0.3)
    run.send_signal(signal.SIGINT)
    status = run.wait(timeout=60)
    found: dict[str, Any] = {"interrupted_after_seconds": round(time.monotonic() - begun, 2), "status": status}
    for name, more in (
        ("resume", ("resume", str(out))),
        ("check", ("check", str(out))),
        ("whole", ("run", *arguments, "--out", str(whole))),
    ):
        found[name] = trial.call(*hedon, *more, most=90.0)
    digests = [
        json.loads((place / "manifest.json").read_text())
        for place in (out, whole)
        if (place / "manifest.json").exists()
    ]
    found["kernels"] = [session["backend"] for session in digests[0]["sessions"]] if digests else []
    if any("skipped" in found[name] for name in ("resume", "check", "whole")):
        return found
    same = len(digests) == 2 and all(digests[0][key] == digests[1][key] for key in ("world_digests", "records_digest"))
    return found if same else {**found, "failed": "the interrupted run has other digests than the whole one"}


def all_parts(trial: Trial, folder: Path, built: Path | None) -> None:
    """Runs all parts, the most important first."""
    program = str(trial.part("program", lambda: str(built or build_default(trial.emulated))))
    trial.part("device", lambda: trial.call(program, "describe"))
    steps = (
        {"one_window": SMALL["world.rollout_steps"] + 2}
        if trial.emulated
        else {"first_steps": 3, "one_window": WINDOW + 76}
    )
    few = FEW if trial.emulated else {}
    for name, count in steps.items():
        trial.part(
            f"same_{name}",
            lambda count=count: {
                preset: trial.call(program, "same", str(count), "2", world(preset, folder, few), most=60.0)
                for preset in presets()
            },
        )
    length = str(SMALL["world.rollout_steps"] + 1 if trial.emulated else WINDOW + 1)
    trial.part("repeat", lambda: trial.call(program, "repeat", length, "16", world("baseline", folder, few)))
    part = str(11 if trial.emulated else 700)
    trial.part("resume", lambda: trial.call(program, "resume", part, world("baseline", folder, few)))
    trial.part("times", lambda: times(trial, program, folder))
    trial.part("sanitizers", lambda: sanitized(trial, program, folder))
    trial.part("commands", lambda: commands(trial, folder))


def main() -> int:
    """Runs as many parts as there is time for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=PLACE / "device.json", help="where the JSON goes")
    parser.add_argument("--seconds", type=float, default=570.0, help="after which nothing new begins")
    parser.add_argument("--emulate", action="store_true", help="the emulated device, to try this script")
    parser.add_argument(
        "--build", action="store_true", help="build the native programs and nothing else: no device is needed"
    )
    parser.add_argument("--variants", action="store_true", help="compare all variants of the kernels, and nothing else")
    parser.add_argument("--program", type=Path, help="the native program that --build has made, on another machine too")
    given = parser.parse_args()
    if given.program is not None and not given.program.is_file():
        print(f"device: --program {given.program}: there is no such file: make it by --build", file=sys.stderr)
        return 2
    if not given.build and not given.emulate and not has_device():
        print("device: this machine has no CUDA device, or its driver is missing: nothing was tried", file=sys.stderr)
        return 2
    program = given.program.resolve() if given.program else None
    with tempfile.TemporaryDirectory() as folder:
        try:
            names = build.variants() if given.variants else build.variants()[:1]
            programs = build_programs(given.emulate, names) if given.build or given.variants else {}
            if given.build:
                print("\n".join(f"device: {path}" for path in programs.values()))
                return 0
            trial = Trial(given.out, given.seconds, given.emulate)  # its clock starts after the build
            if given.variants:
                compare_variants(trial, Path(folder), programs)
            else:
                all_parts(trial, Path(folder), program)
        except build.BuildError as error:
            print(f"device: {error}", file=sys.stderr)
            return 2
    for failure in trial.found["failures"]:
        print(f"device: FAILED {failure}", file=sys.stderr)
    print(f"device: {trial.found['seconds']} s, wrote {given.out}")
    return 1 if trial.found["failures"] else 0


if __name__ == "__main__":
    sys.exit(main())
