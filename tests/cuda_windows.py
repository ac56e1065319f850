"""Windows of the emulated CUDA kernels under a sanitizer: `native/cuda_windows.cpp`, as run by `sanitize.py`.

In the thread sanitizer's build, every thread of a block is a system thread. The sanitizer therefore detects races that
could occur on a device: two threads that access the same value without a barrier in between. It checks the processor's
thread teams, with which the kernels are compared, in the same way. In the other build, a block has 512 threads, as on a
device, and the address sanitizer knows each thread's stack.
"""

import os
import platform
import subprocess
import sys
from pathlib import Path

from project_files import ROOT

from hedon.config.load import load_config
from hedon.view.engine_text import engine_text

WINDOW = 16
SHORT = (f"world.rollout_steps={WINDOW}", "learning.minibatch_size=8", "learning.update_epochs=2")
FEW = (*SHORT, "population.capacity=16", "population.initial_count=10")
TINY = ("world.rollout_steps=4", "learning.minibatch_size=4", "learning.update_epochs=1")
TINY_FEW = (*TINY, "population.capacity=6", "population.initial_count=4")
BOTH = tuple(
    f"species.{name}.population.{size}" for name in ("prey", "predator") for size in ("capacity=8", "initial_count=6")
)
WORLDS = {
    "baseline": ("baseline", FEW),
    "poison": ("poison", FEW),
    "relocation": ("relocation", FEW),
    "predators": ("predator", (*SHORT, *BOTH, "arena.width=300", "arena.height=300")),
    "obstacles": ("small", (*FEW, "obstacle.count=8", "obstacle.damage=0.5", 'sensor.smells=["*"]', "sensor.noses=2")),
    "crowd": ("small", (*FEW, 'physics.solver="jacobi"', "arena.width=120", "arena.height=120")),
    # Bodies that outrun their neighbor lists within a step, which is then retried.
    "fast": ("baseline", (*FEW, "physics.neighbor_skin=0.5", "physics.max_speed=30", "motor.max_force=300")),
    "pairs": (
        "baseline",
        (*FEW, "birth.network=learned", "birth.mating=pairs", "birth.kappa=0.5", "birth.mating_range=200"),
    ),
    "bodies": (
        "baseline",
        (*FEW, "birth.kappa=0.5", "genome.set.body.radius={}", "genome.mutation.g_body_radius.limit=0.2"),
    ),
}
"""Presets and overrides of the worlds to run."""
BARRIERS = 12
FOUND = {"--without": ("block", 9), "--without-tile": ("tile", 4)}
"""Of the first 12 barriers of each block and each tile, this many must be reported when left out; the others may
separate phases that share nothing in such a small world."""
PATIENCE_SECONDS = 20
"""Without a barrier, threads may also diverge and wait forever."""


def build(preset: str) -> Path:
    """The program, built with a preset from CMakePresets.json."""
    configure = ["cmake", "--preset", preset, f"-DPython_EXECUTABLE={sys.executable}"]
    subprocess.run(configure, cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    folder = ROOT / "build" / preset
    subprocess.run(["cmake", "--build", str(folder), "--target", "cuda_windows"], check=True, stdout=subprocess.DEVNULL)
    return folder / "cuda_windows"


def write_worlds(folder: Path) -> list[str]:
    """Writes the worlds as text files; returns their paths, the tiny one first."""
    worlds = {"tiny": ("baseline", TINY_FEW), **WORLDS}
    for name, (preset, overrides) in worlds.items():
        (folder / f"{name}.txt").write_text(engine_text(load_config(preset, overrides=overrides), 1))
    return [str(folder / f"{name}.txt") for name in worlds]


def finds(program: Path, world: str, without: str, barrier: int, environment: dict[str, str]) -> bool:
    """Whether omitting a barrier is noticed: the thread sanitizer reports it, a bit differs or the program hangs."""
    command = [str(program), without, str(barrier), "5", world]
    try:
        done = subprocess.run(command, env=environment, timeout=PATIENCE_SECONDS, capture_output=True, check=False)
    except subprocess.TimeoutExpired:
        return True
    return done.returncode != 0


def run_windows(preset: str, options: dict[str, str], folder: Path) -> int:
    """Builds and runs the program; returns an exit status."""
    if platform.machine() != "x86_64":
        print("cuda_windows: nothing run, since the kernels are compared with AVX2")
        return 0
    program = build(preset)
    environment = os.environ | options
    tiny, *files = write_worlds(folder)
    status = subprocess.run([str(program), str(WINDOW + 1), *files], env=environment, check=False).returncode
    if status == 0 and preset == "tsan":
        for without, (of, least) in FOUND.items():
            found = sum(finds(program, tiny, without, barrier, environment) for barrier in range(BARRIERS))
            print(f"cuda_windows: of {BARRIERS} barriers of a {of} that were left out, {found} were reported")
            status = status if found >= least else 1
    return status
