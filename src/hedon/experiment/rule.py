"""Rules in Python at native speed: functions from a file, compiled by Numba and called by the engine once per step.

A config names a rule as FILE.py:NAME. A run pins it as FILE.py:NAME@DIGEST, so that its config and checkpoints identify
the text. The run's manifest keeps the text, and continuations read it there, even if the file is gone.
"""

import hashlib
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
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

from hedon.config.config import Config
from hedon.config.layout import EXTRA, layouts, rule_columns
from hedon.config.problem import did_you_mean
from hedon.config.rule_path import RULE_PATTERN
from hedon.config.schema.species import RULE_USES
from hedon.error import ArgumentError, HedonError
from hedon.experiment.rule_text import cause, failure, refusal, unpinned
from hedon.record.folder import CONFIG, MANIFEST
from hedon.record.manifest import RuleSource, load_manifest
from hedon.text import brief

MAX_BYTES = 1_000_000
"""Maximum size of a rule's file [byte], since the manifest of a run keeps the whole text."""


class RuleError(HedonError):
    """A rule is missing, is not the one that a run started with, or cannot be used."""


@dataclass(frozen=True)
class Rule:
    """A rule that gives agents of a species their reward, or their probability of death or of a child.

    Attributes:
        species: Name of the species.
        use: "reward", "hazard" or "birth".
        source: Origin and text of the rule.
        columns: Fields of the record that the engine fills for each agent.
        genes: Fields that are genes which the rule may read.
        neutral: Fields that are neutral genes, which the rule may not read, as they would no longer be neutral.
    """

    species: str
    use: str
    source: RuleSource
    columns: tuple[str, ...]
    genes: tuple[str, ...]
    neutral: tuple[str, ...]

    @cached_property
    def function(self) -> Callable[[Any], float]:
        """The function in plain Python.

        Raises:
            RuleError: The file fails, has no such function, or the function takes more than an agent.
        """
        namespace: dict[str, Any] = {"__name__": "hedon_rule", "__file__": self.source.file}
        self._refuse_unpinned()
        try:
            exec(compile(self.source.text, self.source.file, "exec"), namespace)
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # a file may raise anything, not only an Exception
            raise self._error(failure(error, self.source.file)) from error
        definition = namespace.get(self.source.name)
        function = getattr(definition, "py_func", definition)  # unwraps a function that Numba has already compiled
        if definition is not None and not isinstance(function, FunctionType):
            raise self._error(
                f"{self.source.name} is {brief(repr(definition), 40)}: a rule is a function, written with def"
            )
        if not isinstance(function, FunctionType):
            function_names = [name for name, value in namespace.items() if callable(value) and not name.startswith("_")]
            hint = did_you_mean(self.source.name, function_names)
            raise self._error(f"the file has no function {self.source.name}{hint}")
        if iscoroutinefunction(function):
            raise self._error(f"{self.source.name} must be a plain function, without async")
        try:
            signature(function).bind(None)
        except TypeError as error:
            raise self._error(f"a rule takes one agent, but this is {self.source.name}{signature(function)}") from error
        if reason := refusal(self.source.text, self.source.name, self.columns):
            raise self._error(reason)
        return function

    def _refuse_unpinned(self) -> None:
        """Raises RuleError, before running the file, if it uses something from elsewhere that no run keeps."""
        with suppress(SyntaxError, ValueError):  # reported when the file is run
            if problem := unpinned(self.source.text):
                raise self._error(problem)

    def answers(self, records: NDArray[Any]) -> NDArray[np.float64]:
        """Results of the rule, computed in plain Python.

        Args:
            records: (agents, columns) float64; memory that the rule writes is changed in place.

        Returns:
            (agents,) rewards or probabilities.
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
            agents, results = numba.carray(records, count), numba.carray(answers, count)
            for i in range(count):
                results[i] = function(agents[i])

        record = numba.from_dtype(self._dtype)
        types = numba.types.void(
            numba.types.int64, numba.types.CPointer(record), numba.types.CPointer(numba.types.float64)
        )
        try:
            with _bounds_checked(numba.core.config):
                return numba.cfunc(types)(answer)
        except KeyError as error:  # a field that the record does not have
            name = str(error.args[0])
            self._refuse_neutral(f"'{name}'", error)
            hint = did_you_mean(name, self._seen)
            if name.startswith("memory_"):
                hint = f": set reward.memory to {name.removeprefix('memory_')} or more"
            raise self._error(f"an agent has no {name}{hint}; it has {', '.join(self._seen)}") from error
        except KeyboardInterrupt:
            raise
        except BaseException as error:  # Numba raises errors of its dependencies too
            self._refuse_neutral(" ".join(str(error).split()), error)
            raise self._error(cause(error, self.source.file)) from error

    def _refuse_neutral(self, message: str, error: BaseException) -> None:
        """Raises RuleError if a field reported as missing is a neutral gene."""
        for name in self.neutral:
            if f"'{name}'" in message:
                raise self._error(
                    f"it reads {name}, a neutral gene: that shows drift because nothing reads it, so no rule may; "
                    f"genes that it may read are {', '.join(self.genes) or 'none'}, and what genome.extra adds: "
                    f"genome.extra.NAME gives the species a gene {EXTRA}NAME"
                ) from error

    def _error(self, problem: str) -> RuleError:
        return RuleError(f"rule {self.source.path or self.source.file}:{self.source.name}: {problem}")

    @property
    def _seen(self) -> tuple[str, ...]:
        return tuple(name for name in self.columns if name not in self.neutral)

    @property
    def _dtype(self) -> np.dtype[Any]:
        """Data type of a record as the engine fills it; the rule sees only a part."""
        number = np.dtype(np.float64)
        return np.dtype(
            {
                "names": self._seen,
                "formats": [number] * len(self._seen),
                "offsets": [number.itemsize * self.columns.index(name) for name in self._seen],
                "itemsize": number.itemsize * len(self.columns),
            }
        )


def rules(config: Config, kept: Sequence[RuleSource] = ()) -> tuple[Rule, ...]:
    """The rules of a config.

    Args:
        config: The config.
        kept: Texts of the rules that it is pinned to, such as a manifest's; all others are read from their files.

    Raises:
        RuleError: A file is missing or cannot be read, or is not the one that the config was pinned to.
    """
    return tuple(
        _rule(config, name, use, _source(getattr(species, use).rule, kept))
        for name, species in config.species.items()
        for use in RULE_USES
        if getattr(species, use).rule
    )


def _rule(config: Config, name: str, use: str, source: RuleSource) -> Rule:
    neutral = tuple(gene.name for gene in layouts(config)[name].genes if gene.role == "neutral")
    genes = tuple(gene.name for gene in layouts(config)[name].genes if gene.role != "neutral")
    return Rule(name, use, source, rule_columns(config, name, use), genes, neutral)


def pinned(config: Config, found: Sequence[Rule]) -> Config:
    """The config with the names and digests of its rules' files, without their folders."""
    agents = dict(config.species)
    for rule in found:
        species = agents[rule.species]
        section = replace(getattr(species, rule.use), rule=rule.source.place)
        agents[rule.species] = replace(species, **{rule.use: section})
    return replace(config, species=agents)


def rules_beside(source: str | Path) -> tuple[RuleSource, ...]:
    """Texts of the rules kept by a run, from the path of its config; empty if no run has this file."""
    manifest = Path(source).parent / MANIFEST
    return load_manifest(manifest.parent).rules if Path(source).name == CONFIG and manifest.is_file() else ()


def changed_files(kept: Sequence[RuleSource]) -> tuple[str, ...]:
    """Files of rules whose text has changed since. Unreadable files are omitted."""

    def is_changed(source: RuleSource) -> bool:
        try:
            return bool(source.path) and _digest(_text(Path(source.path))) != source.digest
        except (OSError, ValueError):
            return False

    return tuple(dict.fromkeys(source.path for source in kept if is_changed(source)))


@contextmanager
def _bounds_checked(settings: Any) -> Iterator[None]:
    """Makes Numba compile functions with checks of their indices, including functions that a rule calls."""
    previous, settings.BOUNDSCHECK = settings.BOUNDSCHECK, 1
    try:
        yield
    finally:
        settings.BOUNDSCHECK = previous


def _source(place: str, kept: Sequence[RuleSource]) -> RuleSource:
    match = re.fullmatch(RULE_PATTERN, place)
    if match is None:
        raise ArgumentError(f"rule {brief(place)!r}: must be FILE.py:NAME")
    file, name, expected_digest = match.groups()
    for source in kept:
        if (source.name, source.digest) != (name, expected_digest):
            continue
        if _digest(source.text) != expected_digest:
            raise RuleError(f"rule {place}: the text that the manifest keeps is another one: its digest does not agree")
        return replace(source, file=file)
    return _read(place, file, name, expected_digest)


def _read(place: str, file: str, name: str, expected_digest: str | None) -> RuleSource:
    try:
        text = _text(Path(file))
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or brief(str(error))
        location = "" if Path(file).is_absolute() else f" in {Path.cwd()}"
        hint = "; the manifest of a run that has it keeps its text: give its rules" if expected_digest else ""
        raise RuleError(f"rule {place}: cannot read {file}{location}: {reason}{hint}") from error
    digest = _digest(text)
    if expected_digest not in (None, digest):
        raise RuleError(
            f"rule {place}: {file} has changed since, its digest is now {digest}: give the text that the run's "
            "manifest keeps (rules), or name the new rule as FILE.py:NAME in a new run or a branch"
        )
    return RuleSource(Path(file).name, name, digest, text, str(Path(file).absolute()))


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _text(path: Path) -> str:
    status = path.stat()
    if not S_ISREG(status.st_mode):
        raise ValueError("it is no plain file")
    if status.st_size > MAX_BYTES:
        raise ValueError(f"it is too large for a rule (at most {MAX_BYTES:,} bytes)")
    return path.read_text(encoding="utf-8")
