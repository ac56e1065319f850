"""Genes that set numbers of a species, such as the length of its rays: which numbers, and what a gene makes of them."""

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
"""Numbers that genes may set though the engine has them only in its own units."""
NO_GENE = {
    "initial": "founders have it before they have genes",
    "population": "founders have it before they have genes",
    "reward": "genome.family has genes of the threshold of a reward, and its weights are genes",
    "learning": "genome.learning has genes of learning",
}
"""Settings and sections that no gene sets, with the reason."""


@cache
def settable() -> Mapping[str, Setting]:
    """The numbers of a species that genes may set, by path; those of stores by `store.<kind>`."""
    found: dict[str, Setting] = {}
    for section, inner in engine_sections(SpeciesConfig).items():
        if section in NO_GENE or section == ENERGY:  # energy is a store
            continue
        place = f"{section}.<kind>" if inner.repeated else section
        for name, each in settings(inner.type).items():
            known = name in engine_settings(inner.type) or f"{section}.{name}" in CONVERTED
            if each.type is float and name not in NO_GENE and known:
                found[f"{place}.{name}"] = each
    return found


def kind_of(path: str) -> str:
    """The path of a number in `settable`: `store.<kind>.decay` for `energy.decay` and `store.water.decay`."""
    section, *names = path.split(".")
    return f"store.<kind>.{'.'.join(names[-1:])}" if section in (ENERGY, "store") else path


def gene_column(path: str) -> str:
    """The column of the gene that sets a number: `g_sensor_ray_length` for `sensor.ray_length`."""
    return "g_" + path.replace(".", "_")


def engine_name(path: str) -> str:
    """What the engine calls the number at a path of `settable`: `store_decay`."""
    return path.replace(".<kind>", "").replace(".", "_")


def limits_of(path: str) -> tuple[float, float]:
    """The least and the largest value that a gene can give a number."""
    allowed = settable()[path].doc.range
    return (SMALLEST if allowed.ge is None else allowed.ge), (math.inf if allowed.le is None else allowed.le)


def of_mean_founders(species: SpeciesConfig) -> SpeciesConfig:
    """A species with the numbers that genes set as those of a founder with mean genes."""
    for path, law in species.genome.set.items():
        species = _put(species, path.split("."), expressed(species, path, law.initial_mean))
    return species


def _put(section: Any, names: list[str], value: float) -> Any:
    if not names:
        return value
    below = section[names[0]] if isinstance(section, dict) else getattr(section, names[0])
    changed = {names[0]: _put(below, names[1:], value)}
    return section | changed if isinstance(section, dict) else replace(section, **changed)


def expressed(species: SpeciesConfig, path: str, gene: "float | NDArray[np.float32]") -> Any:
    """What agents have at a path whose genes are known.

    Args:
        species: of the agents.
        path: of a number that a gene sets, in the species.
        gene: the gene, or an array of them, any shape.

    Returns:
        A number, or an array of the shape of `gene`; in the unit of the setting.
    """
    import numpy as np

    factor = 10.0 ** np.clip(np.asarray(gene, np.float64), -MAX_EXPONENT, MAX_EXPONENT)
    value = np.clip(single(value_at(species, path)) * factor, *limits_of(kind_of(path)))
    return float(value) if value.ndim == 0 else value.astype(np.float32)
