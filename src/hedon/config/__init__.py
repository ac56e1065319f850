"""Settings of a run, each with its meaning, unit, range and source, loaded from presets, files and overrides."""

from hedon.config.config import Config, validated
from hedon.config.dump import diff, digest, dump_toml, file_leaves, flatten
from hedon.config.engine import engine_config
from hedon.config.gene import gene_of
from hedon.config.layout import layouts
from hedon.config.load import FIDELITIES, PAPER_PRESETS, PRESETS, describe_preset, load_config
from hedon.config.problem import ConfigError, Problem, format_value
from hedon.config.schema.arena import walls
from hedon.config.schema.food import PlacementConfig
from hedon.config.schema.species import ONLY
from hedon.config.type import hunters

__all__ = [
    "FIDELITIES",
    "ONLY",
    "PAPER_PRESETS",
    "PRESETS",
    "Config",
    "ConfigError",
    "PlacementConfig",
    "Problem",
    "describe_preset",
    "diff",
    "digest",
    "dump_toml",
    "engine_config",
    "file_leaves",
    "flatten",
    "format_value",
    "gene_of",
    "hunters",
    "layouts",
    "load_config",
    "validated",
    "walls",
]
