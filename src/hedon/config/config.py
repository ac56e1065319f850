"""A config: settings that have passed all checks. One setting can be changed at a time."""

from dataclasses import asdict, dataclass
from typing import Any

from hedon.config.layer import EVERY, settle_genes, settle_stores_and_queries
from hedon.config.override import parse_path
from hedon.config.problem import ConfigError, Problem, folded, format_value
from hedon.config.retired import new_path
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import PER_SPECIES, default_path
from hedon.config.validate import build
from hedon.error import ArgumentError
from hedon.shown import table_html
from hedon.text import brief, count


@dataclass(frozen=True, slots=True, repr=False)
class Config(Settings):
    """Settings of one run, with methods to change one of them; see `Settings`."""

    def __repr__(self) -> str:
        return f"<Config {self.name} ({self.fidelity}), {count(len(self._changes()), 'setting')} changed>"

    def _repr_html_(self) -> str:
        """Shown in notebooks: the settings that differ from the preset."""
        rows = [[path, _formatted(old), _formatted(new)] for path, old, new in self._changes()]
        return table_html(f"{self.name} ({self.fidelity})", ("setting", self.preset, "here"), rows)

    def _changes(self) -> list[tuple[str, Any, Any]]:
        from hedon.config.load import changed_settings  # imported late: it loads configs

        return changed_settings(self)

    @property
    def driven(self) -> tuple[str, ...]:
        """Species whose agents are controlled by a program."""
        return tuple(name for name, species in self.species.items() if species.learning.policy == "external")

    def with_(self, path: str, value: Any) -> "Config":
        """Returns a checked copy of the config in which one setting has another value.

        Raises:
            ConfigError: The setting does not exist, or the value is invalid.
            ArgumentError: The path is not a string.
        """
        if not isinstance(path, str):
            raise ArgumentError(f"path: must be that of a setting, such as energy.initial, not {brief(repr(path))}")
        tables, names = asdict(self), parse_path(path)
        if not names:
            raise ConfigError(self.name, [Problem(repr(path), "must be the path of a setting, as in energy.initial")])
        current_path = new_path(default_path(".".join(names)))
        if current_path is not None:
            raise ConfigError(self.name, [Problem(path, f"is called {current_path} now")])
        roots = [["species", name] for name in tables["species"]] if names[0] in PER_SPECIES else [[]]
        kinds = list(tables["food"]) if names[:2] == ["food", EVERY] else []
        for root in [["food", kind] for kind in kinds] or roots:
            if not _put(tables, [*root, *(names[2:] if kinds else names)], value):
                raise ConfigError(self.name, [Problem(path, "there is no such setting")])
        settle_genes(tables)
        problems = list(settle_stores_and_queries(tables))
        if problems:
            raise ConfigError(self.name, folded(problems, tuple(self.species)))
        return build(Config, tables, self.name)


def validated(config: Config, origin: str = "config") -> Config:
    """Checks a config that was built in Python, and returns it.

    Raises:
        ConfigError: A type, range or name is wrong, or settings contradict one another.
        ArgumentError: The argument is not a `Config`.
    """
    if not isinstance(config, Config):
        raise ArgumentError(f"config: must be a Config, as `load_config` gives it, not {brief(repr(config))}")
    return build(Config, asdict(config), origin)


def _formatted(value: Any) -> str:
    return "(absent)" if value is None else format_value(value)


def _put(tables: dict[str, Any], names: list[str], value: Any) -> bool:
    """Sets a value in nested tables, if its place exists. A gene without a mutation table gets one."""
    for depth, name in enumerate(names[:-1]):
        subtable = tables.get(name) if depth == 1 and names[0] in ("food", "species") else tables.setdefault(name, {})
        if not isinstance(subtable, dict):
            return False
        tables = subtable
    tables[names[-1]] = value
    return True
