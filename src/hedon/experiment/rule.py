"""Rules in Python at native speed: a function of a file, compiled by Numba, that the engine calls once per step.

A config names a rule as FILE.py:NAME. A run pins it, FILE.py:NAME@DIGEST, so that its config, its checkpoints and its
manifest say which text it was; a rule whose file is gone or has changed since is refused.
"""

import hashlib
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from hedon.config.check_species import RULE_PATTERN
from hedon.config.config import Config
from hedon.config.layout import rule_columns
from hedon.config.problem import nearest
from hedon.config.species import PER_SPECIES, SpeciesConfig
from hedon.error import ArgumentError, HedonError
from hedon.record.manifest import RuleSource
from hedon.text import brief


class RuleError(HedonError):
    """A rule that is not there, is not the one that a run began with, or cannot be used."""


@dataclass(frozen=True)
class Rule:
    """A rule that pays the agents of a species.

    Attributes:
        species: Name of the species.
        source: Where it comes from, and its text.
        columns: Fields of the record that it gets of each agent.
    """

    species: str
    source: RuleSource
    columns: tuple[str, ...]

    @cached_property
    def function(self) -> Callable[[Any], float]:
        """The function itself, in plain Python.

        Raises:
            RuleError: The file fails, or has no such function.
        """
        scope: dict[str, Any] = {"__name__": "hedon_rule", "__file__": self.source.file}
        try:
            exec(compile(self.source.text, self.source.file, "exec"), scope)
        except Exception as error:
            raise RuleError(f"rule {self.source.place}: its file fails: {brief(repr(error))}") from error
        function = scope.get(self.source.name)
        if not callable(function):
            known = [name for name, value in scope.items() if callable(value) and not name.startswith("_")]
            near = nearest(self.source.name, known)
            hint = f"; did you mean {near}?" if near else ""
            raise RuleError(f"rule {self.source.place}: the file has no function {self.source.name}{hint}")
        return cast(Callable[[Any], float], function)

    def pay(self, records: NDArray[Any]) -> NDArray[np.float64]:
        """What the rule pays, computed in plain Python.

        Args:
            records: (agents, columns) float64; what the rule keeps in its memory is changed in place.

        Returns:
            (agents,) rewards.
        """
        rows = records.view(self._dtype).view(np.recarray)[:, 0]
        return np.array([float(self.function(row)) for row in rows])

    @cached_property
    def compiled(self) -> Any:
        """The compiled rule: `address` is a function void(int64 count, double *records, double *paid).

        Raises:
            RuleError: Numba is not installed, or cannot compile the rule.
        """
        try:
            numba: Any = import_module("numba")
        except ModuleNotFoundError as error:
            raise RuleError(f'rule {self.source.place}: needs {error.name}: pip install "hedon[rules]"') from error
        function = numba.njit(error_model="numpy")(self.function)

        def pay(count: Any, records: Any, paid: Any) -> None:
            agents, out = numba.carray(records, count), numba.carray(paid, count)
            for i in range(count):
                out[i] = function(agents[i])

        record = numba.from_dtype(self._dtype)
        signature = numba.types.void(
            numba.types.int64, numba.types.CPointer(record), numba.types.CPointer(numba.types.float64)
        )
        try:
            return numba.cfunc(signature)(pay)
        except KeyError as error:  # a field of the record that is not there
            name = str(error.args[0])
            near = nearest(name, self.columns)
            hint = f"; did you mean {near}?" if near else ""
            columns = ", ".join(self.columns)
            raise RuleError(f"rule {self.source.place}: an agent has no {name}{hint}; it has {columns}") from error
        except numba.core.errors.NumbaError as error:
            said = " ".join(str(error).split())
            raise RuleError(f"rule {self.source.place}: Numba cannot compile it: {brief(said)}") from error

    @property
    def _dtype(self) -> np.dtype[Any]:
        return np.dtype([(name, np.float64) for name in self.columns])


def rules(config: Config) -> tuple[Rule, ...]:
    """The rules of a config, with their texts as they are now.

    Raises:
        RuleError: A file is not there or cannot be read, or is not the one that the config was pinned to.
    """
    return tuple(
        Rule(name, _read(species.reward.rule), rule_columns(config, name))
        for name, species in config.agents.items()
        if species.reward.rule
    )


def pinned(config: Config) -> Config:
    """The config with the digests of its rules in their names."""
    places = {rule.species: rule.source.place for rule in rules(config)}
    if not places:
        return config

    def pin(species: SpeciesConfig, place: str) -> SpeciesConfig:
        return replace(species, reward=replace(species.reward, rule=place))

    if config.species:
        return replace(
            config,
            species={name: pin(each, places.get(name, "")) for name, each in config.species.items()},
        )
    (place,) = places.values()
    own = pin(next(iter(config.agents.values())), place)
    return replace(config, **{section: getattr(own, section) for section in PER_SPECIES})


def _read(place: str) -> RuleSource:
    match = re.fullmatch(RULE_PATTERN, place)
    if match is None:
        raise ArgumentError(f"rule {brief(place)!r}: must be FILE.py:NAME")
    file, name, wanted = match.groups()
    try:
        text = Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8"
        kept = "; the manifest of a run that has it keeps its text (rules)" if wanted else ""
        raise RuleError(f"rule {place}: cannot read {file}: {reason}{kept}") from error
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    if wanted not in (None, digest):
        raise RuleError(
            f"rule {place}: {file} has changed since, its digest is now {digest}: put back the text that the run's "
            "manifest keeps (rules), or name the new rule as FILE.py:NAME in a new run or a branch"
        )
    return RuleSource(file, name, digest, text)
