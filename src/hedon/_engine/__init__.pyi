"""The native engine of hedon: the simulation and nothing else."""

from collections.abc import Callable, Sequence
from typing import Annotated, Any

import numpy
import numpy.typing
from numpy.typing import NDArray

from hedon._engine import (
    kernel as kernel,
    learning as learning,
    physics as physics,
    random as random
)


def read_config(config: dict[str, Any]) -> dict[str, Any]:
    """A config as the engine has read it."""

def memory_needed(config: dict[str, Any], walls: int, worlds: int, threads: int) -> dict[str, int]:
    """
    Bytes that a simulation would reserve, by purpose; 0 threads for all processors.
    """

def physical_memory() -> int:
    """Bytes of memory of this machine."""

def batch_address() -> int:
    """
    Address of a function that steps driven worlds without Python: `engine/binding/batch.h`.
    """

def open_device(file: str) -> None:
    """
    Loads the library of a device and finds the device. EngineError: why it cannot be used.
    """

class FloatMode:
    """Context manager: this thread computes with floats as the engine does."""

    def __init__(self) -> None: ...

    def __enter__(self) -> None: ...

    def __exit__(self, *error: object) -> None: ...

class Simulation:
    """
    Many worlds under one config. Views are read-only and valid until the next `run`. EngineError: it runs in another thread, or this process was forked from the one that made it.
    """

    def __init__(self, config: dict, walls: Annotated[NDArray[numpy.float32], dict(shape=(None, 4), order='C', device='cpu', writable=False)], outer_walls: int, seeds: Sequence[int], threads: int = 1, kernel: str = '', slot_order: Sequence[int] = [], flush_denormals: bool = True, device: str = '', scratch: str = '') -> None: ...

    def run(self, steps: int) -> None:
        """
        Advances every world that is not over; releases the interpreter lock. Ctrl-C raises KeyboardInterrupt.
        """

    def take_rows(self, world: int) -> dict[str, numpy.typing.NDArray[Any]]:
        """
        Columns of the agents that died since the last call, the oldest first: the newest of them, as many as `death_log` has rows. `head` says before how many older ones are lost (`death_log_lost`).
        """

    def living_rows(self, world: int) -> dict[str, numpy.typing.NDArray[Any]]:
        """Columns of the living, in the order of their ids."""

    def observations(self, world: int, species: int = 0) -> numpy.typing.NDArray[numpy.float32]:
        """Full observations of the living of a species: (living, size)."""

    def save(self, world: int) -> dict[str, numpy.typing.NDArray[Any]]:
        """Copies of everything that determines a world's future, as arrays."""

    def save_to(self, world: int, begin: Callable[[str, str, list[int]], object], piece: Callable[[bytes], object]) -> None:
        """
        The same in pieces, without memory for copies: begin(name, type, shape) for each array in turn, then piece(bytes) until all its bytes are passed.
        """

    def restore(self, world: int, arrays: dict[str, numpy.typing.NDArray[Any]]) -> None:
        """
        Replaces a world by a saved one. ValueError: what is wrong; the world is then unchanged.
        """

    def pack(self, head: bytes) -> bytes:
        """
        All worlds with their seeds, and a text of the caller's, as one byte string.
        """

    @staticmethod
    def packed_head(packed: bytes) -> bytes:
        """
        The caller's text in the result of `pack`. ValueError: it is damaged, or not a result of `pack`.
        """

    def unpack(self, packed: bytes) -> None:
        """
        Replaces all worlds, and their seeds, by the ones in the result of `pack`, in which `packed_head` has found no damage. ValueError: what is wrong; all worlds are then unchanged.
        """

    def reset(self, world: int, seed: int) -> None:
        """Begins a world again with this seed."""

    def seed(self, world: int) -> int: ...

    def set_rule(self, species: int, use: str, address: int, name: str) -> None:
        """
        Gives a species the function for its reward, hazard or birth, by its address: void(int64 count, double *records, double *answers). Messages about faults of the rule contain its name.
        """

    def wrong_action(self, species: int, actions: numpy.typing.NDArray[numpy.float32], form: str = 'logit') -> int:
        """
        The index of an invalid action of a living agent, as from `set_actions`, or -1; sets no action.
        """

    def set_actions(self, species: int, actions: numpy.typing.NDArray[numpy.float32], form: str = 'logit') -> int:
        """
        Sets the actions of the agents of an external species from now on: (worlds, slots, 2), as `unit`, `force` or `logit`. Returns -1, or the index of a living agent's action out of bounds; then no action is set.
        """

    def read_observations(self, species: int, observation: numpy.typing.NDArray[numpy.float32], reward: numpy.typing.NDArray[numpy.float32], agent_id: numpy.typing.NDArray[numpy.int32]) -> int:
        """
        Writes the observations of an external species' agents, their rewards in the last step, and their ids into arrays of (worlds, slots, …). Returns in how many slots the agent differs from `agent_id`.
        """

    def read_rewards(self, species: int, reward: numpy.typing.NDArray[numpy.float32], agent_id: numpy.typing.NDArray[numpy.int32]) -> None:
        """The same without observations."""

    def meals(self, species: int) -> numpy.typing.NDArray[numpy.int64]:
        """
        Numbers of meals of a species since the worlds began, foods by kind and then agents by species: (worlds, meals).
        """

    def set_scene(self, world: int, x: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], y: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], angle: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], energy: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], species: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)], food_x: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], food_y: Annotated[NDArray[numpy.float32], dict(shape=(None,), order='C', device='cpu', writable=False)], food_kind: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """Empties a world and puts these agents and foods into it."""

    def set_genomes(self, world: int, genomes: numpy.typing.NDArray[numpy.float32]) -> None:
        """
        Replaces the genomes of the living: (living, genes). ValueError: wrong shape, or a gene out of bounds.
        """

    def set_networks(self, world: int, species: int, networks: numpy.typing.NDArray[numpy.float32]) -> None:
        """
        Replaces the networks of the living of a species: (living, parameters). ValueError: wrong shape, or a parameter that is not finite.
        """

    def view(self, world: int, path: str) -> numpy.typing.NDArray[Any]:
        """One array of a world's state, by slot."""

    def view_names(self) -> list:
        """Paths that `view` knows."""

    def counters(self, world: int, species: int = 0) -> dict:
        """Counts and the energy ledger of one species."""

    def head(self, world: int) -> dict: ...

    def digest(self, world: int) -> int: ...

    def seconds(self, world: int) -> dict:
        """Seconds spent in each part by the world's first thread."""

    @property
    def device_seconds(self) -> dict:
        """
        Seconds that devices spent in each kernel, and copying; zeros without devices.
        """

    @property
    def id(self) -> int:
        """
        A number that no other simulation of this process has, for `step_batch`.
        """

    @property
    def turn(self) -> int:
        """The turn of the state from which `step_batch` continues."""

    @turn.setter
    def turn(self, arg: int, /) -> None: ...

    @property
    def device_count(self) -> int: ...

    @property
    def world_count(self) -> int: ...

    @property
    def threads(self) -> int: ...

    @property
    def backend(self) -> str: ...

    @property
    def bytes_per_world(self) -> int: ...
