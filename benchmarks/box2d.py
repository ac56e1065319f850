"""Crowds of driven discs in hedon and in Box2D 3, which both start at the same places and get the same forces.

Box2D comes from the package `pyb2d3`, which includes its library for C: `box2d.c` is compiled and linked to it, so no
call from Python is timed. Two ways of stepping are measured. Box2D's own is to look for contacts once per step and to
divide only the solving of contacts into substeps. hedon looks for contacts in every substep.
"""

import importlib.util
import math
import subprocess
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.check import require
from benchmarks.discs import PIECE_STEPS, SIZES, make_scene, side_of
from benchmarks.measure import seconds_of
from benchmarks.plan import Plan
from hedon.config.schema.species import ONLY

PIECES = {150: 200, 2_000: 20, 20_000: 4}
"""Times that forces change, by number of discs."""
LIKE = 1.5
"""Factor within which the mean speed of the discs must agree, so that both programs do the same task."""

Rate = Callable[[], float]


@dataclass(frozen=True)
class Crowd:
    """Discs and the forces that drive them.

    Attributes:
        plan: Names the config.
        discs: How many.
        forces: Force in x and y and torque [mass·u/s², mass·u²/s²], shape `[pieces, 3, discs]`.
    """

    plan: Plan
    discs: int
    forces: NDArray


def crowd(plan: Plan, discs: int) -> Crowd:
    """Discs with random headings and motor forces, new in each piece."""
    species, rng = plan.config().species[ONLY], np.random.default_rng(1)
    shape = (PIECES[discs], discs)
    left, right = rng.uniform(species.motor.min_force, species.motor.max_force, (2, *shape))
    heading = rng.uniform(0, 2 * math.pi, shape)
    arm = species.body.radius * math.sin(math.radians(species.motor.angle))
    forces = [-np.sin(heading) * (left + right), np.cos(heading) * (left + right), (right - left) * arm]
    return Crowd(plan, discs, np.stack(forces, axis=1).astype(np.float32))


def hedon_rate(crowd: Crowd) -> tuple[float, float]:
    """Steps of one disc per second, and the mean speed of the discs at the end [u/s]."""
    scene = make_scene(crowd.plan, crowd.discs)
    seconds = 0.0
    for forces in crowd.forces:
        for name, values in zip(("force_x", "force_y", "force_torque"), forces, strict=True):
            scene.array(name)[:] = values
        seconds += seconds_of(lambda: scene.step(PIECE_STEPS, 1, record=False))
    speed = np.hypot(scene.array("velocity_x"), scene.array("velocity_y")).mean()
    return crowd.discs * PIECE_STEPS * len(crowd.forces) / seconds, float(speed)


def box2d_rate(crowd: Crowd, program: Path, *, each_substep: bool) -> tuple[float, float]:
    """The same in Box2D, which looks for contacts once per step or in each substep."""
    config, scene = crowd.plan.config(), make_scene(crowd.plan, crowd.discs)
    physics, body = config.physics, config.species[ONLY].body
    calls, substeps = (physics.substeps, 1) if each_substep else (1, physics.substeps)
    setup = (
        *(crowd.discs, side_of(crowd.discs, body.radius), body.radius, body.density),
        *(physics.friction, physics.restitution, physics.linear_damping, physics.angular_damping),
        *(physics.dt * substeps, substeps, calls, len(crowd.forces), PIECE_STEPS),
    )
    # hedon's force acts in the first substep, which is all of a call, or a share of it.
    parts = (setup, scene.array("x"), scene.array("y"), crowd.forces / substeps)
    given = b"".join(np.asarray(part, np.float32).tobytes() for part in parts)
    *seconds, speed = map(float, subprocess.run([program], input=given, check=True, capture_output=True).stdout.split())
    return crowd.discs * PIECE_STEPS * len(crowd.forces) / sum(seconds), speed


def rates(plan: Plan) -> dict[str, Rate]:
    """Steps of one disc per second, by program and number of discs; empty if `pyb2d3` is not installed.

    Raises:
        CheckError: The discs of the two programs do not move alike.
    """
    spec = importlib.util.find_spec("pyb2d3")
    if spec is None or spec.origin is None:
        return {}
    program = built(Path(spec.origin).parents[1])
    found: dict[str, Rate] = {}
    for discs in SIZES:
        one = crowd(plan, discs)
        ways: dict[str, Callable[[], tuple[float, float]]] = {
            "hedon": partial(hedon_rate, one),
            "Box2D": partial(box2d_rate, one, program, each_substep=False),
            "Box2D, contacts in each substep": partial(box2d_rate, one, program, each_substep=True),
        }
        expected = ways["hedon"]()[1]
        for name, way in ways.items():
            found[f"{name}: {discs:,} discs"] = partial(checked, way, expected)
    return found


def checked(way: Callable[[], tuple[float, float]], expected: float) -> float:
    """The rate, if the discs are about as fast as expected."""
    rate, speed = way()
    require(expected / LIKE < speed < expected * LIKE, f"discs move at {speed:.2f} u/s, in hedon at {expected:.2f} u/s")
    return rate


def built(site: Path) -> Path:
    """The compiled program, in a new folder."""
    program = Path(tempfile.mkdtemp()) / "box2d"
    source = Path(__file__).with_name("box2d.c")
    command = ["cc", "-O2", source, "-I", site / "include", site / "lib64" / "libbox2d.a", "-lm", "-o", program]
    subprocess.run(command, check=True)
    return program
