"""All kernel variants (`engine/cuda/variant.h`) on one device: `python3 tests/device.py --variants`.

It compares the bits of each variant with the processor's, then measures times. The most informative timing comes first,
so that a run that ends early has it for all variants.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from device_trial import FEW, FULL, SMALL, WINDOW, Trial, failures, presets, world


@dataclass(frozen=True, slots=True)
class Timing:
    """One measurement of a variant.

    Attributes:
        worlds: Number of worlds.
        windows: Windows per call; the host waits after each call. Groups of worlds overlap within a call.
    """

    worlds: int
    windows: int

    @property
    def name(self) -> str:
        return f"{self.worlds} worlds, {self.windows} per call"


TIMINGS = (Timing(256, 1), Timing(256, 3), Timing(64, 1))
EMULATED_TIMINGS = (Timing(1, 1), Timing(5, 2))
MANY = 150
"""More worlds than a device has multiprocessors, so that variants that group worlds have several groups."""
MANY_EMULATED = 9


def same_bits(trial: Trial, program: str, folder: Path) -> dict[str, Any]:
    """Compares presets after a window and the start of the next, and many small worlds over several windows."""
    changes = FEW if trial.emulated else {}
    steps = str(SMALL["world.rollout_steps"] + 2 if trial.emulated else WINDOW + 76)
    found = {
        preset: trial.call(program, "same", steps, "2", world(preset, folder, changes), most=60.0)
        for preset in presets()
    }
    many = str(MANY_EMULATED if trial.emulated else MANY)
    found["many_worlds"] = trial.call(program, "same", "56", many, world("baseline", folder, FEW), most=60.0)
    return found


def take_time(trial: Trial, program: str, folder: Path, timing: Timing) -> dict[str, Any]:
    """World-steps per second of full worlds, all of them learning."""
    text = world("baseline", folder, {**FULL, **(FEW if trial.emulated else {})})
    return trial.call(program, "time", "0.1", str(timing.worlds), text, str(timing.windows), most=90.0)


def compare_variants(trial: Trial, folder: Path, programs: Mapping[str, Path]) -> None:
    """Adds to the trial's results: each variant's description, whether its bits are right, its times, the ranking.

    A variant whose bits differ from the processor's is not timed.
    """
    paths = {name: str(path) for name, path in programs.items()}
    trial.part("device", lambda: {name: trial.call(path, "describe") for name, path in paths.items()})
    sound = []
    for name, path in paths.items():
        found = trial.part(f"same_{name}", lambda path=path: same_bits(trial, path, folder))
        if not failures(name, found):
            sound.append(name)
    times: dict[str, dict[str, Any]] = {}
    for timing in EMULATED_TIMINGS if trial.emulated else TIMINGS:
        times[timing.name] = trial.part(
            f"time, {timing.name}",
            lambda timing=timing: {name: take_time(trial, paths[name], folder, timing) for name in sound},
        )
    trial.part("fastest", lambda: fastest(times))


def fastest(times: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """World-steps per second of the timed variants, fastest first, by timing."""
    speeds = {
        timing: {name: found["world_steps_per_second"] for name, found in by_variant.items() if "seconds" in found}
        for timing, by_variant in times.items()
    }
    return {
        timing: dict(sorted(by_variant.items(), key=lambda item: -item[1])) for timing, by_variant in speeds.items()
    }
