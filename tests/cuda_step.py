"""The longest way of a step through a block, counted in accesses of memory: `python tests/cuda_step.py [--write]`.

No device is needed: `native/step_accesses.cpp` counts in the emulation, with a device's 256 threads. A thread of a
device waits for most of its accesses, so the way says how long a step takes at least, once one knows how long an access
takes; and it says which part to shorten first.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from project_files import ROOT

from hedon.config.load import load_config
from hedon.view.engine_text import engine_text

TABLE = ROOT / "tests" / "data" / "cuda_step.json"
WARM_STEPS, STEPS = 4096, 64
SLACK = 0.15
"""Another compiler keeps other numbers in registers."""
ALONE = 0.1
"""Of the accesses of the thread with the most, if no other thread has so many, that thread works alone."""

PHASES = {
    ("sense_and_act", False): "sense_and_act",
    ("build_neighbors", False): "neighbor_list",
    ("build_neighbors", True): "neighbor_list",
    ("physics_step", False): "islands",
    ("step", False): "rules_of_all_threads",
    ("step", True): "rules_of_one_thread",
}
"""Where the work belongs: by the innermost of these functions with the barrier that ends it, and whether one thread was
alone."""
BEFORE_ALL_STEPS = "StepWorlds::operator"


def build() -> Path:
    """The counting program."""
    folder = ROOT / "build" / "cuda-step"
    options = ("-DHEDON_CUDA_WINDOWS=ON", "-DHEDON_PYTHON=OFF", "-DCMAKE_BUILD_TYPE=Release")
    for command in (
        ["-S", str(ROOT), "-B", str(folder), *options],
        ["--build", str(folder), "--target", "step_accesses"],
    ):
        subprocess.run(["cmake", *command], check=True, stdout=subprocess.DEVNULL)
    return folder / "step_accesses"


def function_of(program: Path, address: str) -> str:
    """The innermost of the functions of `PHASES` that holds a place of the code; "" for the beginning of a run."""
    call = hex(int(address, 16) - 1)  # it returns to the address, which may belong to what comes after
    command = ["addr2line", "-Cfi", "-e", str(program), call]
    names = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for line in names.splitlines():
        for function, _ in PHASES:
            if re.search(rf"\bhedon::{function}\b[<(]", line):
                return function
        if BEFORE_ALL_STEPS in line:
            return ""
    raise ValueError(f"no phase has a barrier at {address}: {names}")


def count(program: Path, preset: str) -> dict[str, float]:
    """Accesses of the longest way, by phase, per step; and how many agents there were."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "world.txt"
        world.write_text(engine_text(load_config(preset), 1))
        command = [str(program), str(WARM_STEPS), str(STEPS), str(world)]
        first, *lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    found = {"alive": float(first.split()[1]), **dict.fromkeys(PHASES.values(), 0.0)}
    for line in lines:
        address, *numbers = line.split()
        _, way, most, second, _ = map(float, numbers)
        if most > 0 and (function := function_of(program, address)):
            found[PHASES[function, second < ALONE * most]] += way
    return {name: round(value) for name, value in found.items()}


def problems(found: dict[str, float], kept: dict[str, float]) -> list[str]:
    """Where the way is another one than the table says."""
    return [
        f"{name}: {found[name]:,.0f} accesses a step, and the table has {kept[name]:,.0f}: call "
        "`python tests/cuda_step.py --write` if that is right"
        for name in kept
        if abs(found[name] - kept[name]) > SLACK * kept[name]
    ]


def main() -> int:
    found = count(build(), "baseline")
    if "--write" in sys.argv:
        TABLE.write_text(json.dumps(found, indent=2) + "\n")
    wrong = problems(found, json.loads(TABLE.read_text()))
    for line in wrong:
        print(f"cuda_step: {line}", file=sys.stderr)
    print(f"cuda_step: {sum(found.values()) - found['alive']:,.0f} accesses on the longest way of a step")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
