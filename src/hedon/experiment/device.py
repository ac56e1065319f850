"""Devices that can advance worlds instead of the processor, and their libraries."""

import os
from pathlib import Path

from hedon import _engine
from hedon.error import EngineError
from hedon.experiment.argument import DEVICES
from hedon.text import count

EMULATED = "cuda-emulated"
"""The device's kernels on the processor, thread by thread; only for tests, which build the library."""
EMULATION_VARIABLE = "HEDON_CUDA_EMULATION"
"""Environment variable with the path of that library."""
LIBRARY = "_cuda.so"
"""The library of the device, next to the engine; `make cuda` builds it."""

WORLDS_PER_CORE = 3
"""Worlds per processor core from which a device is faster: with 200 agents alive, an H100 advances each of up to 64
worlds by 560 to 1,140 steps a second, and a core makes about 1,800 (docs/gpu.md)."""


def few_worlds(worlds: int, cores: int) -> str:
    """A sentence for a run with too few worlds to keep a device busy; empty for more."""
    threshold = WORLDS_PER_CORE * cores
    if worlds >= threshold:
        return ""
    return (
        f"With fewer than about {threshold} worlds, the processor ({count(cores, 'core')}) is probably faster than a "
        "device: leave --backend out."
    )


def is_device(backend: str) -> bool:
    """Whether the backend is a device, not an instruction set."""
    return backend in (*DEVICES, EMULATED)


def library_path() -> Path:
    """Path of the devices' library, whether or not it is built."""
    return Path(_engine.__file__).with_name(LIBRARY)


def device_problem(backend: str) -> str:
    """A sentence on why a device cannot be used here; empty if it can."""
    try:
        _engine.open_device(device_library(backend))
    except EngineError as error:
        return str(error)
    return ""


def device_library(backend: str) -> str:
    """Path of a device's library; empty for an instruction set.

    Raises:
        EngineError: The library does not exist, or is older than the engine.
    """
    if not is_device(backend):
        return ""
    if backend == EMULATED:
        path = Path(os.environ.get(EMULATION_VARIABLE, ""))
        if not path.is_file():
            raise EngineError(f"{EMULATED} is for tests: {EMULATION_VARIABLE} must name its library")
        return str(path.resolve())
    path = library_path()
    if not path.is_file():
        raise EngineError(
            f"device '{backend}' cannot be used: its library is not built: call `make cuda` (docs/gpu.md), or leave "
            "--backend out"
        )
    if path.stat().st_mtime < Path(_engine.__file__).stat().st_mtime:
        raise EngineError(
            f"device '{backend}' cannot be used: its library is older than the engine, so it might compute something "
            "else: call `make cuda` again, or leave --backend out"
        )
    return str(path)
