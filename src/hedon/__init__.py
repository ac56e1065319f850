"""Study how reward systems evolve: agents that live, learn, breed and die in a continuous world.

Example:
    >>> import hedon
    >>> config = hedon.load_config("baseline", overrides=["population.capacity=100"])
    >>> simulation = hedon.Simulation(config, seeds=[1])
    >>> simulation.run(1024)
    >>> simulation.worlds[0].alive
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hedon.config import Config, ConfigError, dump_toml, load_config
    from hedon.error import ArgumentError, EngineError, HedonError
    from hedon.experiment.branch import branch
    from hedon.experiment.memory import MemoryNeedError
    from hedon.experiment.plan import RunPlan
    from hedon.experiment.resume import resume
    from hedon.experiment.run import run
    from hedon.experiment.simulation import Simulation, World
    from hedon.record.error import RecordError
    from hedon.record.reader import Run, open_run

__version__ = version("hedon")

_HOME = {
    "Config": "hedon.config",
    "ConfigError": "hedon.config",
    "dump_toml": "hedon.config",
    "load_config": "hedon.config",
    "ArgumentError": "hedon.error",
    "EngineError": "hedon.error",
    "HedonError": "hedon.error",
    "MemoryNeedError": "hedon.experiment.memory",
    "RecordError": "hedon.record.error",
    "RunPlan": "hedon.experiment.plan",
    "branch": "hedon.experiment.branch",
    "resume": "hedon.experiment.resume",
    "run": "hedon.experiment.run",
    "Simulation": "hedon.experiment.simulation",
    "World": "hedon.experiment.simulation",
    "Run": "hedon.record.reader",
    "open_run": "hedon.record.reader",
}

__all__ = [
    "ArgumentError",
    "Config",
    "ConfigError",
    "EngineError",
    "HedonError",
    "MemoryNeedError",
    "RecordError",
    "Run",
    "RunPlan",
    "Simulation",
    "World",
    "branch",
    "dump_toml",
    "load_config",
    "open_run",
    "resume",
    "run",
]


def __getattr__(name: str) -> Any:
    # Imported on first use: `hedon --help` must not wait for the engine and the table library.
    if name not in _HOME:
        raise AttributeError(f"module 'hedon' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)
