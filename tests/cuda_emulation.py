"""The CUDA kernels emulated on the processor: builds the emulation library and points hedon to it."""

import fcntl
import hashlib
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from project_files import ROOT

sys.path.insert(0, str(ROOT / "engine" / "cuda"))

import build as library_build

from hedon.experiment.device import EMULATED, EMULATION_VARIABLE

SOURCES = ("engine/cuda/emulation.cpp", "engine/cuda/emulator.cpp")
OPTIONS = (
    "-std=c++20",
    "-O1",  # builds in 16 s instead of 26 with -O2; tests run a fifth longer
    "-mavx2",
    "-mfma",  # makes a fused multiply-add one instruction
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fvisibility=hidden",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-fPIC",
    "-shared",
)
THREADS = 64
"""Threads of an emulated block: few, since each barrier visits all of them. A device has 512."""


VARIANTS = library_build.variants()
"""Names of the kernel variants, the default first."""


def build(threads: int = THREADS, *, system_threads: bool = False, variant: str = VARIANTS[0]) -> Path:
    """The library, rebuilt only if a source has changed.

    Args:
        threads: Threads per block.
        system_threads: Use system threads, which run in parallel, instead of fibers, which take turns.
        variant: Variant of the kernels.
    """
    options = [*OPTIONS, f"-DHEDON_BLOCK_THREADS={threads}", library_build.variant_option(variant)]
    if system_threads:
        options += ["-DHEDON_SYSTEM_THREADS", "-pthread"]
    content = hashlib.sha256(" ".join(options).encode())
    for path in sorted([*(ROOT / "engine").rglob("*.h"), *(ROOT / "engine" / "cuda").glob("*.cpp")]):
        content.update(path.read_bytes())
    library = ROOT / "build" / f"cuda-emulated-{content.hexdigest()[:16]}.so"
    library.parent.mkdir(exist_ok=True)
    with library.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # another test worker may be building it
        if not library.exists():
            part = library.with_suffix(f".{os.getpid()}")
            command = ["c++", *options, f"-I{ROOT / 'engine'}", *(str(ROOT / source) for source in SOURCES)]
            subprocess.run([*command, "-o", str(part)], check=True)
            part.rename(library)
    return library


def emulate(monkeypatch: pytest.MonkeyPatch, *arguments: Any, **options: Any) -> str:
    """The name of the emulated device, ready for `Simulation(backend=…)`; the test is skipped without AVX2.

    Takes the same arguments and options as `build`.
    """
    if platform.machine() != "x86_64":
        pytest.skip("the emulation is compiled for AVX2, and compared with it")
    monkeypatch.setenv(EMULATION_VARIABLE, str(build(*arguments, **options)))
    return EMULATED


@pytest.fixture
def emulated(monkeypatch: pytest.MonkeyPatch) -> str:
    """The name of the emulated device, with the kernels of the library."""
    return emulate(monkeypatch)


if __name__ == "__main__":
    print(build())
