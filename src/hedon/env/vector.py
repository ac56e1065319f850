"""Many worlds as arrays: a caller sets actions and reads observations and rewards in arrays that are never replaced.

The engine reads and writes the arrays of the groups directly, so a step allocates and copies none of them.
"""

import copy
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.layout import observation_columns
from hedon.copied import Cloned
from hedon.env.argument import chosen, driven, recordable, reset_mask, with_callers, world_seeds
from hedon.env.group import FORMS, Form, Group, act
from hedon.env.keep import arrays_in, text_of
from hedon.env.space import Spaces
from hedon.error import ArgumentError
from hedon.experiment.argument import MAX_SEED, MAX_STEPS, MAX_WORLDS, integer
from hedon.experiment.simulation import Simulation

RENDER_MODES = ("rgb_array", "human")


class VectorEnv(Cloned):
    """Worlds in which the caller drives all agents or those of some species; `hedon.make` creates them.

    `reset`, `step` and the attributes below always give the same arrays, of shape (worlds, slots, …): a row is a
    *slot*, in which agents live one after another. Copy what you want to keep. If several species are driven, each
    array becomes a dictionary of arrays by species.

    Args:
        config: Settings of the worlds. The other arguments work as in `hedon.make`.
        worlds: Number of worlds.
        seed: Seed of the first world, or one seed per world; None for a random first one.
        species: Species whose agents the caller drives.
        actions: Meaning of the numbers in an action.
        repeat: World steps per environment step.
        max_steps: World steps after which agents are truncated.
        render_mode: What `render` produces.
        threads: As in `make`.
        backend: As in `hedon.Simulation`.
        record: Folder for the records of the worlds.
        frames: World steps between two recorded frames.
        world: Saved world from which all worlds start.

    Attributes:
        config: The config, with the policy `external` for the driven species.
        groups: The driven agents by name of their species, with more arrays: `Group`.
        simulation: The underlying worlds, for reading between steps; do not advance or restore them otherwise.
        repeat: World steps per environment step.
        max_steps: World steps after which agents are truncated.
        render_mode: What `render` produces.
        spaces: Spaces of observations and actions, for `single_observation_space` and the others.

    Raises:
        ArgumentError: An argument is invalid, or `frames` is given without `record`.

    Example:
        >>> import hedon
        >>> worlds = hedon.make("baseline", worlds=4, seed=1)
        >>> observations, info = worlds.reset()
        >>> worlds.actions[...] = 0.5  # or a policy of the observations
        >>> observations, rewards, terminated, truncated, info = worlds.step(worlds.actions)
    """

    metadata: Mapping[str, Any] = {"render_modes": list(RENDER_MODES), "render_fps": 30}

    def __init__(
        self,
        config: Config,
        worlds: int = 1,
        seed: int | Sequence[int] | None = None,
        species: str | Sequence[str] | None = None,
        actions: Form = "unit",
        repeat: int = 1,
        max_steps: int = 0,
        render_mode: str | None = None,
        threads: int = 0,
        backend: str = "",
        record: Path | str | None = None,
        frames: int = 0,
        world: bytes | None = None,
    ) -> None:
        names = driven(config, species)
        seeds = world_seeds(seed, integer("worlds", worlds, 1, MAX_WORLDS))
        self.repeat = integer("repeat", repeat, 1, MAX_STEPS)
        self.max_steps = integer("max_steps", max_steps, 0, MAX_STEPS)
        self.render_mode = chosen("render_mode", render_mode, RENDER_MODES, empty=True)
        form = chosen("actions", actions, FORMS)
        config = with_callers(config, names)
        simulation = recordable(config, seeds, threads, backend, record, frames)
        if world is not None and record is not None:
            raise ArgumentError("record: records begin with worlds, and these go on from a saved one: leave one out")
        self._start = None if world is None else simulation._become(world)
        self._set_up(simulation, names, form)
        self._open(np.ones(len(seeds), np.bool_))
        if record is not None:
            from hedon.env.record import Records  # imported late: it loads the table writers

            self._record = Records(simulation, record, frames)

    def _set_up(self, simulation: Simulation, names: Sequence[str], form: Form) -> None:
        self.simulation, self.config = simulation, simulation.config
        simulation._driven = True
        species_names = list(self.config.species)
        meals = (*self.config.food, *species_names)[: simulation.engine.meals(0).shape[1]]
        self.groups = {
            name: Group(
                species_names.index(name),
                observation_columns(self.config, name),
                meals,
                self.config.species[name].motor,
                form,
                len(simulation.worlds),
                self.config.species[name].population.capacity,
            )
            for name in names
        }
        self._form, self._fresh = form, True
        self._fix_later_seeds(simulation.seeds)
        self._steps = np.zeros(len(simulation.worlds), np.int64)  # of each world since its start
        self._eye: Any = None
        self._record: Any = None  # a copy has no records either
        self._keep_own("_returned", "spaces")

    def __repr__(self) -> str:
        return f"<VectorEnv driving {' and '.join(self.groups)} in {self.simulation!r}>"

    @property
    def observations(self) -> Any:
        """(worlds, slots, entries) float32: see `Group.observations`."""
        return self._returned[0]

    @property
    def rewards(self) -> Any:
        """(worlds, slots) float32: see `Group.rewards`."""
        return self._returned[1]

    @property
    def alive(self) -> Any:
        """(worlds, slots) bool, whether an agent lives there now: the mask of all other arrays."""
        return self._of("alive")

    @property
    def actions(self) -> Any:
        """(worlds, slots, 2) float32: write actions here and pass it to `step`, so that nothing is copied."""
        return self._of("actions")

    @cached_property
    def spaces(self) -> Spaces:
        """Spaces of observations and actions, for Gymnasium."""
        return Spaces(self.config, self.groups)

    @property
    def single_observation_space(self) -> Any:
        """`gymnasium.spaces.Box` of one agent's observation; a Dict by species if several are driven."""
        return self.spaces.observation

    @property
    def single_action_space(self) -> Any:
        """Space of one agent's action: two motors, left and right."""
        return self.spaces.action

    @property
    def observation_space(self) -> Any:
        """Space of the observations of all slots of all worlds."""
        return self.spaces.observations

    @property
    def action_space(self) -> Any:
        """Space of the actions of all slots of all worlds."""
        return self.spaces.actions

    def reset(self, seed: int | Sequence[int] | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        """Restarts worlds, the first time with the seeds that they were created with, then with seeds drawn from these.

        Args:
            seed: Seed of the first world, with the following numbers for the others; or a list with one seed per world.
            options: `{"reset_mask": mask}` with mask (worlds,) bool restarts only some worlds.

        Returns:
            The observations and the dictionary, as from `step`.

        Raises:
            ArgumentError: A seed or an option is wrong.
            EngineError: A world has no room for its initial agents or foods.
        """
        mask = reset_mask(options, len(self.simulation.worlds))
        if seed is not None:
            seeds = world_seeds(seed, len(mask))
            self._fix_later_seeds(seeds)
        elif self._fresh and mask.all():
            seeds = self.simulation.seeds
        else:
            new_seeds = iter(self._draw_seeds(int(mask.sum())))
            seeds = tuple(next(new_seeds) if restarts else 0 for restarts in mask)
        records = None if self._fresh and seed is None and mask.all() else self._record
        if records is not None:
            records.end(mask, [seeds[i] for i in np.flatnonzero(mask)])
        for i in np.flatnonzero(mask).tolist():
            self.simulation.engine.reset(i, seeds[i])
            if self._start is not None:
                self.simulation.engine.restore(i, self._start)
        if records is not None:
            records.begin_again(mask)
        self._open(mask)
        self._fresh = False
        if self.render_mode == "human":
            self.render()
        return self._returned[0], self._returned[4]

    def _fix_later_seeds(self, seeds: Sequence[int]) -> None:
        """Fixes the seeds of later worlds; environments with neighboring seeds have nothing in common."""
        self._next_seed = int(np.random.SeedSequence(list(map(int, seeds))).generate_state(1, np.uint64)[0])

    def _draw_seeds(self, count: int) -> list[int]:
        state, *values = np.random.SeedSequence(self._next_seed).generate_state(1 + count, np.uint64).tolist()
        self._next_seed = state
        return [seed % (MAX_SEED + 1) for seed in values]  # within the range of records

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Advances every world by `repeat` steps with these actions.

        This equals separate calls for each step with the same actions: rewards and meals are summed, and all births and
        deaths are counted. Ctrl-C stops it after the current step; all arrays then describe that step.

        Args:
            actions: (worlds, slots, 2): `VectorEnv.actions`, or another array, which is copied into it; or all slots as
                one table, (worlds · slots, 2). For several species, a dictionary of these; a species that is missing
                from it keeps its actions.

        Returns:
            observations (worlds, slots, entries), rewards, terminated and truncated (worlds, slots), and a dictionary
            with the arrays `agent_id`, `alive`, `born` (worlds, slots), `births`, `deaths` (worlds,) and `meals`
            (worlds, meals): see `Group`.

        Raises:
            ArgumentError: The action of a living agent is invalid, or the records of the worlds are closed. Nothing
                changes: `actions` is as before the call, including wrong numbers that were written into it.
            EngineError: A world reports an error.
        """
        engine = self.simulation.engine
        if self._record is not None:
            self._record.require_open()
        act(engine, self.groups, actions)
        for group in self.groups.values():
            group._begin()
        self._fresh = False
        steps_done, stopped = 0, None
        while steps_done < self.repeat and stopped is None:
            try:
                self._record.advance() if self._record else engine.run(1)
            except KeyboardInterrupt as interrupt:  # raised by the engine after the step
                stopped = interrupt
            steps_done += 1
            last = steps_done == self.repeat or stopped is not None
            for group in self.groups.values():
                if self.repeat == 1:
                    group._look(engine)
                else:
                    group._count(engine, first=steps_done == 1, last=last)
        self._mark_truncated(steps_done)
        if stopped is not None:
            raise stopped
        if self.render_mode == "human":
            self.render()
        return self._returned

    def render(self, world: int = 0) -> NDArray[np.uint8] | None:
        """Draws the current state of a world: (height, width, 3); None without a `render_mode`.

        With `human`, a window shows it instead, until it is closed; each step and reset also shows world 0 there.

        Raises:
            ArgumentError: There is no such world, or pygame, which shows windows, is not installed.
        """
        if self.render_mode is None:
            return None
        from hedon.env.picture import Eye  # imported late: it loads matplotlib

        index = integer("world", world, 0, len(self.simulation.worlds) - 1)
        self._eye = self._eye or Eye(self.config, self.render_mode)
        return self._eye.see(self.simulation.worlds[index])

    def close(self) -> None:
        """Finishes the records and closes the window, if there are any; a `with` block does so at its end.

        Raises:
            RecordError: The records cannot be written.
        """
        for resource in filter(None, (self._record, self._eye)):
            resource.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def save(self) -> bytes:
        """Saves the current state of all worlds and arrays, as `hedon.Simulation.save` does.

        Raises:
            EngineError: A world has stopped at a fault.
        """
        return self.simulation._pack(text_of(self._about(), self._arrays()))

    def restore(self, saved: bytes) -> None:
        """Continues from a state from `save`, of as many worlds with the same config, driven in the same way.

        Raises:
            ArgumentError: The state is of something else or damaged, or the worlds are recorded. Nothing changes.
        """
        if self._record is not None:
            raise ArgumentError("restore: worlds that are recorded only go on or begin again: make others for it")
        arrays = arrays_in(self.simulation._unpack(saved), self._about(), self._arrays())
        self.simulation._restore(saved)
        for name, group in self.groups.items():
            group._set({key[1]: array for key, array in arrays.items() if key[0] == name})
        self._steps[...] = arrays["", "steps"]
        (self._next_seed,), (self._fresh,) = arrays["", "next_seed"].tolist(), arrays["", "fresh"].tolist()

    def clone(self) -> Self:
        """Returns a copy with its own worlds and arrays, which continues as this one would; it is not recorded."""
        duplicate = type(self).__new__(type(self))
        duplicate._continue_from(self.simulation._fresh_one(), **self._arguments(), saved=self.save())
        return duplicate

    def __getstate__(self) -> dict[str, Any]:
        return self._arguments() | {"saved": self.save(), "worlds": self.simulation._arguments()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        simulation = Simulation.__new__(Simulation)
        simulation.__setstate__(state.pop("worlds"))
        self._continue_from(simulation, **state)

    def _arguments(self) -> dict[str, Any]:
        arguments = {name: vars(self)[name] for name in ("repeat", "max_steps", "render_mode", "_start")}
        return {**arguments, "about": self._about(), "added": self._added()}

    def _continue_from(
        self, simulation: Simulation, about: Any, saved: bytes, added: dict[str, Any], **attributes: Any
    ) -> None:
        """Sets up a copy from the state of another environment."""
        vars(self).update(attributes)
        self._set_up(simulation, about["species"], about["actions"])
        self.restore(saved)
        vars(self).update(copy.deepcopy(added))

    def _about(self) -> dict[str, Any]:
        """What two environments must share to continue from each other's states."""
        return {"species": list(self.groups), "actions": self._form}

    def _arrays(self) -> dict[tuple[str, str], NDArray[Any]]:
        """All arrays besides the worlds, by species and name."""
        world_arrays = {
            "steps": self._steps,
            "next_seed": np.array([self._next_seed], np.uint64),
            "fresh": np.array([self._fresh]),
        }
        return {("", name): array for name, array in world_arrays.items()} | {
            (species, name): array for species, group in self.groups.items() for name, array in group._arrays().items()
        }

    @cached_property
    def _returned(self) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """The arrays that every step returns; they are never replaced."""
        info = {name: self._of(name) for name in ("alive", "born", "births", "deaths", "meals")}
        observations, rewards, terminated, truncated = map(
            self._of, ("observations", "rewards", "terminated", "truncated")
        )
        return observations, rewards, terminated, truncated, {"agent_id": self._of("ids"), **info}

    def _of(self, name: str) -> Any:
        """An array of the only driven species, or a dictionary of each species' array."""
        arrays = {species: getattr(group, name) for species, group in self.groups.items()}
        return arrays if len(arrays) > 1 else next(iter(arrays.values()))

    def _mark_truncated(self, steps: int) -> None:
        """Marks the agents that have reached `max_steps`."""
        self._steps += steps
        if self.max_steps:
            reached_limit = (self._steps >= self.max_steps)[:, None]
            for group in self.groups.values():
                np.logical_and(group.alive, reached_limit, out=group.truncated)

    def _open(self, worlds: NDArray[np.bool_]) -> None:
        """Reads worlds that have just started."""
        for group in self.groups.values():
            group._open(self.simulation.engine, worlds)
        self._steps[worlds] = 0
