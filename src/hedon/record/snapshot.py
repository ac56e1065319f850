"""The state of one world at one moment, for pictures; stored in `final.npz` as plain arrays without pickle."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.expression import expressed, gene_column
from hedon.config.field import value_at
from hedon.record.atomic import write_atomically
from hedon.record.column import MOST_TURN
from hedon.record.error import RecordError
from hedon.record.folder import SNAPSHOT
from hedon.text import brief

_ARRAYS = {  # name: (type, shape with n agents, m foods, w walls, o obstacles, c corners, r rays, t types, s species)
    "agent_id": (np.int64, "n"),
    "x": (np.float32, "n"),
    "y": (np.float32, "n"),
    "angle": (np.float32, "n"),
    "energy": (np.float32, "n"),
    "rays": (np.float32, "nrt"),
    "species": (np.int32, "n"),
    "food_kind": (np.int32, "m"),
    "food_x": (np.float32, "m"),
    "food_y": (np.float32, "m"),
    "walls": (np.float32, "w4"),
    "obstacles": (np.float32, "oc2"),
    "radius": (np.float64, "s"),
    "ray_count": (np.int32, "s"),
    "ray_length": (np.float64, "s"),
    "ray_spread": (np.float64, "s"),
    "mouth_spread": (np.float64, "s"),
    "mouth_center": (np.float64, "s"),
    "own": (np.float64, "k5"),
}
OWN = {
    "radius": "body.radius",
    "ray_length": "sensor.ray_length",
    "ray_spread": "sensor.ray_spread",
    "mouth_spread": "sensor.mouth_spread",
    "mouth_center": "sensor.mouth_center",
}
"""The columns of `Snapshot.own`, each with the path of its setting in a species."""


@dataclass(frozen=True, eq=False)
class Snapshot:
    """One world at one moment.

    Attributes:
        world: its index in the run.
        seed: its seed.
        step: steps completed [step].
        agent_id: of the n living agents, shape (n,).
        x, y: their positions [u], shape (n,).
        angle: their headings [rad], 0 along +y, counter-clockwise, shape (n,).
        energy: their energies, shape (n,).
        rays: readings of their rays, shape (n, rays, types): 1 − distance / ray length for the type that is
            hit, −1 for the others; types are each species, each food kind, wall, obstacle. Without agents
            (0, rays, types). Past the last ray of a species, −1.
        species: index into `species_names`, shape (n,).
        food_kind: index into `food_kinds` of the m foods present, shape (m,).
        food_x, food_y: their positions [u], shape (m,).
        walls: segments from (ax, ay) to (bx, by) [u], shape (w, 4).
        obstacles: places of their corners [u], shape (o, c, 2).
        food_kinds: names, in the order of the config.
        food_radius: [u].
        species_names: in the order of the config.
        radius: of the bodies of each species [u], shape (s,).
        ray_count, ray_length: number and length of the rays of each species, the latter in [u], shape (s,).
        ray_spread: angle between the heading and the outermost ray on each side [degree], shape (s,).
        mouth_spread: half-width of the mouth [degree], shape (s,).
        mouth_center: direction of its middle, counter-clockwise of the heading [degree], shape (s,);
            empty for 0 of each.
        own: these five but the number of rays of each agent where genes set some of them, by `OWN`, shape (n, 5); else
            (0, 5).
    """

    world: int
    seed: int
    step: int
    agent_id: np.ndarray
    x: np.ndarray
    y: np.ndarray
    angle: np.ndarray
    energy: np.ndarray
    rays: np.ndarray
    food_kind: np.ndarray
    food_x: np.ndarray
    food_y: np.ndarray
    walls: np.ndarray
    species: np.ndarray
    radius: np.ndarray
    ray_count: np.ndarray
    ray_length: np.ndarray
    ray_spread: np.ndarray
    mouth_spread: np.ndarray
    mouth_center: np.ndarray
    food_kinds: tuple[str, ...]
    species_names: tuple[str, ...] = ("agent",)
    obstacles: np.ndarray = field(default_factory=lambda: np.zeros((0, 3, 2), np.float32))
    food_radius: float = 4.0
    own: np.ndarray = field(default_factory=lambda: np.zeros((0, len(OWN))))

    def of_agents(self, name: str) -> np.ndarray:
        """The value of a column of `OWN` for each agent, shape (n,)."""
        return self.own[:, list(OWN).index(name)] if len(self.own) else getattr(self, name)[self.species]

    def __post_init__(self) -> None:
        sizes: dict[str, int] = {"4": 4, "2": 2, "5": len(OWN)}
        for name, (dtype, letters) in _ARRAYS.items():
            array = np.asarray(getattr(self, name), dtype)
            if array.ndim != len(letters) or any(
                sizes.setdefault(a, n) != n for a, n in zip(letters, array.shape, strict=True)
            ):
                raise RecordError(f"snapshot: {name} has shape {array.shape}, which does not fit the others")
            object.__setattr__(self, name, array)
        if len(self.own) not in (0, len(self.x)):
            raise RecordError(f"snapshot: own has {len(self.own)} rows, but there are {len(self.x)} agents")


def own_bodies(
    config: Config, species: NDArray[np.int32], genes: Mapping[str, NDArray[np.float32]]
) -> NDArray[np.float64]:
    """The properties of bodies that pictures show, if genes set some of them: `Snapshot.own`, shape (n, 5) or (0, 5).

    Args:
        config: Config of the world.
        species: Index of each agent's species, shape (n,).
        genes: Genes of the agents by column, each of shape (n,).
    """
    if not any(set(OWN.values()) & each.genome.set.keys() for each in config.species.values()):
        return np.zeros((0, len(OWN)))
    properties = np.empty((len(species), len(OWN)))
    for number, species_config in enumerate(config.species.values()):
        in_species = species == number
        for i, path in enumerate(OWN.values()):
            is_genetic = path in species_config.genome.set
            properties[in_species, i] = (
                expressed(species_config, path, genes[gene_column(path)][in_species])
                if is_genetic
                else value_at(species_config, path)
            )
    return properties


def save_snapshot(folder: Path, snapshot: Snapshot) -> None:
    """Writes `final.npz` to a run's folder atomically.

    Args:
        folder: Folder of the run.
        snapshot: The state to write.

    Raises:
        RecordError: It cannot be written.
    """
    arrays: dict[str, Any] = {member.name: np.asarray(getattr(snapshot, member.name)) for member in fields(Snapshot)}
    try:
        write_atomically(folder / SNAPSHOT, lambda file: np.savez_compressed(file, **arrays))
    except OSError as error:
        raise RecordError(f"cannot write {folder / SNAPSHOT}: {error}") from error


def load_snapshot(folder: Path) -> Snapshot | None:
    """Reads `final.npz` of a run; None if there is none.

    Raises:
        RecordError: The file is damaged.
    """
    path = folder / SNAPSHOT
    if not path.exists():
        return None
    try:
        with np.load(path, allow_pickle=False) as file:
            values = {member.name: file[member.name] for member in fields(Snapshot) if member.name in file}
        scalars = {name: value.item() for name, value in values.items() if value.ndim == 0}
        names = {name: tuple(values[name].tolist()) for name in ("food_kinds", "species_names") if name in values}
        snapshot = Snapshot(**{**values, **scalars, **names})
        _require_drawable(snapshot)
    except Exception as error:  # a file that is not from hedon can raise any exception
        remedy = f"`hedon resume {folder}` writes it again, and without this file a report leaves its picture out"
        raise RecordError(f"damaged snapshot {path}: {brief(str(error))}; {remedy}") from error
    return snapshot


def _require_drawable(snapshot: Snapshot) -> None:
    """Refuses values that no world has: non-finite numbers, indices out of range, and names that are not text."""
    for name in _ARRAYS:
        if not np.isfinite(getattr(snapshot, name)).all():
            raise ValueError(f"{name} has numbers that are not finite")
    if (np.abs(snapshot.angle) > MOST_TURN).any():
        raise ValueError(f"angle has numbers beyond {MOST_TURN:g}")
    for name, names in (("species", snapshot.species_names), ("food_kind", snapshot.food_kinds)):
        index = getattr(snapshot, name)
        if not all(isinstance(text, str) for text in names) or ((index < 0) | (index >= len(names))).any():
            raise ValueError(f"{name} does not fit the names {brief(repr(names))}")
    is_invalid = (snapshot.ray_count < 0) | (snapshot.ray_count > snapshot.rays.shape[1])
    if len(snapshot.radius) != len(snapshot.species_names) or is_invalid.any():
        raise ValueError("the bodies of the species do not fit their names or rays")
    for name in ("world", "seed", "step"):
        if not isinstance(getattr(snapshot, name), int):
            raise TypeError(f"{name} is no integer")
