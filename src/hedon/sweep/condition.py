"""The conditions of a sweep: each consists of a base config and the settings that it changes.

A base is loaded like any config. If factors only replace values of settings, a condition is derived from its base with
the same checks, which takes a tenth of the time. Conditions that change more, such as a rule or a kind of food, have
their own base.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hedon.config.config import Config
from hedon.config.dump import Fingerprint
from hedon.config.field import leaves, value_at
from hedon.config.layer import EVERY
from hedon.config.load import load_config
from hedon.config.problem import ConfigError, Problem, format_value
from hedon.config.rule_path import absolute_rule
from hedon.config.schema.settings import changes_worlds
from hedon.config.schema.species import PER_SPECIES
from hedon.config.validate import rebuild
from hedon.ensemble.condition import DIGITS, Base, Settings, SweepCondition, changes
from hedon.error import HedonError
from hedon.experiment.plan import RunPlan, require_measures
from hedon.experiment.rule import rules_beside
from hedon.sweep.factor import FIDELITY, PRESET

SHAPING = (PRESET, FIDELITY, "rule", "policy", "founders", "networks")
"""Last words of factors that are not plain values: a run needs more than the config for them, or refuses them."""


@dataclass(frozen=True)
class Conditions:
    """The valid conditions of a sweep, and the errors of the invalid ones.

    Attributes:
        found: The valid conditions.
        bases: Their base configs, by digest.
        invalid: The error of each invalid condition.
    """

    found: tuple[SweepCondition, ...]
    bases: Mapping[str, Base]
    invalid: tuple[ConfigError, ...]


@dataclass(frozen=True)
class Loader:
    """Loads complete configs of conditions.

    Attributes:
        path: Path of the sweep's file.
        base: Preset or file on which conditions are based, unless a factor sets it.
        fidelity: Their fidelity, unless a factor sets it; None for the fidelity of the base.
        fixed: Settings that all conditions share, as pairs of path and value.
    """

    path: Path
    base: str
    fidelity: str | None
    fixed: Sequence[tuple[str, Any]]

    def load(self, settings: Settings) -> RunPlan:
        """The config of a condition and its rules, as a plan.

        Raises:
            ConfigError: The condition is invalid; the message gives the place.
        """
        source = settings.get(PRESET, self.base)
        if source.endswith(".toml") and not Path(source).is_absolute():
            source = str(self.path.parent / source)
        varied = [(name, value) for name, value in settings.items() if name not in (PRESET, FIDELITY)]
        values = [(name, self._from_folder(name, value)) for name, value in [*self.fixed, *varied]]
        texts = [f"{name}={format_value(value)}" for name, value in values]
        try:
            config = load_config(source, settings.get(FIDELITY, self.fidelity), texts)
            return RunPlan(config, (1,), 1, "run", rules=rules_beside(source))
        except ConfigError as error:
            raise ConfigError(self.place(settings), error.problems) from None
        except HedonError as error:
            raise ConfigError(self.place(settings), [Problem("", str(error))]) from None

    def place(self, settings: Settings) -> str:
        """The name of a condition in error messages."""
        varied = ", ".join(f"{name} = {format_value(value)}" for name, value in settings.items())
        return f"{self.path}, with {varied}" if varied else str(self.path)

    def _from_folder(self, name: str, value: Any) -> Any:
        """A value of the file; the path of a Python rule, relative to the file's folder, becomes absolute."""
        return absolute_rule(value, self.path.parent) if name.endswith(".rule") else value


def make_conditions(loader: Loader, settings: Sequence[Settings]) -> Conditions:
    """Makes and checks all conditions of a sweep.

    Args:
        loader: Loads complete configs.
        settings: Values of the factors of each condition.
    """
    groups: dict[str, list[int]] = {}
    for index, combination in enumerate(settings):
        groups.setdefault(repr(list(_shaping(combination).items())), []).append(index)
    found: dict[int, SweepCondition] = {}
    invalid: dict[int, ConfigError] = {}
    bases: dict[str, Base] = {}
    for group in groups.values():
        results = _by_values(loader, settings, group) or _one_by_one(loader, settings, group)
        for index, result, base in results:
            if isinstance(result, ConfigError) or base is None:
                assert isinstance(result, ConfigError)
                invalid[index] = result
            else:
                found[index] = result
                if base.digest not in bases:
                    require_measures(base.config)
                    bases[base.digest] = base
    order = sorted(found)
    return Conditions(tuple(found[i] for i in order), bases, tuple(invalid[i] for i in sorted(invalid)))


_Made = Iterator[tuple[int, SweepCondition | ConfigError, Base | None]]


def _shaping(settings: Settings) -> Settings:
    return {name: value for name, value in settings.items() if name.rpartition(".")[2] in SHAPING}


def _one_by_one(loader: Loader, settings: Sequence[Settings], group: Sequence[int]) -> _Made:
    """Conditions that each have their own base."""
    for index in group:
        try:
            base = _base(loader.load(settings[index]), {})
            yield index, SweepCondition(base.digest, base.digest, settings[index]), base
        except ConfigError as error:
            yield index, error, None


def _by_values(loader: Loader, settings: Sequence[Settings], group: Sequence[int]) -> list[Any]:
    """Conditions derived from one base; none if the factors change more than values of its settings.

    As a check, the first, the last and the first invalid condition are also loaded in full.
    """
    shaping = _shaping(settings[group[0]])
    names = [name for name in settings[group[0]] if name not in shaping]
    if not names or len(group) == 1:
        return []
    try:
        plan = loader.load(shaping)
    except ConfigError:
        return []
    places = {name: tuple(_places(plan.config, name)) for name in names}
    all_places = [place for factor_places in places.values() for place in factor_places]
    if not all(places.values()) or len(set(all_places)) < len(all_places):
        return []
    base, fingerprint = _base(plan, places), Fingerprint(plan.config)
    results: list[tuple[int, SweepCondition | ConfigError, Base | None]] = []
    configs: dict[int, Config] = {}
    for index in group:
        values_of_one = settings[index]
        try:
            config = rebuild(plan.config, changes(places, values_of_one), "")
        except ConfigError as error:
            results.append((index, ConfigError(loader.place(values_of_one), error.problems), None))
            continue
        if not configs or index == group[-1]:
            configs[index] = config
        values = {place: value_at(config, place) for place in all_places}
        results.append((index, SweepCondition(fingerprint.digest(values)[:DIGITS], base.digest, values_of_one), base))
    first_invalid = next((index for index, _, base in results if base is None), None)
    is_consistent = all(_loads_as(loader, settings[index], config) for index, config in configs.items())
    return (
        results if is_consistent and (first_invalid is None or _loads_as(loader, settings[first_invalid], None)) else []
    )


def _loads_as(loader: Loader, settings: Settings, config: Config | None) -> bool:
    """Whether a condition, loaded in full, equals a config; for None, whether it is invalid."""
    try:
        return loader.load(settings).config == config
    except ConfigError:
        return config is None


def _base(plan: RunPlan, places: Mapping[str, tuple[str, ...]]) -> Base:
    return Base(Fingerprint(plan.config).digest({})[:DIGITS], plan.config, plan.rules, places)


def _places(config: Config, name: str) -> Iterator[str]:
    """The complete paths that a factor's name stands for: as in a config, `birth.kappa` means all species."""
    valid_paths = {path for path, _, _ in leaves(config) if changes_worlds(path)}
    paths = (
        [f"species.{species}.{name}" for species in config.species] if name.partition(".")[0] in PER_SPECIES else [name]
    )
    if name.startswith(f"food.{EVERY}."):
        paths = [name.replace(EVERY, kind, 1) for kind in config.food]
    return (path for path in paths if path in valid_paths)
