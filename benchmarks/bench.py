"""Measures the chosen parts, between two calibrations."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmarks import crowd, device, discs, growth, network, physics, rays, records, rule, startup, value, world
from benchmarks.machine import Calibration, calibrate, describe
from benchmarks.measure import Row, Table
from benchmarks.plan import Plan, PlanError
from hedon.config.problem import nearest

FORMAT_VERSION = 1
"""Version of the JSON files; increased when a reader of old files would misread new ones."""


@dataclass(frozen=True, slots=True)
class Part:
    """A part of the benchmark that can be measured separately.

    Attributes:
        about: What it measures, in a few words.
        measure: Returns its rows of raw numbers, after it has checked them.
        table: Makes a table of them.
    """

    about: str
    measure: Callable[[Plan, Calibration], list[Row]]
    table: Callable[[list[Row], Calibration], Table]


PARTS = {
    "rays": Part("one agent's rays", rays.measure, rays.table),
    "forward": Part("one agent's network, acting", network.measure_forward, network.table_forward),
    "update": Part("PPO of one learner, on one thread", network.measure_update, network.table_update),
    "physics": Part("the rigid bodies of a populated world", physics.measure, physics.table),
    "discs": Part("a crowd of driven discs, 150 to 20,000", discs.measure, discs.table),
    "world": Part("whole worlds with learning, by threads, worlds and instruction sets", world.measure, world.table),
    "records": Part("writing a run's tables", records.measure, records.table),
    "startup": Part("from the start of a process to its first step", startup.measure, startup.table),
    "value": Part("one world as bytes, and back", value.measure, value.table),
    "rule": Part("rules in Python, beside the formulas of a config", rule.measure, rule.table),
    "device": Part("whole worlds on a device, by numbers of worlds; needs --device", device.measure, device.table),
    "growth": Part("one world without learning, up to 500 times as large", growth.measure, growth.table),
    "crowd": Part("one world full of learning founders, up to 500 times as large", crowd.measure, crowd.table),
}
DEFAULT_PARTS = tuple(name for name in PARTS if name not in ("device", "growth", "crowd", "rule"))
"""Growth and a crowd take minutes and gigabytes, a rule needs an optional package, and a device is not everywhere: they
run only if asked for."""


def choose(names: Sequence[str], device: str = "") -> tuple[str, ...]:
    """The parts with these names; without names, the part of the device if one is named, or the default parts.

    Raises:
        PlanError: There is no such part, or it needs a device.
    """
    for name in names:
        if name not in PARTS:
            near = nearest(name, PARTS)
            hint = f"; did you mean {near}?" if near else ""
            raise PlanError(f"{name!r} is not a part (there are {', '.join(PARTS)}){hint}")
    if "device" in names and not device:
        raise PlanError("the part device needs a device: --device cuda")
    return tuple(dict.fromkeys(names)) or (("device",) if device else DEFAULT_PARTS)


def need_writable(path: Path) -> None:
    """Checks that a file can be written, before a measurement of minutes; does not change its content.

    Raises:
        PlanError: It cannot.
    """
    try:
        path.open("a").close()
    except OSError as error:
        raise PlanError(f"--json: cannot write {path}: {error.strerror}") from error


class Bench:
    """One run of the benchmarks.

    Attributes:
        machine: What it runs on.
        before: Rates of the machine at the beginning.
        after: The same at the end; until then, those at the beginning.
        rows: Raw numbers of each part that has been measured.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.machine = describe()
        self.before = self.after = calibrate(plan)
        self.rows: dict[str, list[Row]] = {}

    def run(self, parts: Sequence[str]) -> Iterator[Table]:
        """Measures one part after another and yields the table of each as soon as it is ready.

        Raises:
            CheckError: A measured part gave a wrong result.
            PlanError: The preset does not fit a part.
        """
        for name in parts:
            self.rows[name] = PARTS[name].measure(self.plan, self.before)
            yield PARTS[name].table(self.rows[name], self.before)
        self.after = calibrate(self.plan)

    def document(self) -> dict[str, Any]:
        """Everything that was measured, for a JSON file."""
        return {
            "format_version": FORMAT_VERSION,
            "machine": self.machine,
            "plan": asdict(self.plan),
            "calibration_before": asdict(self.before),
            "calibration_after": asdict(self.after),
            "parts": self.rows,
        }

    def save(self, path: Path) -> None:
        """Writes the document."""
        path.write_text(json.dumps(self.document(), indent=1) + "\n", encoding="utf-8")
