"""The agents of one species that a caller drives, as arrays, and what becomes of them in a call of `Batch.step`."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.error import ArgumentError

ACTIONS = ("left", "right")
"""The two motors, in the order of the columns of `actions`."""
NOBODY = -1
"""In arrays of ids, where no agent lives."""
NEWBORN = np.dtype([("world", "i4"), ("slot", "i4"), ("agent_id", "i4"), ("reward", "f4"), ("alive", "?")])
"""A row of `Group.newborns`."""


class Held:
    """An array that a group allocates once: its caller writes into it, and cannot put another in its place."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, group: Any, owner: type | None = None) -> Any:
        return self if group is None else group.__dict__[self._name]

    def __set__(self, group: Any, value: Any) -> None:
        held = group.__dict__.setdefault(self._name, value)
        if value is not held:  # `group.actions += 1` sets the same one
            raise ArgumentError(
                f"{self._name}: must be the array of {held.shape} {held.dtype} that was there: write into it, "
                f"{self._name}[...] = …"
            )


class Group:
    """The agents of one species in all worlds: a row for each slot, in which agents live one after another.

    Each array is allocated once. `observations.reshape(-1, entries)` is all agents as one table, without a copy.
    "The steps" are those of the last call of `Batch.step`, one or `repeat`.

    Args:
        index: Of the species in the config's order.
        columns: Names of the entries of an observation.
        meal_names: What can be eaten.
        worlds: How many there are.
        slots: Of the species in each world.

    Attributes:
        columns: Names of the entries of an observation.
        meal_names: What can be eaten: the kinds of food, then, where agents eat agents, the species.
        actions: (worlds, slots, 2) float32, before the sigmoid: write here. 0 is the middle of the motors' range,
            and what a newborn does until told otherwise; rows without an agent change nothing.
        observations: (worlds, slots, entries) float32, as a network of the engine reads them; zeros where nobody
            lives.
        rewards: (worlds, slots) float32, what the agent that was in the slot before the steps was paid in them, by its
            own genome, up to its death; 0 where there was none. What others earned who came into the slot after it
            is in `newborns`.
        ids: (worlds, slots) int32, the agent in each slot; -1 where nobody lives. No id is used again in a world.
        ids_before: the same before the steps.
        meals: (worlds, meals) int64, what the agents of the species ate in the steps, in the order of `meal_names`.
    """

    actions: Any = Held()
    observations: Any = Held()
    rewards: Any = Held()
    ids: Any = Held()
    ids_before: Any = Held()
    meals: Any = Held()

    def __init__(
        self, index: int, columns: tuple[str, ...], meal_names: tuple[str, ...], worlds: int, slots: int
    ) -> None:
        self.columns = columns
        self.meal_names = meal_names
        self.actions = np.zeros((worlds, slots, len(ACTIONS)), np.float32)
        self.observations = np.zeros((worlds, slots, len(columns)), np.float32)
        self.rewards = np.zeros((worlds, slots), np.float32)
        self.ids = np.full((worlds, slots), NOBODY, np.int32)
        self.ids_before = self.ids.copy()
        self.meals = np.zeros((worlds, len(meal_names)), np.int64)
        self._index = index
        self._eaten = self.meals.copy()
        self._late: Any = None  # within a repeat: rewards of who was born in it, by slot
        self._gone: list[NDArray[Any]] = []  # rows of those who were born and died in the steps

    @property
    def alive(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether an agent lives there now."""
        return self.ids != NOBODY

    @property
    def died(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether the agent that was there before the steps died in them."""
        return (self.ids_before != NOBODY) & (self.ids_before != self.ids)

    @property
    def born(self) -> NDArray[np.bool_]:
        """(worlds, slots) whether the agent that lives there now was born in the steps."""
        return (self.ids != NOBODY) & (self.ids_before != self.ids)

    @property
    def newborns(self) -> NDArray[Any]:
        """(births,) all who were born in the steps, in the order of world and id: a structured array (`NEWBORN`).

        `reward` is what it was paid in the steps, 0 in the step of its birth; `alive`, whether it lives now. Who is
        not alive has come and gone within a repeat: no other array shows it.
        """
        here = np.nonzero(self.born)
        now = _rows(here, self.ids, self._late, alive=True)
        rows = np.concatenate([*self._gone, now])
        return rows[np.lexsort((rows["agent_id"], rows["world"]))]

    @property
    def births(self) -> NDArray[np.int64]:
        """(worlds,) how many were born in the steps."""
        return np.bincount(self.newborns["world"], minlength=len(self.ids))

    @property
    def deaths(self) -> NDArray[np.int64]:
        """(worlds,) how many died in the steps, with those who were born in them."""
        newborns = self.newborns
        short = np.bincount(newborns["world"][~newborns["alive"]], minlength=len(self.ids))
        return self.died.sum(axis=1) + short

    def _tell(self, engine: Any) -> None:
        """Gives the actions to the agents."""
        for name in ("actions", "observations", "rewards", "ids"):
            array = getattr(self, name)
            if not (array.flags.c_contiguous and array.flags.writeable):
                raise ArgumentError(f"{name}: must be as it was made, writeable and contiguous")
        if not np.isfinite(self.actions).all():
            world, slot, motor = np.argwhere(~np.isfinite(self.actions))[0]
            place = f"actions[{world}, {slot}, {motor}] ({ACTIONS[motor]})"
            raise ArgumentError(f"{place} = {self.actions[world, slot, motor]}: must be a finite number")
        engine.set_actions(self._index, self.actions)

    def _begin(self) -> None:
        """What follows is counted from here."""
        np.copyto(self.ids_before, self.ids)
        self._late = None
        self._gone = []

    def _look(self, engine: Any) -> None:
        """Reads what there is after the only step since `_begin`."""
        engine.read_observations(self._index, self.observations, self.rewards, self.ids)
        self._finish(engine)

    def _count(self, engine: Any, *, last: bool) -> None:
        """Reads what there is after one of several steps since `_begin`."""
        if self._late is None:
            self.rewards.fill(0)
        late = self._late = np.zeros_like(self.rewards) if self._late is None else self._late
        acting, paid = self.ids.copy(), np.zeros_like(self.rewards)
        if last:
            engine.read_observations(self._index, self.observations, paid, self.ids)
        else:
            engine.read_rewards(self._index, paid, self.ids)
        old = acting == self.ids_before
        self.rewards[old] += paid[old]
        late[~old] += paid[~old]
        ended = ~old & (acting != NOBODY) & (acting != self.ids)
        if ended.any():
            self._gone.append(_rows(np.nonzero(ended), acting, late, alive=False))
            late[ended] = 0
        if last:
            self.observations[self.died & ~self.alive] = 0
            self._finish(engine)

    def _finish(self, engine: Any) -> None:
        if not np.array_equal(self.ids, self.ids_before):
            self.actions[self.born] = 0.0
        eaten = engine.meals(self._index)
        np.subtract(eaten, self._eaten, out=self.meals)
        self._eaten = eaten

    def _forget(self) -> None:
        """Begins anew, with new worlds."""
        for array in (self.actions, self.observations, self.rewards, self._eaten):
            array.fill(0)
        self.ids.fill(NOBODY)


def _rows(
    where: tuple[NDArray[Any], ...], ids: NDArray[Any], rewards: NDArray[Any] | None, *, alive: bool
) -> NDArray[Any]:
    """Rows of `Group.newborns` for these worlds and slots."""
    rows = np.zeros(len(where[0]), NEWBORN)
    rows["world"], rows["slot"] = where
    rows["agent_id"] = ids[where]
    rows["reward"] = 0.0 if rewards is None else rewards[where]
    rows["alive"] = alive
    return rows
