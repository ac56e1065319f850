"""Restores a simulation from a checkpoint: checks that it fits and that the worlds are the same as before."""

import os
from importlib.metadata import version
from pathlib import Path

from hedon import _engine
from hedon.config.config import Config
from hedon.config.dump import SCHEMA, diff
from hedon.config.load import parse_config
from hedon.config.problem import format_value
from hedon.config.toml import parse_toml
from hedon.experiment.device import EMULATED, device_problem, is_device
from hedon.experiment.recorder import Start
from hedon.experiment.sample import PopulationSampler
from hedon.experiment.simulation import BACKEND_VARIABLE, Simulation
from hedon.record.checkpoint import Checkpoint, CheckpointHead, Sampled
from hedon.record.error import RecordError
from hedon.record.folder import TABLE_FOLDERS

SAME_BITS = (frozenset({"avx2", "avx512", "neon", "cuda", EMULATED}),)
"""Sets of backends that compute the same bits, so that one can continue what another started."""
SHOWN = 5
"""Maximum number of differing settings in a message."""


def check_head(head: CheckpointHead, config: Config, seeds: tuple[int, ...], name: str) -> None:
    """Compares a checkpoint with the run that is to continue from it.

    Raises:
        RecordError: The version, a setting or the seeds differ; the message gives the difference.
    """
    current = version("hedon")
    if head.hedon_version != current:
        raise RecordError(
            f"{name} was made by hedon {head.hedon_version}, and this is {current}, which may compute different "
            f"results: install hedon {head.hedon_version} to continue"
        )
    config_name = f"config in {name}"
    if parse_toml(head.config, config_name).get("schema") != SCHEMA:
        raise RecordError(f"{name} was made by a version of hedon before 1.0, which alone can continue it")
    settings = diff(parse_config(head.config, config_name), config)
    if settings:
        lines = [f"{path} was {_text(old)}, now {_text(new)}" for path, old, new in settings]
        more = f", and {len(lines) - SHOWN} more" if len(lines) > SHOWN else ""
        raise RecordError(
            f"{name} was made with another config: {'; '.join(lines[:SHOWN])}{more}; "
            "restore config.toml, or change settings in a new folder with `hedon branch --set`"
        )
    if head.seeds != seeds:
        raise RecordError(f"{name} has seeds {_text(head.seeds)}, and the run has {_text(seeds)}")
    worlds = (len(head.sampled), len(head.digests))
    if worlds != (len(seeds) * len(config.species), len(seeds)) or sorted(head.parts) != sorted(TABLE_FOLDERS):
        raise RecordError(f"{name} is not complete: worlds or tables are missing")


def require_undriven(folder: Path, config: Config) -> None:
    """Refuses to continue worlds whose agents were driven by a program.

    Raises:
        RecordError: A program drove the worlds.
    """
    if config.driven:
        raise RecordError(
            f"{folder} has records of worlds that a program drove, and only such a program can go on with them: make "
            "new worlds with hedon.make, or keep some with VectorEnv.save"
        )


def same_backend(backend: str | None) -> str:
    """Selects a backend with the same bits as `backend`.

    HEDON_BACKEND takes precedence, then the same device if it can be used, then the best instruction set of this
    processor.

    Raises:
        RecordError: HEDON_BACKEND names one with different bits.
    """
    family = next((names for names in SAME_BITS if backend in names), frozenset({backend}))
    requested = os.environ.get(BACKEND_VARIABLE, "")
    if requested and backend is not None and requested not in family:
        raise RecordError(
            f"the run was made with the instruction set {backend}, and {BACKEND_VARIABLE} is {requested}, which "
            f"computes different results: unset {BACKEND_VARIABLE}"
        )
    if not requested and backend is not None and is_device(backend) and not device_problem(backend):
        return backend
    available = [name for name in _engine.kernel.kernel_names() if name in family]
    return requested or (available[0] if available else backend or "")


def restore(simulation: Simulation, checkpoint: Checkpoint, name: str, only: int | None = None) -> Start:
    """Loads the worlds of a checkpoint into a simulation, and checks that they are as they were saved.

    Args:
        simulation: Simulation with the seeds with which the worlds continue.
        checkpoint: Checkpoint of as many worlds.
        name: Name of the checkpoint, for errors.
        only: Index of the world that all worlds of the simulation become; None if each becomes its own.

    Returns:
        The state at which the simulation now is.

    Raises:
        RecordError: The simulation cannot use the arrays. Do not use the simulation after that.
    """
    head = checkpoint.head
    species, sampled = len(simulation.config.species), list[Sampled]()
    for world in simulation.worlds:
        index = world.index if only is None else only
        try:
            simulation.engine.restore(world.index, checkpoint.world(index))
        except ValueError as error:
            raise RecordError(f"{name} does not fit: world {index}: {error}") from None
        current = [PopulationSampler(world, i).since for i in range(species)]
        saved = head.sampled[index * species : (index + 1) * species]
        sampled += saved
        matches = [(sample.counters.keys(), len(sample.eaten)) for sample in current] == [
            (sample.counters.keys(), len(sample.eaten)) for sample in saved
        ]
        if world.digest() != head.digests[index] or not matches or not (world.extinct or world.step == head.step):
            raise RecordError(f"{name} is damaged: world {index} is not as it was saved")
    checkpoint.arrays.clear()
    return Start(head.step, head.run_seconds, tuple(sampled))


def _text(value: object) -> str:
    return "(absent)" if value is None else format_value(value)
