"""The settings of a run, each with meaning, unit, range and source; read from presets, files and overrides."""

from hedon.config.arena import walls
from hedon.config.config import PROVENANCE, Config
from hedon.config.dump import diff, digest, dump_toml, flatten
from hedon.config.field import leaves
from hedon.config.food import PlacementConfig
from hedon.config.gene import gene_of
from hedon.config.layout import hunters
from hedon.config.load import FIDELITIES, PAPER_PRESETS, PRESETS, describe_preset, load_config
from hedon.config.native import engine_config
from hedon.config.problem import ConfigError, Problem, format_value
from hedon.config.validate import validated

__all__ = [
    "FIDELITIES",
    "PAPER_PRESETS",
    "PRESETS",
    "PROVENANCE",
    "Config",
    "ConfigError",
    "PlacementConfig",
    "Problem",
    "describe_preset",
    "diff",
    "digest",
    "dump_toml",
    "engine_config",
    "flatten",
    "format_value",
    "gene_of",
    "hunters",
    "leaves",
    "load_config",
    "validated",
    "walls",
]
