"""The longest way of a step through a block, counted in accesses of memory: `python tests/cuda_step.py [--write]`.

No device is needed: `native/step_accesses.cpp` counts in the emulation, with a device's 512 threads. A thread of a
device waits for most of its accesses, so the way says how long a step takes at least, once one knows how long an access
takes; and it says which part to shorten first.
"""

import json
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
    "cuda/sense.h": "sense_and_act",
    "physics/neighbor.h": "neighbor_list",
    "physics/grid.h": "neighbor_list",
    "physics/step.h": "islands",
    "world/": "rules",
    "cuda/window.h": "",  # the beginning of a run
}
"""Where the work before a barrier belongs: by the innermost of these sources around it."""
SHARES = {"rules": ("rules_of_all_threads", "rules_of_one_thread")}
"""Phases that are told apart by whether one thread was alone."""


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


def phase_of(program: Path, address: str) -> str:
    """The phase that a place of the code belongs to."""
    call = hex(int(address, 16) - 1)  # it returns to the address, which may belong to what comes after
    command = ["addr2line", "-i", "-e", str(program), call]
    places = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for place in places.splitlines():
        for source, phase in PHASES.items():
            if f"/engine/{source}" in place:
                return phase
    raise ValueError(f"no phase has a barrier at {address}: {places}")


def count(program: Path, preset: str) -> dict[str, float]:
    """Accesses of the longest way, by phase, per step; and how many agents there were."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "world.txt"
        world.write_text(engine_text(load_config(preset), 1))
        command = [str(program), str(WARM_STEPS), str(STEPS), str(world)]
        first, *lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    phases = [part for phase in PHASES.values() if phase for part in SHARES.get(phase, (phase,))]
    found = {"alive": float(first.split()[1]), **dict.fromkeys(phases, 0.0)}
    for line in lines:
        address, *numbers = line.split()
        _, way, most, second, _ = map(float, numbers)
        if most > 0 and (phase := phase_of(program, address)):
            found[SHARES[phase][second < ALONE * most] if phase in SHARES else phase] += way
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
