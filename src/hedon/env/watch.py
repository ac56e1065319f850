"""Records of worlds that a JAX program advances: the engine calls this module, so the program need not."""

import ctypes
import time
from pathlib import Path
from typing import Any

import numpy as np

from hedon.env.record import Records
from hedon.error import HedonError
from hedon.experiment.simulation import Simulation

CALLBACK = ctypes.CFUNCTYPE(
    ctypes.c_int32,
    ctypes.c_int32,
    ctypes.POINTER(ctypes.c_bool),
    ctypes.POINTER(ctypes.c_uint64),
    ctypes.c_void_p,
    ctypes.c_int64,
)
"""C type of a `Watch` in `engine/binding/batch.h`."""
BEFORE_STEP, AFTER_STEP, BEGIN, FAULT = range(4)


def watch_of(simulation: Simulation, record: Path | str, frames: int) -> "Watch":
    """Records the worlds of a simulation. Raises the same errors as `Records`."""
    return Watch(Records(simulation, record, frames), len(simulation.worlds))


class Watch:
    """Writes records when the engine reports that something is about to happen or has happened.

    Args:
        records: Records of all worlds of the simulation.
        worlds: Number of worlds.
    """

    def __init__(self, records: Records, worlds: int) -> None:
        self._records, self._worlds, self._begun = records, worlds, 0.0
        self._callback = CALLBACK(self._called)  # keeps it alive: the engine has only its address

    @property
    def address(self) -> int:
        """Address of the function that the engine calls, valid while this object exists."""
        return ctypes.cast(self._callback, ctypes.c_void_p).value or 0

    def close(self) -> None:
        """Finishes the records."""
        self._records.close()

    def _called(self, watched: int, restarting: Any, seeds: Any, complaint: int, room: int) -> int:
        """Writes what is due at one moment. Returns 0, or 1 with a message, as no exception may reach the engine."""
        try:
            self._write(watched, restarting, seeds)
        except (HedonError, OSError) as error:
            text = str(error).encode()[: room - 1] + b"\0"
            ctypes.memmove(complaint, text, len(text))
            return 1
        return 0

    def _write(self, watched: int, restarting: Any, seeds: Any) -> None:
        if watched == BEFORE_STEP:
            self._records.require_open()
            self._records.begin()
            self._begun = time.perf_counter()
        elif watched == AFTER_STEP:
            self._records.note(time.perf_counter() - self._begun)
        elif watched == BEGIN:
            mask = np.array(restarting[: self._worlds], np.bool_)
            self._records.end(mask, np.array(seeds[: self._worlds], np.uint64)[mask].tolist())
            self._records.begin_again(mask)
        else:
            self._records.fail("a world has stopped at a fault")
