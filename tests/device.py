"""All there is to see on a CUDA device, in under ten minutes, into one JSON: `python3 tests/device.py [--out FILE]`.

It needs a device with its driver, nvcc (of CUDA, or of the package `nvidia-cuda-nvcc`) and a C++ compiler, and of
Python the standard library alone. It builds a native program (`native/device_trial.cpp`), compares bits with the
processor's, looks for wrong addresses and races with compute-sanitizer if that is there, and takes times. Where this
Python has hedon, it also builds its library, interrupts a run and resumes it on the processor. `--emulate` does the
same on the emulated device, to try this script. Exit status: 0 all is well, 1 something is not, 2 there is no device.
"""

import argparse
import ctypes
import json
import os
import platform
import re
import shutil
import signal
import subprocess
import sys
import sysconfig
import tempfile
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "engine" / "cuda"))

import build  # noqa: E402

TEXTS = ROOT / "tests" / "data" / "device"
PLACE = ROOT / "build" / "device"
CPU_OPTIONS = ("-std=c++20", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-pthread")
FOR_FILE = {
    "avx2.cpp": ("-mavx2", "-mfma"),
    "avx512.cpp": ("-mavx512f", "-mavx512dq", "-mavx512bw", "-mavx512vl", "-mfma", "-mprefer-vector-width=512"),
    "emulation.cpp": ("-mavx2", "-mfma", "-DHEDON_BLOCK_THREADS=64"),
}
WINDOW = 1024
SMALL = {"world.rollout_steps": 16, "learning.minibatch_size": 8, "learning.update_epochs": 2}
FEW = {**SMALL, "population.capacity": 16, "population.initial_count": 10}
FULL = {"population.initial_count": 150}
"""As many agents as a world of the baseline has in the long run."""
SANITIZERS = ("memcheck", "racecheck", "synccheck", "initcheck")
RESERVE_SECONDS = 15


class Trial:
    """The run of this script: its clock, and what it has found, which is on disk after each part."""

    def __init__(self, out: Path, seconds: float, emulated: bool) -> None:
        self.out, self.emulated = out, emulated
        self.begun, self.end = time.monotonic(), time.monotonic() + seconds
        self.found: dict[str, Any] = {"emulated": emulated, "machine": platform.platform(), "failures": []}

    def left(self, most: float = 1e9) -> float:
        """Seconds that a part may take."""
        return min(most, self.end - time.monotonic() - RESERVE_SECONDS)

    def call(self, *command: str, most: float = 120.0, environment: dict[str, str] | None = None) -> dict[str, Any]:
        """What a command prints as JSON in its last line, or what went wrong."""
        seconds = self.left(most)  # as long as it may take, unless the trial ends before
        if seconds < 1:
            return {"skipped": "no time was left"}
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                text=True,
                timeout=seconds,
                check=False,
                env=os.environ | (environment or {}),
            )
        except subprocess.TimeoutExpired:
            word = "failed" if seconds == most else "skipped"
            return {word: f"it took more than {seconds:.0f} s"}
        lines = done.stdout.strip().splitlines()
        parsed = json.loads(lines[-1]) if lines and lines[-1].startswith("{") else {}
        if done.returncode == 0:
            return parsed
        return {**parsed, "failed": f"status {done.returncode}", "said": (done.stdout + done.stderr)[-2000:]}

    def part(self, name: str, make: Callable[[], Any]) -> Any:
        """Does a part, keeps what it found, and says so."""
        begun = time.monotonic()
        found = make()
        self.found[name] = found
        self.found["failures"] += failures(name, found)
        self.found["seconds"] = round(time.monotonic() - self.begun, 1)
        self.out.parent.mkdir(parents=True, exist_ok=True)
        self.out.write_text(json.dumps(self.found, indent=2) + "\n")
        print(f"device: {name}, {time.monotonic() - begun:.1f} s: {json.dumps(found)[:300]}", flush=True)
        return found


def failures(name: str, found: Any) -> list[str]:
    """The places in what was found that say "failed"."""
    if not isinstance(found, dict):
        return []
    here = [f"{name}: {found['failed']}"] if "failed" in found else []
    return here + [line for key, inner in found.items() for line in failures(f"{name}.{key}", inner)]


def has_device() -> bool:
    """Whether CUDA's driver is there and knows a device."""
    try:
        driver = ctypes.CDLL("libcuda.so.1")
    except OSError:
        return False
    count = ctypes.c_int(0)
    return driver.cuInit(0) == 0 and driver.cuDeviceGetCount(ctypes.byref(count)) == 0 and count.value > 0


def build_program(emulated: bool) -> Path:
    """The native program, by as many compilers at a time as there are processors.

    Raises:
        BuildError: A compiler is missing, or fails.
    """
    engine, place = ROOT / "engine", PLACE / ("emulated" if emulated else "cuda")
    place.mkdir(parents=True, exist_ok=True)
    sources = [path for part in ("base", "kernel", "simulation") for path in sorted((engine / part).glob("*.cpp"))]
    sources += [engine / "web" / "input.cpp", ROOT / "tests" / "native" / "device_trial.cpp"]
    compiler = os.environ.get("CXX") or next(filter(None, map(shutil.which, ("c++", "g++", "clang++"))), "c++")
    commands, libraries = [], []
    if emulated:
        sources += [engine / "cuda" / "emulation.cpp", engine / "cuda" / "emulator.cpp"]
    else:
        nvcc = build.find_nvcc()
        if nvcc is None:
            raise build.BuildError("no nvcc in CUDA_HOME, PATH or this environment")
        kernels = str(place / "kernels.o")
        commands += [build.command(nvcc, "-c", build.HOST, "-o", kernels, str(engine / "cuda" / "device.cu"))]
        libraries = [kernels, *build.runtime_options(nvcc), "-lcudart_static", "-ldl", "-lrt"]
    objects = [str(place / f"{source.parent.name}-{source.stem}.o") for source in sources]
    for source, made in zip(sources, objects, strict=True):
        options = [*CPU_OPTIONS, *FOR_FILE.get(source.name, ()), f"-I{engine}"]
        commands.append([compiler, *options, "-c", str(source), "-o", made])
    compile_all(commands)
    compile_all([[compiler, "-pthread", *objects, *libraries, "-o", str(place / "device_trial")]])
    return place / "device_trial"


def compile_all(commands: list[list[str]]) -> None:
    """Calls compilers, as many at a time as there are processors.

    Raises:
        BuildError: One of them fails.
    """
    running: list[subprocess.Popen[str]] = []
    for command in commands:
        while sum(process.poll() is None for process in running) >= (os.cpu_count() or 1):
            time.sleep(0.05)
        running.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True))
    for process in running:
        said = process.communicate()[1]
        if process.returncode != 0:
            raise build.BuildError(f"a compiler fails:\n{said[-2000:]}")


def world(name: str, folder: Path, changes: Mapping[str, object]) -> str:
    """The file of a world: a text of `data/device` with some settings changed, in all species."""
    lines = (TEXTS / f"{name}.txt").read_text().splitlines()
    for path, value in changes.items():
        place = re.compile(rf"(species\[\d\]\.)?{re.escape(path)}=")
        at = [i for i, line in enumerate(lines) if place.match(line)]
        if not at:
            raise KeyError(path)
        for i in at:
            lines[i] = f"{lines[i].split('=')[0]}={value}"
    file = folder / f"{name}-{abs(hash(tuple(changes.items())))}.txt"
    file.write_text("\n".join(lines) + "\n")
    return str(file)


def presets() -> list[str]:
    """Names of the worlds that are kept as texts."""
    return sorted(path.stem for path in TEXTS.glob("*.txt"))


def compute_sanitizer() -> str | None:
    """NVIDIA's checker of kernels: of PATH, of CUDA, or of the package `nvidia-cuda-sanitizer-api`."""
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
    """Memory that worlds can have, on the device and on this machine, which keeps a copy of each."""
    here = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return min(here, trial.found["device"].get("free_bytes", here))


def times(trial: Trial, program: str, folder: Path) -> dict[str, Any]:
    """World-steps per second over numbers of worlds; with full learning, and without any."""
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
    """A run by `hedon run --backend cuda` that is interrupted, resumed on the processor, and checked."""
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
    """Everything, the most important first."""
    program = str(trial.part("program", lambda: str(built or build_program(trial.emulated))))
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
    """Does all parts that there is time for."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, default=PLACE / "device.json", help="where the JSON goes")
    parser.add_argument("--seconds", type=float, default=570.0, help="after which nothing new begins")
    parser.add_argument("--emulate", action="store_true", help="the emulated device, to try this script")
    parser.add_argument(
        "--build", action="store_true", help="build the native program and nothing else: no device is needed"
    )
    parser.add_argument("--program", type=Path, help="the native program that --build has made, on another machine too")
    given = parser.parse_args()
    if given.program is not None and not given.program.is_file():
        print(f"device: --program {given.program}: there is no such file: make it by --build", file=sys.stderr)
        return 2
    if not given.build and not given.emulate and not has_device():
        print("device: this machine has no CUDA device, or its driver is missing: nothing was tried", file=sys.stderr)
        return 2
    trial = Trial(given.out, given.seconds, given.emulate)
    program = given.program.resolve() if given.program else None
    with tempfile.TemporaryDirectory() as folder:
        try:
            if given.build:
                print(f"device: {build_program(given.emulate)}")
                return 0
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
