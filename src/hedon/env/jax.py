"""Worlds inside JAX programs: steps in `jit`, `lax.scan` and `vmap`, on the CPU, without Python between them.

The worlds themselves stay in the engine. JAX carries a handle: the world's index and its turn, which each step
increments. Steps therefore run in order, and a state that a later step has used is refused.
"""

import ctypes
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple, Self

import jax
import numpy as np
from jax import numpy as jnp

from hedon import _engine
from hedon.config.config import Config
from hedon.config.layout import observation_columns
from hedon.copied import Copied
from hedon.env.argument import chosen, driven, loaded, recordable, with_callers
from hedon.env.group import ACTIONS, FORMS, NOBODY, Form, Group
from hedon.env.space import Spaces
from hedon.error import ArgumentError, HedonError
from hedon.experiment.argument import MAX_STEPS, MAX_WORLDS, integer

TARGET = "hedon_step"
SOURCE = Path(__file__).with_name("xla.cpp")


class State(NamedTuple):
    """Handle of a world, for `JaxEnv.step`.

    Attributes:
        world: () int32, index of the world.
        turn: () uint32, number of the step that produced it; each state can be stepped from only once.
        agent_id: (slots,) int32, id of the agent in each slot; -1 in empty slots.
    """

    world: jax.Array
    turn: jax.Array
    agent_id: jax.Array


class JaxParams(NamedTuple):
    """Parameters that can differ between the worlds of a program, for `JaxEnv.reset` and `JaxEnv.step`.

    Attributes:
        max_steps: () int32, steps after which a world restarts; 0 for no limit.
    """

    max_steps: jax.Array | int


class JaxEnv(Copied):
    """Worlds that a JAX program drives, through functions of one world as in gymnax.

    To run several worlds, map the functions over all of them with `jax.vmap`: pass a key for each world, or one key for
    a population of policies, whose worlds then all start alike. A copy has its own worlds, which continue from the same
    state. A world restarts by itself, with a seed from the step's key, when no driven agent is left or at `max_steps`.

    Args:
        config: Settings of the worlds. This argument and all that follow work as in `hedon.make`.
        worlds: Number of worlds.
        species: Name of the species that the program drives; None for the only one, or the only external one.
        actions: Meaning of the numbers in an action.
        repeat: World steps per environment step.
        max_steps: Value in `default_params`: steps after which a world restarts; 0 for no limit.
        threads: Number of threads; 0 for one per 150 slots, or for all processors if the engine computes networks of
            some agents. Changes no result.
        backend: As in `hedon.Simulation`.
        record: Folder for the records, one run for worlds that start together; call `close` at the end.
        frames: World steps between two recorded frames; 0 for none.
        overrides: As for `hedon.make`.

    Attributes:
        columns: Names of the entries of an observation.
        slots: Number of slots of the species in a world: how many agents can live at once.
        default_params: Parameters of `reset` and `step` if they get no `params`.
        simulation: The underlying worlds, to be read while no program runs.

    Raises:
        ConfigError: A setting is wrong.
        ArgumentError: Another argument is wrong.
        HedonError: The first use needs a C++ compiler, and there is none.

    Example:
        >>> import jax
        >>> from hedon.env import JaxEnv
        >>> env = JaxEnv("baseline", worlds=4)
        >>> keys = jax.random.split(jax.random.key(0), 4)
        >>> observations, state = jax.jit(jax.vmap(env.reset))(keys)
    """

    def __init__(
        self,
        config: Config | str | Path,
        worlds: int = 1,
        species: str | Sequence[str] | None = None,
        actions: Form = "unit",
        repeat: int = 1,
        max_steps: int = 0,
        threads: int = 0,
        backend: str = "",
        record: Path | str | None = None,
        frames: int = 0,
        overrides: Iterable[str] = (),
    ) -> None:
        config = loaded(config, overrides)
        names = driven(config, species)
        if len(names) != 1:
            raise ArgumentError(f"species: must be one of {', '.join(names)}")
        count = integer("worlds", worlds, 1, MAX_WORLDS)
        self._form = FORMS.index(chosen("actions", actions, FORMS))
        self._repeat = integer("repeat", repeat, 1, MAX_STEPS)
        self.default_params = JaxParams(integer("max_steps", max_steps, 0, MAX_STEPS))
        self.simulation = recordable(with_callers(config, names), range(count), threads, backend, record, frames)
        self.simulation._driven = True
        self._watch: Any = None
        if record is not None:
            from hedon.env.watch import watch_of  # imported late: it loads the table writers

            self._watch = watch_of(self.simulation, record, frames)
        self._species = list(config.species).index(names[0])
        self.columns = observation_columns(config, names[0])
        self.slots = config.species[names[0]].population.capacity
        self._name = names[0]
        self._actions: Form = actions
        _register()

    def close(self) -> None:
        """Finishes the records, if there are any.

        Raises:
            RecordError: The records cannot be written.
        """
        if self._watch is not None:
            self._watch.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def __getstate__(self) -> dict[str, Any]:
        return self.__dict__ | {"turn": self.simulation.engine.turn, "_watch": None}  # a copy has no records

    def __setstate__(self, state: dict[str, Any]) -> None:
        turn = state.pop("turn")
        self.__dict__.update(state)
        self.simulation._driven = True
        self.simulation.engine.turn = turn
        _register()

    @cached_property
    def _spaces(self) -> Spaces:
        config, motor = self.simulation.config, self.simulation.config.species[self._name].motor
        group = Group(self._species, self.columns, (), motor, self._actions, 1, self.slots)
        return Spaces(config, {self._name: group})

    def observation_space(self, params: JaxParams | None = None) -> Any:
        """Space of the observations of all slots of a world: a `gymnasium.spaces.Box`, (slots, entries) float32."""
        return self._spaces.box_of(self._name, (self.slots,))

    def action_space(self, params: JaxParams | None = None) -> Any:
        """Space of the actions of all slots of a world: a `gymnasium.spaces.Box`, (slots, 2) float32."""
        return self._spaces.action_box(self._name, (self.slots,))

    def reset(self, key: jax.Array, params: JaxParams | None = None) -> tuple[jax.Array, State]:
        """Starts a world; without `jax.vmap`, all worlds start from one seed.

        Args:
            key: Key from which the seed is drawn.
            params: None for `default_params`.

        Returns:
            The observations (slots, entries) float32, zeros in empty slots, and the state.
        """
        no_ids = jnp.full((self.slots,), NOBODY, jnp.int32)
        empty_state = State(jnp.int32(0), jnp.uint32(0), no_ids)
        no_action = jnp.zeros((self.slots, len(ACTIONS)), jnp.float32)
        state, (observation, *_) = self._call(key, empty_state, no_action, params, begins=True)
        return observation, state

    def step(
        self, key: jax.Array, state: State, action: jax.Array, params: JaxParams | None = None
    ) -> tuple[jax.Array, State, jax.Array, jax.Array, dict[str, jax.Array]]:
        """Advances a world by `repeat` steps.

        Args:
            key: Key from which the seed is drawn if the world restarts.
            state: State from the last `reset` or `step`.
            action: (slots, 2) float32, left and right motor; rows without an agent are not read.
            params: None for `default_params`.

        Returns:
            The observations (slots, entries) float32; the next state; the rewards (slots,) float32 of the agents that
            were there before; whether the world was over and has restarted, () bool; and a dictionary: `terminated`
            (slots,) bool, which of these agents died, and `alive` (slots,) bool, which slots have an agent now.

            An invalid action or a stale state raises a JAX error when the program runs.
        """
        state, (observation, reward, terminated, done) = self._call(
            key, state, jnp.asarray(action, jnp.float32), params, begins=False
        )
        return observation, state, reward, done, {"terminated": terminated, "alive": state.agent_id != NOBODY}

    def _call(
        self, key: jax.Array, state: State, action: jax.Array, params: JaxParams | None, *, begins: bool
    ) -> tuple[State, Any]:
        if action.shape != (self.slots, len(ACTIONS)):
            raise ArgumentError(f"action: must be of shape {(self.slots, len(ACTIONS))}, not {action.shape}")
        slots = (self.slots,)
        for name, given, shape, kind in (
            ("world", state.world, (), jnp.int32),
            ("turn", state.turn, (), jnp.uint32),
            ("agent_id", state.agent_id, slots, jnp.int32),
        ):
            if jnp.shape(given) != shape or jnp.asarray(given).dtype != kind:
                raise ArgumentError(
                    f"state.{name}: must be {np.dtype(kind)} of shape {shape}, as reset and step return it, not "
                    f"{jnp.asarray(given).dtype} of shape {jnp.shape(given)}"
                )
        limit = jnp.asarray((params or self.default_params).max_steps)
        if limit.shape != () or not jnp.issubdtype(limit.dtype, jnp.integer):
            raise ArgumentError(f"params.max_steps: must be one whole number, not {limit.dtype} of shape {limit.shape}")
        numbers = (self.simulation.engine.id, self._species, self._form, self._repeat, int(begins))
        watch = 0 if self._watch is None else self._watch.address
        call = np.array([_engine.batch_address(), *numbers, self.slots, len(self.columns), watch], np.int64)
        shapes = [((), jnp.int32), ((), jnp.uint32), (slots, jnp.int32), ((*slots, len(self.columns)), jnp.float32)]
        shapes += [(slots, jnp.float32), (slots, jnp.bool_), ((), jnp.bool_)]
        results = [jax.ShapeDtypeStruct(shape, kind) for shape, kind in shapes]
        step = jax.ffi.ffi_call(TARGET, results, has_side_effect=True, vmap_method="broadcast_all")
        seed = jax.random.key_data(key).astype(jnp.uint32)[-2:]
        given = (state.world, state.turn, seed, state.agent_id, action, limit.astype(jnp.int32))
        world, turn, ids, *outputs = step(*given, call=call)
        return State(world, turn, ids), outputs


@cache
def _register() -> None:
    """Registers the call with JAX."""
    library = ctypes.CDLL(str(_library()))
    jax.ffi.register_ffi_target(TARGET, jax.ffi.pycapsule(library.hedon_step), platform="cpu")


def _library() -> Path:
    """Path of the compiled call, which the first use builds in the user's cache."""
    contents = f"{SOURCE.read_text()} {version('jaxlib')}"
    digest = hashlib.sha256(contents.encode()).hexdigest()[:16]
    folder = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "hedon"
    library = folder / f"xla-{digest}.so"
    if library.is_file():
        return library
    compiler = os.environ.get("CXX") or next((name for name in ("c++", "g++", "clang++") if shutil.which(name)), None)
    if compiler is None:
        raise HedonError("hedon.env.JaxEnv needs a C++ compiler on first use, and finds none: install g++, or set CXX")
    try:
        print("hedon: compiling the call of JAX, once for this jaxlib (some seconds)", file=sys.stderr)
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as place:
            built = Path(place) / library.name
            words = [*compiler.split(), "-std=c++17", "-O2", "-shared", "-fPIC", f"-I{jax.ffi.include_dir()}"]
            subprocess.run([*words, str(SOURCE), "-o", str(built)], check=True, capture_output=True, text=True)
            built.replace(library)
    except (OSError, subprocess.CalledProcessError) as error:
        lines = (getattr(error, "stderr", None) or str(error)).strip().splitlines()
        raise HedonError(f"hedon.env.JaxEnv cannot compile {SOURCE}: {lines[0] if lines else error}") from error
    return library
