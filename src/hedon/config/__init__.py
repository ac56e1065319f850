"""The settings of a run, each with meaning, unit, range and source; read from presets, files and overrides."""

from hedon.config.config import Config
from hedon.config.dump import diff, digest, dump_toml
from hedon.config.load import FIDELITIES, PRESETS, load_config
from hedon.config.native import engine_config
from hedon.config.problem import ConfigError, Problem
from hedon.config.validate import validated

__all__ = [
    "FIDELITIES",
    "PRESETS",
    "Config",
    "ConfigError",
    "Problem",
    "diff",
    "digest",
    "dump_toml",
    "engine_config",
    "load_config",
    "validated",
]
