"""The agents of one driven species as arrays, with what happens to them in a call of `VectorEnv.step`."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from hedon.config.schema.body import MotorConfig
from hedon.error import ArgumentError
from hedon.text import brief

ACTIONS = ("left", "right")
"""The two motors, in the order of the columns of `actions`."""
NOBODY = -1
"""In arrays of ids, marks a slot without a living agent."""
NEWBORN = np.dtype([("world", "i4"), ("slot", "i4"), ("agent_id", "i4"), ("reward", "f4"), ("alive", "?")])
"""Row of `Group.newborns`."""
Form = Literal["unit", "force", "logit"]
"""Meaning of the numbers in an action; see `hedon.make`."""
FORMS: tuple[Form, ...] = ("unit", "force", "logit")


class Held:
    """An array that a group allocates once: callers can write into it but not replace it."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, group: Any, owner: type | None = None) -> Any:
        return self if group is None else group.__dict__[self._name]

    def __set__(self, group: Any, value: Any) -> None:
        array = group.__dict__.setdefault(self._name, value)
        if value is not array:  # `group.actions += 1` assigns the same array
            raise ArgumentError(
                f"{self._name}: must be the array of {array.shape} {array.dtype} that was there: write into it, "
                f"{self._name}[...] = …"
            )


class Group:
    """The agents of one species in all worlds, with a row for each slot, in which agents live one after another.

    Each array is allocated once. It always holds the current state, or what happened in the one or `repeat` steps of
    the last call of `VectorEnv.step`. `observations.reshape(-1, entries)` gives all agents as one table, without a
    copy.

    Args:
        index: Index of the species in the config.
        columns: Names of the entries of an observation.
        meal_names: Names of what can be eaten.
        motor: Settings of the motors.
        form: Meaning of the numbers in an action.
        worlds: Number of worlds.
        slots: Number of slots of the species in each world.

    Attributes:
        columns: Names of the entries of an observation.
        meal_names: Names of what can be eaten: the kinds of food and, if agents eat agents, the species.
        low: Lower bound of an action.
        high: Upper bound of an action.
        open: Whether any number is a valid action.
        actions: (worlds, slots, 2) float32: left and right motor. A newborn's action is the middle of the motors' range
            until it is set; rows without an agent are not read.
        observations: (worlds, slots, entries) float32, as the engine's networks read them; zeros in empty slots.
        rewards: (worlds, slots) float32, rewards in the steps, up to its death, of the agent that was in the slot
            before them, by its own genome; 0 if there was none. Rewards of agents born in the slot during the steps are
            in `newborns`.
        terminated: (worlds, slots) bool, whether the agent that was there before the steps died in them.
        truncated: (worlds, slots) bool, whether the agent that lives there now has reached `max_steps`.
        ids: (worlds, slots) int32, id of the agent in each slot; -1 in empty slots. A world never reuses an id.
        ids_before: (worlds, slots) int32, the same before the steps.
        alive: (worlds, slots) bool, whether an agent lives there now.
        born: (worlds, slots) bool, whether the agent that lives there now was born in the steps.
        births: (worlds,) int64, number of births in the steps.
        deaths: (worlds,) int64, number of deaths in the steps, including agents born in them.
        meals: (worlds, meals) int64, what the species' agents ate in the steps, in the order of `meal_names`.
    """

    def __repr__(self) -> str:
        worlds, slots = self.ids.shape
        return f"<Group of {int(self.alive.sum()):,} agents in {worlds:,} worlds of {slots:,} slots>"

    actions: Any = Held()
    observations: Any = Held()
    rewards: Any = Held()
    terminated: Any = Held()
    truncated: Any = Held()
    ids: Any = Held()
    ids_before: Any = Held()
    alive: Any = Held()
    born: Any = Held()
    births: Any = Held()
    deaths: Any = Held()
    meals: Any = Held()

    def __init__(
        self,
        index: int,
        columns: tuple[str, ...],
        meal_names: tuple[str, ...],
        motor: MotorConfig,
        form: Form,
        worlds: int,
        slots: int,
    ) -> None:
        self.columns = columns
        self.meal_names = meal_names
        self.low, self.high = _bounds(motor, form)
        self.open = form == "logit"
        self._middle = (self.low + self.high) / 2
        self.actions = np.full((worlds, slots, len(ACTIONS)), self._middle, np.float32)
        self.observations = np.zeros((worlds, slots, len(columns)), np.float32)
        self.rewards = np.zeros((worlds, slots), np.float32)
        for name in ("terminated", "truncated", "alive", "born"):
            setattr(self, name, np.zeros((worlds, slots), np.bool_))
        self.ids = np.full((worlds, slots), NOBODY, np.int32)
        self.ids_before = self.ids.copy()
        self.births, self.deaths = np.zeros(worlds, np.int64), np.zeros(worlds, np.int64)
        self.meals = np.zeros((worlds, len(meal_names)), np.int64)
        self._index, self._form = index, form
        # These are never replaced, so look them up once: steps of few agents are short.
        arrays = [
            (name, getattr(self, name)) for name, descriptor in vars(Group).items() if isinstance(descriptor, Held)
        ]
        self._shared = {name: (array, array.shape, array.dtype) for name, array in arrays}
        self._derived = (self.ids, self.ids_before, self.alive, self.born, self.terminated)
        self._eaten = self.meals.copy()
        # Within a repeat: rewards of agents born in it, by slot, and rows of agents born and dead in it.
        self._late = np.zeros_like(self.rewards)
        self._gone = np.zeros(0, NEWBORN)

    @property
    def newborns(self) -> NDArray[Any]:
        """(births,) all agents born in the steps, ordered by world and id: a structured array (`NEWBORN`).

        `reward` is the newborn's reward in the steps, 0 in the step of its birth; `alive`, whether it is alive now. A
        newborn that is not alive was born and died within a repeat; no other array shows it.
        """
        indices = np.nonzero(self.born)
        rows = np.concatenate([self._gone, _rows(indices, self.ids, self._late, alive=True)])
        return rows[np.lexsort((rows["agent_id"], rows["world"]))]

    def _take(self, actions: Any) -> None:
        """Copies actions into the group's array, unless they are that array."""
        if actions is self.actions:
            return
        array = np.asarray(actions)
        table = (self.ids.size, len(ACTIONS))
        if (
            array.dtype.kind not in "fiu"
            or array.shape not in (self.actions.shape, table)
            or np.ma.isMaskedArray(actions)
        ):
            description = f"{array.shape} {array.dtype}" if array.ndim else brief(repr(actions))
            raise ArgumentError(f"actions: must be numbers of shape {self.actions.shape} or {table}, not {description}")
        with np.errstate(over="ignore"):
            self.actions[...] = array.reshape(self.actions.shape)

    def _check(self) -> None:
        """Raises ArgumentError if an array is not as it was allocated."""
        for name, (array, shape, kind) in self._shared.items():
            flags = array.flags
            if not (flags.c_contiguous and flags.writeable and array.shape == shape and array.dtype is kind):
                raise ArgumentError(f"{name}: must be as it was made, writeable, contiguous, {kind} of shape {shape}")

    def _tell(self, method: Any) -> None:
        """Passes the actions to a method of the engine. Raises ArgumentError if it refuses one."""
        index = method(self._index, self.actions, self._form)
        if index >= 0:
            world, slot, motor = (int(i) for i in np.unravel_index(index, self.actions.shape))
            place = f"actions[{world}, {slot}, {motor}] ({ACTIONS[motor]}) = {self.actions[world, slot, motor]}"
            rule = "a finite number" if self._form == "logit" else f"from {self.low:g} to {self.high:g}"
            raise ArgumentError(f"{place}: must be {rule}")

    def _begin(self) -> None:
        """Starts a new count of births, deaths and rewards."""
        np.copyto(self.ids_before, self.ids)
        self._late.fill(0)
        self._gone = self._gone[:0]

    def _look(self, engine: Any) -> None:
        """Reads the state after the only step since `_begin`."""
        changed = engine.read_observations(self._index, self.observations, self.rewards, self.ids)
        self._finish(engine, changed=changed > 0)

    def _count(self, engine: Any, *, first: bool, last: bool) -> None:
        """Reads the state after one of several steps since `_begin`."""
        if first:
            self.rewards.fill(0)
        acting, rewards = self.ids.copy(), np.zeros_like(self.rewards)
        if last:
            engine.read_observations(self._index, self.observations, rewards, self.ids)
        else:
            engine.read_rewards(self._index, rewards, self.ids)
        is_original = acting == self.ids_before
        self.rewards[is_original] += rewards[is_original]
        self._late[~is_original] += rewards[~is_original]
        ended = ~is_original & (acting != NOBODY) & (acting != self.ids)
        if ended.any():
            self._gone = np.concatenate([self._gone, _rows(np.nonzero(ended), acting, self._late, alive=False)])
            self._late[ended] = 0
        if last:
            self._finish(engine, changed=True)
            self.observations[self.terminated & ~self.alive] = 0

    def _finish(self, engine: Any, *, changed: bool) -> None:
        """Derives arrays from the ids now and before the steps; some of them differ if `changed`."""
        ids, ids_before, alive, born, terminated = self._derived
        np.not_equal(ids, NOBODY, out=alive)
        if changed:
            np.not_equal(ids, ids_before, out=born)
            np.logical_and(born, ids_before != NOBODY, out=terminated)
            born &= alive
            born.sum(axis=1, out=self.births)
            terminated.sum(axis=1, out=self.deaths)
            self.actions[born] = self._middle
        else:  # no births or deaths, as in most steps of few worlds
            born.fill(False)
            terminated.fill(False)
            self.births.fill(0)
            self.deaths.fill(0)
        if len(self._gone):
            short_lived = np.bincount(self._gone["world"], minlength=len(ids))
            self.births += short_lived
            self.deaths += short_lived
        eaten = engine.meals(self._index)
        np.subtract(eaten, self._eaten, out=self.meals)
        self._eaten[...] = eaten

    def _forget(self, worlds: NDArray[np.bool_]) -> None:
        """Clears the arrays in some worlds, (worlds,)."""
        self.actions[worlds] = self._middle
        for array in (self.observations, self.rewards, self._late, self.births, self.deaths, self.meals):
            array[worlds] = 0
        for array in (self.terminated, self.truncated, self.born):
            array[worlds] = False
        self._gone = self._gone[~worlds[self._gone["world"]]]
        self.ids[worlds] = NOBODY

    def _open(self, engine: Any, worlds: NDArray[np.bool_]) -> None:
        """Reads worlds, (worlds,), that have just started; the others stay unchanged."""
        self._check()
        self._forget(worlds)
        engine.read_observations(self._index, self.observations, np.empty_like(self.rewards), self.ids)
        np.not_equal(self.ids, NOBODY, out=self.alive)
        self.ids_before[worlds] = self.ids[worlds]
        self._eaten[worlds] = engine.meals(self._index)[worlds]

    def _arrays(self) -> dict[str, NDArray[Any]]:
        """All arrays by name, as stored by `VectorEnv.save`."""
        return {name: array for name, array in vars(self).items() if isinstance(array, np.ndarray)}

    def _set(self, arrays: dict[str, NDArray[Any]]) -> None:
        """Copies arrays from `VectorEnv.restore`; their shapes fit."""
        for name, array in arrays.items():
            if name == "_gone":
                self._gone = array
            else:
                vars(self)[name][...] = array


def act(engine: Any, groups: Mapping[str, Group], actions: Any) -> None:
    """Sets the actions of all species; if one is refused, arrays and worlds are as before.

    Raises:
        ArgumentError: An action is invalid.
    """
    action_arrays = _by_species(groups, actions)
    for group in groups.values():
        group._check()
    backups = [(group, group.actions.copy()) for group, array in action_arrays if array is not group.actions]
    try:
        for group, array in action_arrays:
            group._take(array)
        if len(groups) > 1:  # set nothing before the actions of all species are valid
            for group in groups.values():
                group._tell(engine.wrong_action)
        for group in groups.values():
            group._tell(engine.set_actions)
    except ArgumentError:
        for group, backup in backups:
            group.actions[...] = backup
        raise


def _by_species(groups: Mapping[str, Group], actions: Any) -> list[tuple[Group, Any]]:
    if len(groups) == 1:
        return [(next(iter(groups.values())), actions)]
    listing = ", ".join(groups)
    if not isinstance(actions, Mapping):
        raise ArgumentError(f"actions: must be a dict of arrays by species ({listing}), not {type(actions).__name__}")
    if unknown := [name for name in actions if name not in groups]:
        raise ArgumentError(f"actions[{brief(repr(unknown[0]))}]: no such species is driven (there are {listing})")
    return [(groups[name], array) for name, array in actions.items()]


def _bounds(motor: MotorConfig, form: Form) -> tuple[float, float]:
    """Lower and upper bound of an action."""
    if form == "unit":
        return -1.0, 1.0
    largest = float(np.finfo(np.float32).max)
    return (motor.min_force, motor.max_force) if form == "force" else (-largest, largest)


def _rows(indices: tuple[NDArray[Any], ...], ids: NDArray[Any], rewards: NDArray[Any], *, alive: bool) -> NDArray[Any]:
    """Rows of `Group.newborns` for these worlds and slots."""
    rows = np.zeros(len(indices[0]), NEWBORN)
    rows["world"], rows["slot"] = indices
    rows["agent_id"] = ids[indices]
    rows["reward"] = rewards[indices]
    rows["alive"] = alive
    return rows
