"""The plan of a benchmark: made from the arguments, and used by every part."""

from dataclasses import dataclass

from hedon import _engine
from hedon.config.config import Config
from hedon.config.load import load_config
from hedon.config.problem import nearest
from hedon.error import HedonError
from hedon.record.provenance import usable_cpus

QUICK = ("world.rollout_steps=64", "learning.minibatch_size=16", "learning.update_epochs=2")
"""Very short windows, to see that every part works."""
MAX_COUNT = 1024
"""Most threads or worlds of one measurement."""
MAX_SLOTS = 100_000
"""Most slots of a world, as the config allows."""


class PlanError(HedonError):
    """An argument of the benchmarks that cannot be used."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What to measure.

    Attributes:
        preset: A preset or a config file.
        threads: Numbers of threads, ascending.
        worlds: Numbers of worlds for each number of threads; None for one world with each number of threads, and one
            world per thread with the largest.
        slots: Sizes for `discs`, `growth` and `crowd`, ascending; None for all sizes.
        kernels: Instruction sets, best first.
        windows: Timed windows of whole worlds.
        quick: Whether sizes are tiny: this shows only that the part works; the numbers have no meaning.
        device: Name of a device; empty for none.
    """

    preset: str
    threads: tuple[int, ...]
    worlds: tuple[int, ...] | None
    slots: tuple[int, ...] | None
    kernels: tuple[str, ...]
    windows: int
    quick: bool = False
    device: str = ""

    def config(self, *overrides: str) -> Config:
        """The preset with overrides `path=value`, and with short windows if the plan is quick."""
        return load_config(self.preset, overrides=(*(QUICK if self.quick else ()), *overrides))

    @property
    def repeats(self) -> int:
        """Number of timed calls of a single kernel."""
        return 2 if self.quick else 15

    @property
    def kernel(self) -> str:
        """The best instruction set."""
        return self.kernels[0]

    def cases(self) -> list[tuple[int, int]]:
        """Threads and worlds of each measurement of whole worlds."""
        if self.worlds is not None:
            return [(threads, worlds) for worlds in self.worlds for threads in self.threads]
        most = self.threads[-1]
        return [(threads, 1) for threads in self.threads] + ([(most, most)] if most > 1 else [])


def make_plan(
    preset: str = "baseline",
    *,
    threads: str = "",
    worlds: str = "",
    slots: str = "",
    kernel: str = "",
    windows: int = 8,
    quick: bool = False,
    device: str = "",
) -> Plan:
    """A plan from arguments of the command line; an empty one means the default for this machine.

    Args:
        preset: A preset or a config file.
        threads: Numbers such as "1,2"; by default 1, 2, 4 and so on to all processors.
        worlds: Numbers such as "1,4".
        slots: Sizes for `discs`, `growth` and `crowd`, such as "200,2000"; by default all.
        kernel: An instruction set; by default all that this processor has.
        windows: Timed windows.
        quick: Tiny sizes.
        device: Name of a device that can be used here.

    Raises:
        PlanError: A list is not valid, a number is out of range, or this processor lacks the instruction set.
        ConfigError: There is no such preset or file, or it is wrong.
    """
    load_config(preset)
    known = tuple(_engine.kernel.kernel_names())
    if kernel and kernel not in known:
        near = nearest(kernel, known)
        hint = f"; did you mean {near}?" if near else ""
        raise PlanError(f"--kernel: {kernel!r} is not one of {', '.join(known)}, which this processor has{hint}")
    return Plan(
        preset=preset,
        threads=_counts("--threads", threads) if threads else _doublings(usable_cpus()),
        worlds=_counts("--worlds", worlds) if worlds else None,
        slots=_counts("--slots", slots, MAX_SLOTS) if slots else None,
        kernels=(kernel,) if kernel else known,
        windows=min(windows, 2) if quick else windows,
        quick=quick,
        device=device,
    )


def _counts(option: str, text: str, most: int = MAX_COUNT) -> tuple[int, ...]:
    items = [item.strip() for item in text.split(",")]
    if not all(item.isdecimal() and 1 <= int(item) <= most for item in items):
        raise PlanError(f"{option}: {text!r} is not a list of numbers from 1 to {most:,}, such as 1,2,4")
    return tuple(sorted({int(item) for item in items}))


def _doublings(most: int) -> tuple[int, ...]:
    """1, 2, 4 and so on, and the largest."""
    return tuple(sorted({2**i for i in range(most.bit_length())} | {most}))
