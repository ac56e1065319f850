"""A trial of a device: the clock and the results of `tests/device.py`, and the worlds that it runs."""

import json
import os
import platform
import re
import subprocess
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

TEXTS = Path(__file__).parent / "data" / "device"
WINDOW = 1024
SMALL = {"world.rollout_steps": 16, "learning.minibatch_size": 8, "learning.update_epochs": 2}
FEW = {**SMALL, "population.capacity": 16, "population.initial_count": 10}
FULL = {"population.initial_count": 150}
"""As many agents as a baseline world has in the long run."""
RESERVE_SECONDS = 15


class Trial:
    """One run of the script: its clock, and its results, which are saved after each part."""

    def __init__(self, out: Path, seconds: float, emulated: bool) -> None:
        self.out, self.emulated = out, emulated
        self.begun, self.end = time.monotonic(), time.monotonic() + seconds
        self.found: dict[str, Any] = {"emulated": emulated, "machine": platform.platform(), "failures": []}

    def left(self, most: float = 1e9) -> float:
        """Seconds that a part may take."""
        return min(most, self.end - time.monotonic() - RESERVE_SECONDS)

    def call(self, *command: str, most: float = 120.0, environment: dict[str, str] | None = None) -> dict[str, Any]:
        """The JSON that a command prints in its last line, or what went wrong."""
        seconds = self.left(most)  # all of `most`, unless the trial ends earlier
        if seconds < 1:
            return {"skipped": "no time was left"}
        try:
            done = subprocess.run(
                command,
                capture_output=True,
                text=True,
                timeout=seconds,
                check=False,
                env=os.environ | (environment or {}),
            )
        except subprocess.TimeoutExpired:
            word = "failed" if seconds == most else "skipped"
            return {word: f"it took more than {seconds:.0f} s"}
        lines = done.stdout.strip().splitlines()
        parsed = json.loads(lines[-1]) if lines and lines[-1].startswith("{") else {}
        if done.returncode == 0:
            return parsed
        return {**parsed, "failed": f"status {done.returncode}", "said": (done.stdout + done.stderr)[-2000:]}

    def part(self, name: str, make: Callable[[], Any]) -> Any:
        """Runs a part, then saves and prints its results."""
        begun = time.monotonic()
        found = make()
        self.found[name] = found
        self.found["failures"] += failures(name, found)
        self.found["seconds"] = round(time.monotonic() - self.begun, 1)
        self.out.parent.mkdir(parents=True, exist_ok=True)
        self.out.write_text(json.dumps(self.found, indent=2) + "\n")
        print(f"device: {name}, {time.monotonic() - begun:.1f} s: {json.dumps(found)[:300]}", flush=True)
        return found


def failures(name: str, found: Any) -> list[str]:
    """The entries "failed" anywhere in the results, each with its path."""
    if not isinstance(found, dict):
        return []
    here = [f"{name}: {found['failed']}"] if "failed" in found else []
    return here + [line for key, inner in found.items() for line in failures(f"{name}.{key}", inner)]


def world(name: str, folder: Path, changes: Mapping[str, object]) -> str:
    """Writes a world's file, a text from `data/device` with settings changed in all species; returns its path."""
    lines = (TEXTS / f"{name}.txt").read_text().splitlines()
    for path, value in changes.items():
        place = re.compile(rf"(species\[\d\]\.)?{re.escape(path)}=")
        at = [i for i, line in enumerate(lines) if place.match(line)]
        if not at:
            raise KeyError(path)
        for i in at:
            lines[i] = f"{lines[i].split('=')[0]}={value}"
    file = folder / f"{name}-{abs(hash(tuple(changes.items())))}.txt"
    file.write_text("\n".join(lines) + "\n")
    return str(file)


def presets() -> list[str]:
    """Names of the worlds that are stored as texts."""
    return sorted(path.stem for path in TEXTS.glob("*.txt"))
