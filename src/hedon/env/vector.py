"""Many worlds as arrays: a caller gives actions and gets observations and rewards, all in arrays that stay.

The engine reads and writes the arrays that the groups of agents hold: a step makes and copies none of them.
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
    """Worlds whose agents, all or those of some species, are driven by the caller; `hedon.make` makes them.

    What `reset` and `step` return, and what the attributes below hold, are the same arrays each time, of shape (worlds,
    slots, …): a row is a *slot*, in which agents live one after another. Copy what you keep. With several driven
    species, each of them is a dictionary of such arrays by species.

    Args:
        config: Settings of the worlds; then everything as for `hedon.make`.
        worlds: How many.
        seed: Of the first world, or of each; None for a first one drawn by chance.
        species: Whose agents the caller drives.
        actions: What their numbers are.
        repeat: Steps of the worlds in one step.
        max_steps: Steps of a world after which its agents are truncated.
        render_mode: What `render` gives.
        threads: As in `hedon.Simulation`.
        backend: As in `hedon.Simulation`.
        record: Folder for the records of the worlds.
        frames: Steps of the worlds between two frames of the records.
        world: The saved world that all begin as.

    Attributes:
        config: The config, with the policy `external` for the species that are driven.
        groups: The driven agents, by the name of their species, with more arrays: `Group`.
        simulation: The worlds themselves, to be read between steps; nothing else advances or restores them.
        repeat: Steps of the worlds in one step.
        max_steps: Steps of a world after which its agents are truncated.
        render_mode: What `render` gives.
        spaces: What observations and actions can be, for `single_observation_space` and the others.

    Raises:
        ArgumentError: An argument is not what it can be, or `frames` is given without `record`.

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
        self._made(simulation, names, form)
        self._open(np.ones(len(seeds), np.bool_))
        if record is not None:
            from hedon.env.record import Records  # loads what writes tables

            self._record = Records(simulation, record, frames)

    def _made(self, simulation: Simulation, names: Sequence[str], form: Form) -> None:
        self.simulation, self.config = simulation, simulation.config
        simulation._driven = True
        every = list(self.config.species)
        meals = (*self.config.food, *every)[: simulation.engine.meals(0).shape[1]]
        self.groups = {
            name: Group(
                every.index(name),
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
        self._seeded_by(simulation.seeds)
        self._steps = np.zeros(len(simulation.worlds), np.int64)  # of each world since it began
        self._eye: Any = None
        self._record: Any = None  # also of a copy: it has no records
        self._keep_own("_told", "spaces")

    def __repr__(self) -> str:
        return f"<VectorEnv driving {' and '.join(self.groups)} in {self.simulation!r}>"

    @property
    def observations(self) -> Any:
        """(worlds, slots, entries) float32: see `Group.observations`."""
        return self._told[0]

    @property
    def rewards(self) -> Any:
        """(worlds, slots) float32: see `Group.rewards`."""
        return self._told[1]

    @property
    def alive(self) -> Any:
        """(worlds, slots) bool, whether an agent lives there now: the mask of all other arrays."""
        return self._of("alive")

    @property
    def actions(self) -> Any:
        """(worlds, slots, 2) float32: write here and give it to `step`, and nothing is copied."""
        return self._of("actions")

    @cached_property
    def spaces(self) -> Spaces:
        """What observations and actions can be, as spaces of Gymnasium."""
        return Spaces(self.config, self.groups)

    @property
    def single_observation_space(self) -> Any:
        """The `gymnasium.spaces.Box` of the observations of one agent; by species where several are driven."""
        return self.spaces.observation

    @property
    def single_action_space(self) -> Any:
        """The same of its actions: two motors, left and right."""
        return self.spaces.action

    @property
    def observation_space(self) -> Any:
        """The same of all slots of all worlds."""
        return self.spaces.observations

    @property
    def action_space(self) -> Any:
        """The same of the actions of all slots of all worlds."""
        return self.spaces.actions

    def reset(self, seed: int | Sequence[int] | None = None, options: Any = None) -> tuple[Any, dict[str, Any]]:
        """Begins worlds again, at first with the seeds that they were made with, then with seeds drawn from these.

        Args:
            seed: Of the first world, whose followers have the next numbers; or a list with one for each world.
            options: `{"reset_mask": mask}` with mask (worlds,) bool, to begin only some worlds.

        Returns:
            The observations, and what else there is to know: as of `step`.

        Raises:
            ArgumentError: A seed or an option is wrong.
            EngineError: There is no room for the initial agents or foods of a world.
        """
        mask = reset_mask(options, len(self.simulation.worlds))
        if seed is not None:
            seeds = world_seeds(seed, len(mask))
            self._seeded_by(seeds)
        elif self._fresh and mask.all():
            seeds = self.simulation.seeds
        else:
            drawn = iter(self._draw_seeds(int(mask.sum())))
            seeds = tuple(next(drawn) if begins else 0 for begins in mask)
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
        return self._told[0], self._told[4]

    def _seeded_by(self, seeds: Sequence[int]) -> None:
        """Fixes which seeds later worlds get: those of environments with neighboring seeds have nothing in common."""
        self._next_seed = int(np.random.SeedSequence(list(map(int, seeds))).generate_state(1, np.uint64)[0])

    def _draw_seeds(self, count: int) -> list[int]:
        state, *drawn = np.random.SeedSequence(self._next_seed).generate_state(1 + count, np.uint64).tolist()
        self._next_seed = state
        return [seed % (MAX_SEED + 1) for seed in drawn]  # those that records can have

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Advances every world by `repeat` steps with these actions.

        It is the same as a call for each of these steps with the same actions: rewards and meals are sums, and all
        births and deaths are counted. Ctrl-C ends it after the current step; all arrays are then of that step.

        Args:
            actions: (worlds, slots, 2): `VectorEnv.actions`, or another array, which is copied there; also all slots as
                one table, (worlds · slots, 2). With several
                species a dictionary of them; a species that is not in it goes on as before.

        Returns:
            observations (worlds, slots, entries), rewards, terminated and truncated (worlds, slots), and a dictionary
            with the arrays `agent_id`, `alive`, `born` (worlds, slots), `births`, `deaths` (worlds,) and `meals`
            (worlds, meals): see `Group`.

        Raises:
            ArgumentError: An action of a living agent is not a number that it can be. Nothing is changed by that:
                `actions` has what it had before the call, also what was written into it and is wrong. Or the worlds
                are recorded, and their records are closed.
            EngineError: A world reports an error.
        """
        engine = self.simulation.engine
        if self._record is not None:
            self._record.require_open()
        act(engine, self.groups, actions)
        for group in self.groups.values():
            group._begin()
        self._fresh = False
        done, stopped = 0, None
        while done < self.repeat and stopped is None:
            try:
                self._record.advance() if self._record else engine.run(1)
            except KeyboardInterrupt as interrupt:  # raised by the engine when the step was done
                stopped = interrupt
            done += 1
            last = done == self.repeat or stopped is not None
            for group in self.groups.values():
                if self.repeat == 1:
                    group._look(engine)
                else:
                    group._count(engine, first=done == 1, last=last)
        self._judge(done)
        if stopped is not None:
            raise stopped
        if self.render_mode == "human":
            self.render()
        return self._told

    def render(self, world: int = 0) -> NDArray[np.uint8] | None:
        """A picture of a world as it is now: (height, width, 3); None without a `render_mode`.

        With `human` a window shows it instead, as each step and reset does with world 0, until somebody closes it.

        Raises:
            ArgumentError: There is no such world; or pygame, which shows windows, is not installed.
        """
        if self.render_mode is None:
            return None
        from hedon.env.picture import Eye  # loads matplotlib

        index = integer("world", world, 0, len(self.simulation.worlds) - 1)
        self._eye = self._eye or Eye(self.config, self.render_mode)
        return self._eye.see(self.simulation.worlds[index])

    def close(self) -> None:
        """Ends the records and closes the window, if there are some; as a context manager, it does so at its end.

        Raises:
            RecordError: They cannot be written.
        """
        for each in filter(None, (self._record, self._eye)):
            each.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        self.close()

    def save(self) -> bytes:
        """All worlds and all arrays as they are now, as `hedon.Simulation.save` has it.

        Raises:
            EngineError: A world has stopped at a fault.
        """
        return self.simulation._pack(text_of(self._about(), self._arrays()))

    def restore(self, saved: bytes) -> None:
        """Goes on from what `save` gave: as many worlds of the same config, driven in the same way.

        Raises:
            ArgumentError: It is something else, or is damaged, or the worlds are recorded. Everything then stays as it
                is.
        """
        if self._record is not None:
            raise ArgumentError("restore: worlds that are recorded only go on or begin again: make others for it")
        found = arrays_in(self.simulation._unpack(saved), self._about(), self._arrays())
        self.simulation._restore(saved)
        for name, group in self.groups.items():
            group._set({key[1]: array for key, array in found.items() if key[0] == name})
        self._steps[...] = found["", "steps"]
        (self._next_seed,), (self._fresh,) = found["", "next_seed"].tolist(), found["", "fresh"].tolist()

    def clone(self) -> Self:
        """A copy with worlds and arrays of its own, which goes on as this one does; it is not recorded."""
        made = type(self).__new__(type(self))
        made._go_on(self.simulation._fresh_one(), **self._given(), saved=self.save())
        return made

    def __getstate__(self) -> dict[str, Any]:
        return self._given() | {"saved": self.save(), "worlds": self.simulation._arguments()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        simulation = Simulation.__new__(Simulation)
        simulation.__setstate__(state.pop("worlds"))
        self._go_on(simulation, **state)

    def _given(self) -> dict[str, Any]:
        given = {name: vars(self)[name] for name in ("repeat", "max_steps", "render_mode", "_start")}
        return {**given, "about": self._about(), "added": self._added()}

    def _go_on(self, simulation: Simulation, about: Any, saved: bytes, added: dict[str, Any], **given: Any) -> None:
        """Makes a copy of what another one was."""
        vars(self).update(given)
        self._made(simulation, about["species"], about["actions"])
        self.restore(saved)
        vars(self).update(copy.deepcopy(added))

    def _about(self) -> dict[str, Any]:
        """What two environments must share to go on from one another's states."""
        return {"species": list(self.groups), "actions": self._form}

    def _arrays(self) -> dict[tuple[str, str], NDArray[Any]]:
        """Everything beside the worlds, by species and name."""
        own = {
            "steps": self._steps,
            "next_seed": np.array([self._next_seed], np.uint64),
            "fresh": np.array([self._fresh]),
        }
        return {("", name): array for name, array in own.items()} | {
            (species, name): array for species, group in self.groups.items() for name, array in group._arrays().items()
        }

    @cached_property
    def _told(self) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """What every step returns: arrays that stay."""
        info = {name: self._of(name) for name in ("alive", "born", "births", "deaths", "meals")}
        seen, paid, died, cut = map(self._of, ("observations", "rewards", "terminated", "truncated"))
        return seen, paid, died, cut, {"agent_id": self._of("ids"), **info}

    def _of(self, name: str) -> Any:
        """An array of the only driven species, or of each by its name."""
        every = {species: getattr(group, name) for species, group in self.groups.items()}
        return every if len(every) > 1 else next(iter(every.values()))

    def _judge(self, steps: int) -> None:
        """Says whose time is over."""
        self._steps += steps
        if self.max_steps:
            over = (self._steps >= self.max_steps)[:, None]
            for group in self.groups.values():
                np.logical_and(group.alive, over, out=group.truncated)

    def _open(self, worlds: NDArray[np.bool_]) -> None:
        """Reads worlds that have just begun."""
        for group in self.groups.values():
            group._open(self.simulation.engine, worlds)
        self._steps[worlds] = 0
