"""The short lives whose digests are recorded: each preset, each mechanism, and some combinations."""

import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
from mechanism import FOLDER, NAMES, Mixture, Part, alone, flat, mechanisms
from mechanism_data import begin
from named import Quantities, quantities

from hedon.config.load import FIDELITIES, PRESETS, load_config
from hedon.config.problem import format_value
from hedon.config.schema.species import ONLY
from hedon.experiment.simulation import Simulation

STEPS = 100
"""Three windows of 32 steps with learning, and the start of the next."""
SEED = 9

Case = Callable[[Path, str], Simulation]
"""Creates the simulation of a case, given a folder for its config and the name of a kernel."""


def cases() -> dict[str, Case]:
    """Every case, by name."""
    found: dict[str, Case] = {}
    for preset in PRESETS:
        for fidelity in FIDELITIES:
            found[f"preset.{preset}.{fidelity}"] = partial(_preset, preset, fidelity)
    for fidelity in ("corrected", "released"):
        found[f"whole.baseline.{fidelity}"] = partial(_whole, fidelity)
    for count in range(3):
        found[f"plain.{count}"] = partial(_combined, Mixture(NAMES[:count], ()))
    for name, mechanism in mechanisms().items():
        found[f"mechanism.{name}"] = partial(_combined, alone(mechanism))
    for name, world in combinations().items():
        found[f"combination.{name}"] = partial(_combined, world)
    return found


def combinations() -> dict[str, Mixture]:
    """Worlds with several mechanisms, by name."""
    tables = tomllib.loads((FOLDER / "combination.toml").read_text())
    return {
        name: Mixture(
            NAMES[: table["species"]],
            tuple(Part(mechanisms()[each], None if species < 0 else species) for each, species in table["parts"]),
        )
        for name, table in tables.items()
    }


def live(case: Case, folder: Path, kernel: str) -> tuple[str, Quantities]:
    """Runs a short life; returns digests of its state and of its named quantities."""
    simulation = case(folder, kernel)
    for i, species in enumerate(simulation.config.species.values()):
        if species.learning.policy == "external":
            slots = species.population.capacity
            simulation.engine.set_actions(i, np.tile(np.array([0.8, -0.3], np.float32), (1, slots, 1)))
    simulation.run(STEPS)
    world = simulation.worlds[0]
    return world.digest(), quantities(world)


def _preset(preset: str, fidelity: str, folder: Path, kernel: str) -> Simulation:
    laid = tomllib.loads((FOLDER / "preset.toml").read_text())
    settings = flat(laid["every"]) | flat(laid["one" if list(load_config(preset).species) == [ONLY] else "several"])
    lines = [f"{'.'.join(path)} = {format_value(value)}" for path, value in settings.items()]
    file = folder / "preset.toml"
    file.write_text("\n".join([f'preset = "{preset}"', f'fidelity = "{fidelity}"', *lines]) + "\n")
    return Simulation(load_config(file), [SEED], 1, kernel)


def _whole(fidelity: str, folder: Path, kernel: str) -> Simulation:
    """A full-size world shortly before the end of its first window, on two threads."""
    simulation = Simulation(load_config("baseline", fidelity), [SEED], 2, kernel)
    simulation.run(1000)
    return simulation


def _combined(world: Mixture, folder: Path, kernel: str) -> Simulation:
    return begin(world, world.config(folder), [SEED], 1, kernel)
