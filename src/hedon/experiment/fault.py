"""Repeats the last steps before a run's fault."""

from dataclasses import dataclass
from pathlib import Path

from hedon.config.load import load_config
from hedon.error import EngineError
from hedon.experiment.checkpoint import check_head, require_undriven, restore, same_backend
from hedon.experiment.simulation import Simulation
from hedon.record.error import RecordError
from hedon.record.folder import CONFIG
from hedon.record.reader import open_run
from hedon.record.rollback import find_checkpoint

PIECE = 64
"""Steps per piece: few enough that the engine can store their deaths until they are read [step]."""


@dataclass(frozen=True, slots=True)
class FaultReplay:
    """A recorded fault, and the result of repeating the same steps.

    Attributes:
        recorded: The engine's original error.
        recurred: The engine's error in the repetition; None if there is none.
        start: Step of the checkpoint from which the replay started [step].
    """

    recorded: str
    recurred: str | None
    start: int


def replay_fault(folder: Path | str, threads: int = 0) -> FaultReplay:
    """Repeats the steps from the newest checkpoint of a run up to the fault that stopped it. Changes nothing.

    Raises:
        RecordError: The run recorded no fault, or its checkpoint does not fit.
        ConfigError: Its config cannot be read.
    """
    folder = Path(folder)
    manifest = open_run(folder).manifest
    if manifest.fault is None:
        raise RecordError(f"{folder} recorded no fault: its status is {manifest.status}")
    config = load_config(folder / CONFIG)
    require_undriven(folder, config)
    checkpoint, _ = find_checkpoint(folder)
    simulation = Simulation(config, manifest.seeds, threads, same_backend(manifest.backend), manifest.rules)
    step = start = 0
    if checkpoint is not None:
        name = f"the checkpoint of {folder}"
        check_head(checkpoint.head, config, manifest.seeds, name)
        step = start = restore(simulation, checkpoint, name).step
    end = max(manifest.steps_done) + 1  # a fault is found before its step counts as completed
    try:
        while step < end:
            simulation.run(min(PIECE, end - step))
            step += PIECE
            for world in simulation.worlds:
                world.deaths()
    except EngineError as error:
        return FaultReplay(manifest.fault, str(error), start)
    return FaultReplay(manifest.fault, None, start)
