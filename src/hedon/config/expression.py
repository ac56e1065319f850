"""Genes that set numbers of a species, such as ray length: which numbers genes can set, and how."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from hedon.config.field import Setting, engine_sections, engine_settings, settings, value_at
from hedon.config.problem import SMALLEST, single
from hedon.config.schema.evolution import MAX_EXPONENT
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import ENERGY

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

CONVERTED = ("motor.force_scale", "birth.distance_sd")
"""Numbers that genes may set although the engine holds them only in its own units."""
NO_GENE = {
    "initial": "founders have it before they have genes",
    "population": "founders have it before they have genes",
    "reward": "genome.family has genes of the threshold of a reward, and its weights are genes",
    "learning": "genome.learning has genes of learning",
}
"""Settings and sections that genes cannot set, with the reason."""
DRIVE = ("reward.drive_exponent", "reward.drive_root")
"""The numbers of a reward that genes can set all the same."""


@cache
def settable() -> Mapping[str, Setting]:
    """Numbers of a species that genes can set, by path; numbers of stores under `store.<kind>`."""
    numbers: dict[str, Setting] = {}
    for section, inner in engine_sections(SpeciesConfig).items():
        if section == ENERGY:  # it is one of the stores
            continue
        place = f"{section}.<kind>" if inner.repeated else section
        for name, setting in settings(inner.type).items():
            reaches_engine = name in engine_settings(inner.type) or f"{section}.{name}" in CONVERTED
            is_free = f"{place}.{name}" in DRIVE or not {section, name} & NO_GENE.keys()
            if setting.type is float and is_free and reaches_engine:
                numbers[f"{place}.{name}"] = setting
    return numbers


def kind_of(path: str) -> str:
    """Path of a number in `settable`: `store.<kind>.decay` for `energy.decay` and `store.water.decay`."""
    section, *names = path.split(".")
    return f"store.<kind>.{'.'.join(names[-1:])}" if section in (ENERGY, "store") else path


def gene_column(path: str) -> str:
    """Column of the gene that sets a number: `g_sensor_ray_length` for `sensor.ray_length`."""
    return "g_" + path.replace(".", "_")


def engine_name(path: str) -> str:
    """The engine's name of a number in `settable`, such as `store_decay`."""
    return path.replace(".<kind>", "").replace(".", "_")


def limits_of(path: str) -> tuple[float, float]:
    """Smallest and largest value that a gene can give a number."""
    allowed = settable()[path].doc.range
    return (SMALLEST if allowed.ge is None else allowed.ge), (math.inf if allowed.le is None else allowed.le)


def of_mean_founders(species: SpeciesConfig) -> SpeciesConfig:
    """The species with gene-set numbers as in a founder with mean genes."""
    for path, law in species.genome.set.items():
        species = _put(species, path.split("."), expressed(species, path, law.initial_mean))
    return species


def _put(section: Any, names: list[str], value: float) -> Any:
    if not names:
        return value
    child = section[names[0]] if isinstance(section, dict) else getattr(section, names[0])
    changes = {names[0]: _put(child, names[1:], value)}
    return section | changes if isinstance(section, dict) else replace(section, **changes)


def expressed(species: SpeciesConfig, path: str, gene: "float | NDArray[np.float32]") -> Any:
    """Computes the number that a gene gives an agent.

    Args:
        species: The agents' species.
        path: Path, within the species, of a number that a gene sets.
        gene: Value of the gene, or an array of values of any shape.

    Returns:
        A number, or an array of the shape of `gene`, in the setting's unit.
    """
    import numpy as np

    factor = 10.0 ** np.clip(np.asarray(gene, np.float64), -MAX_EXPONENT, MAX_EXPONENT)
    value = np.clip(single(value_at(species, path)) * factor, *limits_of(kind_of(path)))
    return float(value) if value.ndim == 0 else value.astype(np.float32)
