"""The machine: its description, and the best rates that it reaches."""

import platform
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measure import seconds_of
from benchmarks.plan import Plan
from hedon import _engine
from hedon.record.provenance import collect_provenance

MULTIPLY_ADD_ROUNDS = 4_000_000
"""About 5 ms with AVX-512."""
READ_BYTES = 4 << 20
"""Larger than the caches of one core, smaller than the last-level cache."""
READ_ROUNDS = 40
COPY_BYTES = 1 << 28
REPEATS = 7
DRIFT = 0.2
"""Relative change of a rate between beginning and end that gives a warning."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """Rates of the machine, each the best of several measurements.

    Attributes:
        multiply_add_gflops: Float32 multiply-adds in registers [1e9 operations/s], all threads together, by
            instruction set and number of threads.
        cache_read_gbytes_per_s: An array of 4 MiB per thread read again and again, all threads together, by number of
            threads.
        copy_gbytes_per_s: 256 MiB copied in memory on one thread; each byte counts once.
    """

    multiply_add_gflops: dict[str, dict[int, float]]
    cache_read_gbytes_per_s: dict[int, float]
    copy_gbytes_per_s: float

    def named(self) -> dict[str, float]:
        """All rates, each with a name."""
        rates = {
            f"multiply-add, {kernel}, {threads} threads": rate
            for kernel, by_threads in self.multiply_add_gflops.items()
            for threads, rate in by_threads.items()
        }
        rates |= {f"cache read, {n} threads": rate for n, rate in self.cache_read_gbytes_per_s.items()}
        return {**rates, "copy": self.copy_gbytes_per_s}


def describe() -> dict[str, Any]:
    """Processor, instruction sets, cores, memory, software and date of this process."""
    provenance = collect_provenance()
    return {
        "processor": _processor(),
        "instruction_sets": _engine.kernel.kernel_names(),
        "cores": provenance["cpu_count"],
        "memory_bytes": memory_bytes("MemTotal"),
        "date": provenance["started"],
        **{name: provenance[name] for name in ("platform", "python", "hedon_version", "git_revision", "git_modified")},
    }


def calibrate(plan: Plan) -> Calibration:
    """Measures the rates of the plan's instruction sets and numbers of threads; takes a second or two."""
    shrink = 20 if plan.quick else 1
    add_rounds, read_rounds = MULTIPLY_ADD_ROUNDS // shrink, READ_ROUNDS // shrink
    counts = sorted({1, *plan.threads})
    add = {kernel: dict.fromkeys(counts, 0.0) for kernel in plan.kernels}
    read, copy = dict.fromkeys(counts, 0.0), 0.0
    for _ in range(2 if plan.quick else REPEATS):  # in turn, so that a busy moment of the machine affects all of them
        for n in counts:
            for kernel, best in add.items():
                rate = _together(n, lambda k=kernel: _engine.kernel.calibrate(k, add_rounds))
                best[n] = max(best[n], rate)
            read[n] = max(read[n], _together(n, lambda: _engine.kernel.read_rate(plan.kernel, READ_BYTES, read_rounds)))
        copy = max(copy, _copy_rate(COPY_BYTES // shrink))
    return Calibration(add, read, copy)


def drifts(before: Calibration, after: Calibration) -> list[str]:
    """One line for each rate that changed by more than a fifth during the measurements."""
    ends = after.named()
    return [
        f"{name} went from {rate:.0f} to {ends[name]:.0f}"
        for name, rate in before.named().items()
        if abs(ends[name] - rate) > DRIFT * rate
    ]


def memory_bytes(field: str) -> int:
    """A line of Linux's /proc/meminfo [byte]: MemTotal, or MemAvailable for memory that is still available."""
    lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(f"{field}:")) * 1024


def _together(threads: int, rate: Callable[[], float]) -> float:
    """The sum of a rate over threads that measure it at the same time."""
    start = threading.Barrier(threads)

    def measure(_: int) -> float:
        start.wait()
        return rate()

    with ThreadPoolExecutor(threads) as pool:
        return sum(pool.map(measure, range(threads)))


def _copy_rate(size: int) -> float:
    source, target = np.ones(size, np.uint8), np.empty(size, np.uint8)
    return size / min(seconds_of(lambda: np.copyto(target, source)) for _ in range(2)) * 1e-9


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
