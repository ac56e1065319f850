"""Counts the memory accesses on the longest path of a step through a block: `python tests/cuda_step.py [--write]`.

No device is needed: `native/step_accesses.cpp` counts in the emulation, with as many threads as on a device. Threads on
a device wait for most of their accesses, so the number of accesses times their duration is a lower bound on the time of
a step, and shows which part to shorten first. Two numbers are kept: all accesses, and accesses to global memory, which
take longer than accesses to shared memory.
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
VARIANTS = ("shared_moments", "shared_bodies", "half_blocks")
"""Kernel variants that step in different ways."""
WARM_STEPS, STEPS = 4096, 64
SLACK = 0.15
"""Other compilers keep other values in registers."""
ALONE = 0.1
"""A thread counts as working alone if no other makes at least this share of its accesses."""

PHASES = {
    "cuda/sense.h": "sense_and_act",
    "physics/neighbor.h": "neighbor_list",
    "physics/grid.h": "neighbor_list",
    "physics/step.h": "islands",
    "world/": "rules",
    "cuda/window.h": "",  # the beginning of a run
}
"""Phase of the work before a barrier, by the innermost of these sources around it."""
SHARES = {"rules": ("rules_of_all_threads", "rules_of_one_thread")}
"""Phases that are split by whether one thread worked alone."""


def build() -> dict[str, Path]:
    """The counting programs, by variant."""
    folder = ROOT / "build" / "cuda-step"
    options = ("-DHEDON_CUDA_WINDOWS=ON", "-DHEDON_PYTHON=OFF", "-DCMAKE_BUILD_TYPE=Release")
    programs = {variant: folder / f"step_{variant}" for variant in VARIANTS}
    for command in (
        ["-S", str(ROOT), "-B", str(folder), *options, f"-DHEDON_COUNTED_VARIANTS={';'.join(VARIANTS)}"],
        ["--build", str(folder), "--target", *(program.name for program in programs.values())],
    ):
        subprocess.run(["cmake", *command], check=True, stdout=subprocess.DEVNULL)
    return programs


def phase_of(program: Path, address: str) -> str:
    """The phase that a code address belongs to."""
    call = hex(int(address, 16) - 1)  # the address is where the call returns to, which may be in the next phase
    command = ["addr2line", "-i", "-e", str(program), call]
    places = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for place in places.splitlines():
        for source, phase in PHASES.items():
            if f"/engine/{source}" in place:
                return phase
    raise ValueError(f"no phase has a barrier at {address}: {places}")


def count(program: Path, preset: str) -> dict[str, list[int]]:
    """Accesses on the longest path of a step, by phase: all accesses, and accesses to global memory."""
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "world.txt"
        world.write_text(engine_text(load_config(preset), 1))
        command = [str(program), str(WARM_STEPS), str(STEPS), str(world)]
        _, *lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    phases = [part for phase in PHASES.values() if phase for part in SHARES.get(phase, (phase,))]
    found = {phase: [0.0, 0.0] for phase in phases}
    for line in lines:
        address, *numbers = line.split()
        _, way, global_way, most, second, _ = map(float, numbers)
        if most > 0 and (phase := phase_of(program, address)):
            ways = found[SHARES[phase][second < ALONE * most] if phase in SHARES else phase]
            ways[0] += way
            ways[1] += global_way
    return {phase: [round(way) for way in ways] for phase, ways in found.items()}


def problems(variant: str, found: dict[str, list[int]], kept: dict[str, list[int]]) -> list[str]:
    """Phases whose longest path differs from the table."""
    return [
        f"{variant}, {phase}: {found[phase]} accesses a step, and the table has {kept[phase]}: call "
        "`python tests/cuda_step.py --write` if that is right"
        for phase in kept
        if any(abs(now - then) > SLACK * then for now, then in zip(found[phase], kept[phase], strict=True))
    ]


def main() -> int:
    found = {variant: count(program, "baseline") for variant, program in build().items()}
    if "--write" in sys.argv:
        TABLE.write_text(json.dumps(found, indent=2) + "\n")
    kept = json.loads(TABLE.read_text())
    wrong = [line for variant in VARIANTS for line in problems(variant, found[variant], kept[variant])]
    for line in wrong:
        print(f"cuda_step: {line}", file=sys.stderr)
    for variant, phases in found.items():
        way, global_way = map(sum, zip(*phases.values(), strict=True))
        print(f"cuda_step: {variant}: {way:,} accesses on the longest way of a step, {global_way:,} of global memory")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
