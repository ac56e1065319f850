"""Files of networks for agents that never learn.

For each species, a file contains the networks of agents that have learned elsewhere, and the names of their inputs. It
is stored in the run's folder as `networks.npz`, and its digest in the config, so that a run can be repeated and
checked.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.layout import observation_columns
from hedon.error import HedonError
from hedon.record.array_file import read_arrays
from hedon.text import brief

NETWORKS = "networks.npz"
_INPUTS = ".inputs"  # suffix of the array with the names of a species' inputs, as JSON


class NetworkError(HedonError):
    """A file of networks cannot be used."""


@dataclass(frozen=True, eq=False)
class Networks:
    """Networks for founders, by species; a world with only one species calls it `agent`.

    Attributes:
        params: Parameters of the networks of each species in the engine's order, shape (networks, parameters), float32.
        inputs: Inputs of the networks of each species, in order; see `hedon.config.layout.observation_columns`.
    """

    params: Mapping[str, NDArray[np.float32]]
    inputs: Mapping[str, tuple[str, ...]]

    @cached_property
    def content(self) -> bytes:
        """The content of the file."""
        arrays: dict[str, NDArray[Any]] = {}
        for name, params in self.params.items():
            arrays[name] = params
            arrays[name + _INPUTS] = np.frombuffer(json.dumps(self.inputs[name]).encode(), np.uint8)
        file = io.BytesIO()
        with zipfile.ZipFile(file, "w") as archive:  # not `numpy.savez`, which reserves some names for arguments
            for name, array in arrays.items():
                with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
                    np.lib.format.write_array(member, array, allow_pickle=False)
        return file.getvalue()

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the file, 64 hexadecimal digits."""
        return hashlib.sha256(self.content).hexdigest()

    def draw(self, name: str, seed: int, count: int) -> NDArray[np.float32]:
        """The network of each founder of a species in a world, shape (count, parameters).

        The networks are taken in an order that depends on the seed; if there are fewer networks than founders, they are
        repeated.

        Args:
            name: Name of the species.
            seed: Seed of the world.
            count: Number of founders.
        """
        params = self.params[name]
        order = sorted(range(len(params)), key=lambda i: hashlib.sha256(f"network {name} {seed} {i}".encode()).digest())
        return params[np.resize(order, count)]

    def require(self, config: Config, origin: str = "networks") -> None:
        """Checks that each species that acts with fixed networks has networks whose inputs match its observations.

        Args:
            config: Config of the worlds that the networks are for.
            origin: Name of the networks in error messages.

        Raises:
            NetworkError: A species has no networks, or their inputs do not match.
        """
        species_names = fixed_species(config)
        if not species_names:
            raise NetworkError(f'{brief(origin)}: no species has learning.policy = "fixed", so none would use them')
        for name in species_names:
            if name not in self.params:
                available = ", ".join(self.params)
                raise NetworkError(
                    f"{brief(origin)}: has no networks of the species {brief(name)}, only of: {available}"
                )
            read, expected = self.inputs[name], observation_columns(config, name)
            if read != expected:
                index = next(
                    (i for i, pair in enumerate(zip(read, expected, strict=False)) if pair[0] != pair[1]), None
                )
                mismatch = (
                    f"they read {len(read)} inputs, and it has {len(expected)}"
                    if index is None
                    else f"their input {index + 1} is {brief(read[index])}, and its is {brief(expected[index])}"
                )
                raise NetworkError(
                    f"{brief(origin)}: networks of {brief(name)} do not fit what it observes: {mismatch}"
                )


def fixed_species(config: Config) -> list[str]:
    """The species whose networks never learn."""
    return [name for name, species in config.species.items() if species.learning.policy == "fixed"]


def load_networks(folder: Path, config: Config) -> Networks | None:
    """Reads the networks with which a run started; None if it started with new ones.

    Args:
        folder: Folder of the run.
        config: Config of the run, with the digest of the networks.

    Raises:
        NetworkError: They are missing or damaged, or differ from the digest in the config.
    """
    if not config.world.networks:
        return None
    path = folder / NETWORKS
    networks = read_networks(path)
    if networks.digest != config.world.networks:
        raise NetworkError(f"{brief(str(path))}: is not the file that the config names: its digest differs")
    networks.require(config, str(path))
    return networks


def read_networks(path: Path) -> Networks:
    """Reads a file of networks, which may be from an untrusted source.

    Raises:
        NetworkError: The file cannot be read, or is not a file of networks.
    """
    try:
        arrays = read_arrays(path)
        inputs = {
            name.removesuffix(_INPUTS): tuple(map(str, json.loads(array.tobytes())))
            for name, array in arrays.items()
            if name.endswith(_INPUTS)
        }
        params = {name: arrays[name] for name in inputs}
        for name, rows in params.items():
            if rows.dtype != np.float32 or rows.ndim != 2 or not rows.size or not np.isfinite(rows).all():
                raise ValueError(f"{name} is not a table of finite numbers")
        if not params or len(arrays) != 2 * len(params):
            raise ValueError("it has other arrays than networks and their inputs")
    except OSError as error:
        raise NetworkError(f"{brief(str(path))}: cannot be read: {error.strerror or error}") from None
    except Exception as error:  # a file that is not from hedon can raise any exception
        raise NetworkError(f"{brief(str(path))}: is not a file of networks: {error}") from None
    return Networks(params, inputs)
