"""The documentation of each setting: its meaning, unit, range and source, for people and for programs."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from types import MappingProxyType
from typing import Annotated, Any, Literal, get_args, get_origin, get_type_hints

PAPER = "paper"
"""Printed in Kanagawa & Doya (2024), ALIFE."""
CODE = "code"
"""The value in the configuration of the paper's released code; the paper prints another value or none."""
EITHER = "paper or code"
"""The paper's value if it prints one, else that of its released code; the two do not differ."""
OURS = "ours"
"""A choice of this project."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Which values are allowed: numbers by `ge`, `gt`, `le` and `lt`, lists by `max_items`.

    `each` has the least and the largest number in a list, `form` shows how a text must look: `config.check` checks
    both.
    """

    ge: float | None = None
    gt: float | None = None
    le: float | None = None
    lt: float | None = None
    max_items: int | None = None
    each: tuple[float, float] | None = None
    form: str | None = None

    def __contains__(self, value: float) -> bool:
        return (
            (self.ge is None or value >= self.ge)
            and (self.gt is None or value > self.gt)
            and (self.le is None or value <= self.le)
            and (self.lt is None or value < self.lt)
        )

    def __str__(self) -> str:
        if self.form is not None:
            return f"of the form `{self.form}`"
        if self.max_items is not None or self.each is not None:
            items = "" if self.max_items is None else f"with at most {self.max_items} items"
            numbers = "" if self.each is None else f"with numbers from {self.each[0]:.10g} to {self.each[1]:.10g}"
            return ", ".join(filter(None, (items, numbers)))
        if self.ge is not None and self.le is not None:
            return f"from {self.ge:.10g} to {self.le:.10g}"
        signs = {">=": self.ge, ">": self.gt, "<=": self.le, "<": self.lt}
        return " and ".join(f"{sign} {bound:.10g}" for sign, bound in signs.items() if bound is not None)


@dataclass(frozen=True, slots=True)
class Doc:
    """The annotation of one setting: `Annotated[float, Doc("meaning", "unit", SOURCE, Range(ge=0))]`.

    Attributes:
        meaning: What the value does, as a phrase.
        unit: Its unit, or "" if it has none.
        source: `PAPER`, `CODE`, `EITHER` or `OURS`, with a remark if one is needed.
        range: The allowed values, besides their type.
        derived: The engine gets what is made of it, in layouts, walls or lengths, and not the setting itself.
        shapes: The engine gets it, but layouts or walls depend on it too: it cannot be changed without them.
    """

    meaning: str
    unit: str
    source: str
    range: Range = Range()
    derived: bool = False
    shapes: bool = False
    __is_annotated_types_grouped_metadata__: Literal[True] = True

    def __iter__(self) -> Iterator[object]:
        """Yields the range in the validator's form (the protocol of grouped metadata)."""
        from pydantic import Field

        bounds: Any = Field(
            ge=self.range.ge,
            gt=self.range.gt,
            le=self.range.le,
            lt=self.range.lt,
            max_length=self.range.max_items,
        )
        yield from bounds.metadata


@dataclass(frozen=True, slots=True)
class Setting:
    """One field of a section: its name, type, default and documentation."""

    name: str
    type: Any
    default: Any
    doc: Doc

    @property
    def choices(self) -> tuple[str, ...]:
        """The allowed names if the setting is a choice among names, else none."""
        return get_args(self.type) if get_origin(self.type) is Literal else ()

    @property
    def allowed(self) -> str:
        """Type, range and unit in words, for error messages and the reference page."""
        if self.choices:
            return "one of " + ", ".join(f'"{choice}"' for choice in self.choices)
        limits = str(self.doc.range)
        unit = f"[{self.doc.unit}]" if self.doc.unit else ""
        return " ".join(filter(None, (type_name(self.type), limits, unit)))


def type_name(kind: Any) -> str:
    """A type in words: "a number", "a list of [number, number]"."""
    plain = {float: "a number", int: "an integer", str: "a text", bool: "true or false"}
    if kind in plain:
        return plain[kind]
    items = get_args(kind)
    if items == (str, Ellipsis):
        return "a list of texts"
    if len(items) == 2 and items[1] is Ellipsis:
        return "a list of " + type_name(items[0]).removeprefix("a list ").removeprefix("of ")
    return "[" + ", ".join(type_name(item).split(" ", 1)[1] for item in items) + "]"


@dataclass(frozen=True, slots=True)
class Table:
    """The annotation of a table of sections by name.

    Attributes:
        most: How many there may be, where users choose the names.
        names: The names, where they are given, each with the largest factor of a schedule or the meaning of a gene.
        derived: As in `Doc`.
    """

    most: int = 0
    names: Mapping[str, Any] | None = None
    derived: bool = False


DERIVED = Table(derived=True)
"""The annotation of a section whose settings reach the engine in layouts alone."""


@dataclass(frozen=True, slots=True)
class Section:
    """A field that is a section, or a table of sections by the name of their kind."""

    type: type
    repeated: bool
    table: Table = Table()


@cache
def settings(section: type) -> Mapping[str, Setting]:
    """The documented settings of a section by name, in order, without its inner sections."""
    hints = get_type_hints(section, include_extras=True)
    found = {}
    for field in fields(section):
        kind, *notes = get_args(hints[field.name]) or [None]
        if notes and isinstance(notes[0], Doc):
            found[field.name] = Setting(field.name, kind, field.default, notes[0])
    return MappingProxyType(found)


@cache
def sections(section: type) -> Mapping[str, Section]:
    """The inner sections of a section by name, in order."""
    hints = get_type_hints(section, include_extras=True)
    found = {}
    for field in fields(section):
        kind, table = hints[field.name], Table()
        if get_origin(kind) is Annotated:
            kind, table = get_args(kind)
        repeated = get_origin(kind) is dict
        inner = get_args(kind)[1] if repeated else kind
        if isinstance(inner, type) and is_dataclass(inner):
            found[field.name] = Section(inner, repeated, table)
    return MappingProxyType(found)


def engine_settings(section: type) -> Mapping[str, Setting]:
    """The settings of a section that the engine gets: numbers, lists of them and choices, unless they are derived."""

    def has_text(kind: Any) -> bool:
        return kind is str or any(map(has_text, get_args(kind)))

    own = settings(section).items()
    return {name: each for name, each in own if not each.doc.derived and (each.choices or not has_text(each.type))}


def engine_sections(section: type) -> Mapping[str, Section]:
    """The inner sections of a section of which the engine gets anything itself."""
    return {name: each for name, each in sections(section).items() if not each.table.derived}


def find(root: type, path: Sequence[str | int]) -> Setting | type | None:
    """Follows a path below a section: gives the setting that it leads to or into, a section, or None.

    Args:
        root: the type of a section.
        path: names below it, and names or indices of what repeats.
    """
    here, parts = root, list(path)
    while parts:
        name = parts.pop(0)
        if not isinstance(name, str):
            return None
        if name in settings(here):
            return settings(here)[name]
        if name not in sections(here):
            return None
        if sections(here)[name].repeated and parts:
            parts.pop(0)
        here = sections(here)[name].type
    return here


def places(section: type, name: str, path: str = "") -> Iterator[str]:
    """The paths of all settings of this name in a section and its inner sections, in order.

    Args:
        section: its type.
        name: of the setting.
        path: of the section, with a dot at its end; empty for the config itself.
    """
    for inner_name, inner in sections(section).items():
        # A file has the sections of species at the top too.
        below = path if inner_name == "species" else f"{path}{inner_name}." + ("<kind>." if inner.repeated else "")
        if name in settings(inner.type):
            yield below + name
        yield from places(inner.type, name, below)


def value_at(section: Any, path: str) -> Any:
    """What a config, or a part of one, has at a path.

    Args:
        section: a config, a section, or a table of sections.
        path: names joined by points.

    Raises:
        KeyError: There is no such name in a table of sections.
        AttributeError: A section has no such setting.
    """
    for name in path.split("."):
        section = section[name] if isinstance(section, dict) else getattr(section, name)
    return section


def leaves(section: object, path: str = "") -> Iterator[tuple[str, Setting, Any]]:
    """Every setting in a section and its inner sections by its path, in order, with its value.

    Args:
        section: a config, or a part of one.
        path: of the section, with a dot at its end; empty for the config itself.
    """
    for name, setting in settings(type(section)).items():
        yield f"{path}{name}", setting, getattr(section, name)
    for name, inner in sections(type(section)).items():
        below = getattr(section, name)
        for kind, item in below.items() if inner.repeated else [("", below)]:
            yield from leaves(item, f"{path}{name}.{kind}." if kind else f"{path}{name}.")
