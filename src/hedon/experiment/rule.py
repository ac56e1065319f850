"""Rules in Python at native speed: a function of a file, compiled by Numba, that the engine calls once per step.

A config names a rule as FILE.py:NAME. A run pins it, FILE.py:NAME@DIGEST, so that its config, its checkpoints and its
manifest say which text it was; a rule whose file is gone or has changed since is refused.
"""

import hashlib
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from inspect import iscoroutinefunction, signature
from pathlib import Path
from stat import S_ISREG
from types import FunctionType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.config.check_species import RULE_PATTERN
from hedon.config.config import Config
from hedon.config.layout import rule_columns
from hedon.config.problem import nearest
from hedon.config.species import PER_SPECIES, RULE_USES
from hedon.error import ArgumentError, HedonError
from hedon.record.manifest import RuleSource
from hedon.text import brief

MAX_BYTES = 1_000_000
"""Size of the largest file of a rule [byte]: the manifest of a run keeps the whole text."""


class RuleError(HedonError):
    """A rule that is not there, is not the one that a run began with, or cannot be used."""


@dataclass(frozen=True)
class Rule:
    """A rule that pays the agents of a species, or says how likely they die or have a child.

    Attributes:
        species: Name of the species.
        use: "reward", "hazard" or "birth".
        source: Where it comes from, and its text.
        columns: Fields of the record that it gets of each agent.
    """

    species: str
    use: str
    source: RuleSource
    columns: tuple[str, ...]

    @cached_property
    def function(self) -> Callable[[Any], float]:
        """The function itself, in plain Python.

        Raises:
            RuleError: The file fails, or has no such function, or it takes more than an agent.
        """
        scope: dict[str, Any] = {"__name__": "hedon_rule", "__file__": self.source.file}
        try:
            exec(compile(self.source.text, self.source.file, "exec"), scope)
        except (Exception, SystemExit) as error:
            raise self._error(f"its file fails: {brief(repr(error))}") from error
        found = scope.get(self.source.name)
        function = getattr(found, "py_func", found)  # of a function that Numba has compiled already
        if not isinstance(function, FunctionType):
            known = [name for name, value in scope.items() if callable(value) and not name.startswith("_")]
            near = nearest(self.source.name, known)
            hint = f"; did you mean {near}?" if near else ""
            raise self._error(f"the file has no function {self.source.name}{hint}")
        if iscoroutinefunction(function):
            raise self._error(f"{self.source.name} must be a plain function, without async")
        try:
            signature(function).bind(None)
        except TypeError as error:
            raise self._error(f"a rule takes one agent, but this is {self.source.name}{signature(function)}") from error
        return function

    def answers(self, records: NDArray[Any]) -> NDArray[np.float64]:
        """What the rule answers, computed in plain Python.

        Args:
            records: (agents, columns) float64; what the rule keeps in its memory is changed in place.

        Returns:
            (agents,) rewards or chances.
        """
        rows = records.view(self._dtype).view(np.recarray)[:, 0]
        return np.array([float(self.function(row)) for row in rows])

    @cached_property
    def compiled(self) -> Any:
        """The compiled rule: `address` is a function void(int64 count, double *records, double *answers).

        Raises:
            RuleError: Numba is not installed, or cannot compile the rule.
        """
        try:
            numba: Any = import_module("numba")
        except ModuleNotFoundError as error:
            raise self._error(f'needs {error.name}: pip install "hedon[rules]"') from error
        function = numba.njit(error_model="numpy")(self.function)

        def answer(count: Any, records: Any, answers: Any) -> None:
            agents, out = numba.carray(records, count), numba.carray(answers, count)
            for i in range(count):
                out[i] = function(agents[i])

        record = numba.from_dtype(self._dtype)
        types = numba.types.void(
            numba.types.int64, numba.types.CPointer(record), numba.types.CPointer(numba.types.float64)
        )
        try:
            with _bounds_checked(numba.core.config):
                return numba.cfunc(types)(answer)
        except KeyError as error:  # a field of the record that is not there
            name = str(error.args[0])
            near = nearest(name, self.columns)
            hint = f"; did you mean {near}?" if near else ""
            raise self._error(f"an agent has no {name}{hint}; it has {', '.join(self.columns)}") from error
        except Exception as error:  # Numba raises what its parts raise, not only its own errors
            said = " ".join(str(error).split())
            raise self._error(f"Numba cannot compile it: {brief(said)}") from error

    def _error(self, problem: str) -> RuleError:
        return RuleError(f"rule {self.source.place}: {problem}")

    @property
    def _dtype(self) -> np.dtype[Any]:
        return np.dtype([(name, np.float64) for name in self.columns])


def rules(config: Config) -> tuple[Rule, ...]:
    """The rules of a config, with their texts as they are now.

    Raises:
        RuleError: A file is not there or cannot be read, or is not the one that the config was pinned to.
    """
    return tuple(
        Rule(name, use, _read(getattr(species, use).rule), rule_columns(config, name, use))
        for name, species in config.agents.items()
        for use in RULE_USES
        if getattr(species, use).rule
    )


def pinned(config: Config) -> Config:
    """The config with the digests of its rules in their names."""
    found = rules(config)
    if not found:
        return config
    agents = dict(config.agents)
    for rule in found:
        own = agents[rule.species]
        section = replace(getattr(own, rule.use), rule=rule.source.place)
        agents[rule.species] = replace(own, **{rule.use: section})
    if config.species:
        return replace(config, species=agents)
    (own,) = agents.values()
    return replace(config, **{section: getattr(own, section) for section in PER_SPECIES})


@contextmanager
def _bounds_checked(settings: Any) -> Iterator[None]:
    """Lets Numba compile functions that check their indices, also those that a rule calls."""
    before, settings.BOUNDSCHECK = settings.BOUNDSCHECK, 1
    try:
        yield
    finally:
        settings.BOUNDSCHECK = before


def _read(place: str) -> RuleSource:
    match = re.fullmatch(RULE_PATTERN, place)
    if match is None:
        raise ArgumentError(f"rule {brief(place)!r}: must be FILE.py:NAME")
    file, name, wanted = match.groups()
    try:
        text = _text(Path(file))
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or brief(str(error))
        where = "" if Path(file).is_absolute() else f" in {Path.cwd()}"
        kept = "; the manifest of a run that has it keeps its text (rules)" if wanted else ""
        raise RuleError(f"rule {place}: cannot read {file}{where}: {reason}{kept}") from error
    digest = hashlib.sha256(text.encode()).hexdigest()[:16]
    if wanted not in (None, digest):
        raise RuleError(
            f"rule {place}: {file} has changed since, its digest is now {digest}: put back the text that the run's "
            "manifest keeps (rules), or name the new rule as FILE.py:NAME in a new run or a branch"
        )
    return RuleSource(file, name, digest, text)


def _text(path: Path) -> str:
    about = path.stat()
    if not S_ISREG(about.st_mode):
        raise ValueError("it is no plain file")
    if about.st_size > MAX_BYTES:
        raise ValueError(f"it is too large for a rule (at most {MAX_BYTES:,} bytes)")
    return path.read_text(encoding="utf-8")
