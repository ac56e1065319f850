"""Every mechanism that a world can have, each described once, and worlds that combine them.

A mechanism is a file in `data/mechanism/`: config settings that override those of `base.toml`. In names and values,
"@self" is the species that has it, "@other" the next species, and "@rule" the file of rules. Everything else is in the
table `mechanism`: `draw` (other values of its settings, by path), `group` (a species has at most one mechanism of a
group), `clash` (mechanisms that exclude it), `species` (the smallest number it needs), `whole` (all species have it),
and what settings cannot express: `driven` by a caller, `founders` or `networks` as data.
"""

import random
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property
from itertools import combinations, product
from pathlib import Path
from typing import Any

from hedon.config.config import Config
from hedon.config.load import load_config
from hedon.config.problem import format_value
from hedon.config.schema.species import ONLY, PER_SPECIES

FOLDER = Path(__file__).parent / "data" / "mechanism"
NAMES = ("ant", "bee", "cat")
"""Names of species."""
MAX_KINDS = 8

Settings = dict[tuple[str, ...], Any]


@dataclass(frozen=True)
class Mechanism:
    """One mechanism: see the top of this file."""

    name: str
    settings: Settings = field(repr=False, hash=False)
    draw: Mapping[str, list[Any]] = field(default_factory=dict, hash=False)
    group: tuple[str, ...] = ()
    clash: tuple[str, ...] = ()
    species: int = 0
    whole: bool = False
    driven: bool = False
    founders: bool = False
    networks: bool = False

    @cached_property
    def shared(self) -> bool:
        """Whether some of its settings apply to the whole world."""
        return self.founders or any(map(is_shared, self.settings))

    @cached_property
    def own(self) -> bool:
        """Whether some of its settings belong to one species."""
        return not all(map(is_shared, self.settings))

    @cached_property
    def kinds(self) -> frozenset[str]:
        """The kinds of food that it needs."""
        return frozenset(path[1] for path in self.settings if path[0] == "food")

    @cached_property
    def pointed(self) -> bool:
        """Whether its settings name species."""
        return any("@self" in text or "@other" in text for text in map(str, self.settings.items()))

    def excludes(self, other: "Mechanism") -> bool:
        """Whether a species cannot have both."""
        return bool({*self.group} & {*other.group}) or other.name in self.clash or self.name in other.clash

    def excludes_everywhere(self, other: "Mechanism") -> bool:
        """Whether a world cannot have both."""
        if not self.excludes(other):
            return False
        one_only = {*self.group} & {*other.group} and self.shared and other.shared
        return bool(one_only) or not (self.own and other.own) or self.whole or other.whole


def is_shared(path: tuple[str, ...]) -> bool:
    """Whether a setting applies to the whole world."""
    return path[0] not in PER_SPECIES


def flat(tables: Mapping[str, Any], path: tuple[str, ...] = ()) -> Settings:
    """Nested tables as settings by path."""
    found: Settings = {}
    for name, value in tables.items():
        found |= flat(value, (*path, name)) if isinstance(value, dict) else {(*path, name): value}
    return found


def read(path: Path) -> tuple[dict[str, Any], Settings]:
    """A file's table `mechanism`, and its settings."""
    tables = tomllib.loads(path.read_text())
    about = {
        name: tuple(value) if isinstance(value, list) else value for name, value in tables.pop("mechanism", {}).items()
    }
    return about, flat(tables)


BASE = read(FOLDER / "base.toml")[1]


@cache
def mechanisms() -> dict[str, Mechanism]:
    """Every mechanism by name, in a fixed order."""
    found = {}
    for path in sorted(FOLDER.glob("*/*.toml")):
        about, settings = read(path)
        assert path.stem not in found
        found[path.stem] = Mechanism(path.stem, settings, **about)
    return found


@dataclass(frozen=True)
class Part:
    """A mechanism in a world: of one species, by index, or of all."""

    mechanism: Mechanism
    species: int | None = None
    values: Mapping[str, Any] = field(default_factory=dict, hash=False)
    """Drawn values, by path."""

    def excludes(self, other: "Part") -> bool:
        if self.mechanism.excludes_everywhere(other.mechanism):
            return True
        alone = self.species is None or other.species is None or self.species == other.species
        return alone and self.mechanism.excludes(other.mechanism)


@dataclass(frozen=True)
class Mixture:
    """A world with several mechanisms; if `species` is empty, its config has no `[species]`."""

    species: tuple[str, ...]
    parts: tuple[Part, ...]

    @property
    def text(self) -> str:
        """Its config as TOML."""
        lines = dict(BASE)
        own = dict.fromkeys(self.species, 0)
        for part in self.parts:
            mine, other = self._names(part.species)
            drawn = {tuple(path.split(".")): value for path, value in part.values.items()}
            for path, value in (part.mechanism.settings | drawn).items():
                full = tuple(_named(word, mine, other) for word in path)
                if self.species and part.species is not None and not is_shared(path):
                    full = ("species", mine, *full)
                    own[mine] += 1
                lines[full] = _named(value, mine, other)
        empty = [f"species.{name} = {{}}" for name, count in own.items() if not count]
        return (
            "\n".join([*(f"{'.'.join(path)} = {format_value(value)}" for path, value in lines.items()), *empty]) + "\n"
        )

    def _names(self, index: int | None) -> tuple[str, str]:
        if not self.species or index is None:
            return ONLY, ONLY
        return self.species[index], self.species[(index + 1) % len(self.species)]

    def config(self, folder: Path) -> Config:
        """Its config, loaded from a file in a folder."""
        file = folder / "world.toml"
        file.write_text(self.text)
        return load_config(file)

    @property
    def pairs(self) -> set[tuple[str, str]]:
        """The pairs of mechanisms in it."""
        names = {part.mechanism.name for part in self.parts}
        return {*combinations([name for name in mechanisms() if name in names], 2)}

    def any(self, what: str) -> bool:
        """Whether a mechanism has this attribute: "driven", "founders" or "networks"."""
        return any(getattr(part.mechanism, what) for part in self.parts)


def _named(value: Any, mine: str, other: str) -> Any:
    if isinstance(value, list):
        return [_named(item, mine, other) for item in value]
    if not isinstance(value, str):
        return value
    return value.replace("@self", mine).replace("@other", other).replace("@rule", str(FOLDER / "rule.py"))


def alone(mechanism: Mechanism) -> Mixture:
    """A world with one mechanism and as few species as it needs; the first species has it."""
    count = mechanism.species
    return Mixture(NAMES[:count], (Part(mechanism, 0 if count and not mechanism.whole else None),))


def possible_pairs() -> set[tuple[str, str]]:
    """The pairs of mechanisms that a world can combine."""
    return {(a.name, b.name) for a, b in combinations(mechanisms().values(), 2) if not a.excludes_everywhere(b)}


def worlds(seed: int, size: int) -> Iterator[tuple[Mixture, set[tuple[str, str]]]]:
    """Endless random worlds of up to `size` mechanisms, each with the pairs that are new in it.

    Once every possible pair has occurred, the cycle restarts with other values and species.
    """
    draw = random.Random(seed)
    missing: set[tuple[str, str]] = set()
    while True:
        missing = missing or possible_pairs()
        world = _draw_world(draw, missing, size)
        new = missing & world.pairs
        missing -= new
        yield world, new


def _draw_world(draw: random.Random, missing: set[tuple[str, str]], size: int) -> Mixture:
    wanted = [mechanisms()[name] for name in draw.choice(sorted(missing))]
    least = max(2 if wanted[0].excludes(wanted[1]) else 0, *(each.species for each in wanted))
    species = NAMES[: draw.choice([count for count in (0, 1, 2, 2, 3) if count >= least])]
    both = product(*(_places(draw, mechanism, species) for mechanism in wanted))
    parts = next([a, b] for a, b in both if _fits(a, [], species) and _fits(b, [a], species))
    rest = [each for each in mechanisms().values() if each not in wanted]
    while rest and len(parts) < size:
        draw.shuffle(rest)
        rest.sort(key=lambda each: _gain(each, parts, missing))
        mechanism = rest.pop()
        part = next((each for each in _places(draw, mechanism, species) if _fits(each, parts, species)), None)
        if part is not None:
            parts.append(part)
    return Mixture(species, tuple(parts))


def _gain(mechanism: Mechanism, parts: list[Part], missing: set[tuple[str, str]]) -> int:
    names = [part.mechanism.name for part in parts]
    return sum((name, mechanism.name) in missing or (mechanism.name, name) in missing for name in names)


def _places(draw: random.Random, mechanism: Mechanism, species: tuple[str, ...]) -> list[Part]:
    """A mechanism in each species and in all of them, in random order, with randomly drawn values."""
    of: list[int | None] = [*range(len(species))]
    draw.shuffle(of)
    if not species or mechanism.whole or not mechanism.own:
        of = [None]
    elif not mechanism.pointed:
        of.insert(0 if draw.random() < 0.3 else len(of), None)
    values = {path: draw.choice(values) for path, values in mechanism.draw.items() if draw.random() < 0.5}
    return [Part(mechanism, index, values) for index in of]


def _fits(part: Part, parts: list[Part], species: tuple[str, ...]) -> bool:
    if len(species) < part.mechanism.species or any(part.excludes(other) for other in parts):
        return False
    kinds = {"normal", *(kind for each in (part, *parts) for kind in each.mechanism.kinds)}
    absent = {each.species for each in (part, *parts) if each.mechanism.name == "absent"}
    return len(kinds) <= MAX_KINDS and None not in absent and len(absent) < max(len(species), 1)
