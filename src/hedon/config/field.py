"""Declarations of settings: meaning, unit, range and source, for readers and for programs."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from functools import cache
from types import MappingProxyType
from typing import Any, Literal, get_args, get_origin, get_type_hints

PAPER = "paper"
"""Printed in Kanagawa & Doya (2024), ALIFE."""
CODE = "code"
"""Value in the configuration of the paper's released code; the paper prints another value or none."""
EITHER = "paper or code"
"""The value that the paper prints, or else its released code's; the two do not conflict."""
OURS = "ours"
"""A choice of this project."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Range:
    """Allowed values: bounds `ge`, `gt`, `le` and `lt` for numbers, and `max_items` for lists.

    `each` bounds the numbers in a list, and `form` shows the required form of a string; `config.check` checks both.
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
    """Documentation of a setting from its declaration; see `setting`."""

    meaning: str
    unit: str
    source: str
    range: Range
    derived: bool
    shapes: bool


def setting(
    default: Any, meaning: str, unit: str, source: str, *, derived: bool = False, shapes: bool = False, **limits: Any
) -> Any:
    """Declares a setting: `width: float = setting(480.0, "extent along x", "u", PAPER, gt=0)`.

    Args:
        default: Value used if a config does not set it.
        meaning: Effect of the value, as a phrase.
        unit: Its unit, or "" for none.
        source: `PAPER`, `CODE`, `EITHER` or `OURS`, with a remark if needed.
        derived: The engine gets only what is derived from the setting: layouts, walls or lengths.
        shapes: The engine gets the setting, but layouts or walls depend on it too, so it cannot be changed separately.
        limits: Allowed values besides the type, passed to `Range`.
    """
    doc = {"doc": Doc(meaning, unit, source, Range(**limits), derived, shapes)}
    if isinstance(default, dict):
        return field(default_factory=default.copy, metadata=doc)
    return field(default=default, metadata=doc)


@dataclass(frozen=True, slots=True)
class Setting:
    """A field of a section: name, type, default and documentation."""

    name: str
    type: Any
    default: Any
    doc: Doc

    @property
    def choices(self) -> tuple[str, ...]:
        """Allowed names if the setting is a choice, else empty."""
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
    words = {float: "a number", int: "an integer", str: "a text", bool: "true or false"}
    if kind in words:
        return words[kind]
    if get_origin(kind) is dict:
        return "a table of numbers"
    items = get_args(kind)
    if items == (str, Ellipsis):
        return "a list of texts"
    if len(items) == 2 and items[1] is Ellipsis:
        return "a list of " + type_name(items[0]).removeprefix("a list ").removeprefix("of ")
    return "[" + ", ".join(type_name(item).split(" ", 1)[1] for item in items) + "]"


@dataclass(frozen=True, slots=True)
class Section:
    """A field that holds a section, or a table of sections by name; see `section`."""

    type: type
    repeated: bool
    most: int
    names: Mapping[str, Any]
    derived: bool


def section(
    make: Callable[[], Any] = dict, *, most: int = 0, names: Mapping[str, Any] | None = None, derived: bool = False
) -> Any:
    """Declares a section, or a table of sections by name."""
    return field(default_factory=make, metadata={"section": (most, names or {}, derived)})


@cache
def settings(section: type) -> Mapping[str, Setting]:
    """Settings of a section by name, in order, without inner sections."""
    hints, setting_fields = get_type_hints(section), (each for each in fields(section) if "doc" in each.metadata)
    return MappingProxyType(
        {
            each.name: Setting(each.name, hints[each.name], _default(each), each.metadata["doc"])
            for each in setting_fields
        }
    )


def _default(each: Field[Any]) -> Any:
    return each.default if each.default_factory is MISSING else each.default_factory()


@cache
def sections(section: type) -> Mapping[str, Section]:
    """Inner sections by name, in order."""
    hints, result = get_type_hints(section), {}
    for each in fields(section):
        if "section" in each.metadata:
            kind = hints[each.name]
            repeated = get_origin(kind) is dict
            inner = get_args(kind)[1] if repeated else kind
            result[each.name] = Section(inner, repeated, *each.metadata["section"])
    return MappingProxyType(result)


def number_of(table: Setting, name: str) -> Setting:
    """One entry of a table of numbers, as a setting."""
    low, high = table.doc.range.each or (-math.inf, math.inf)
    return Setting(name, float, 0.0, replace(table.doc, range=Range(ge=low, le=high)))


def engine_settings(section: type) -> Mapping[str, Setting]:
    """Settings that the engine gets: numbers, lists of numbers and choices, unless they are derived."""

    def has_text(kind: Any) -> bool:
        return kind is str or any(map(has_text, get_args(kind)))

    items = settings(section).items()
    return {name: each for name, each in items if not each.doc.derived and (each.choices or not has_text(each.type))}


def engine_sections(section: type) -> Mapping[str, Section]:
    """Inner sections that the engine gets at least a part of."""
    return {name: each for name, each in sections(section).items() if not each.derived}


def value_at(section: Any, path: str) -> Any:
    """Value at a path of a config or of a part of it.

    Raises:
        ValueError: A table of sections has no entry of this name.
        AttributeError: A section has no such setting.
    """
    if not path:
        return section
    if not isinstance(section, dict):
        name, _, remainder = path.partition(".")
        return value_at(getattr(section, name), remainder)
    # Names of users' sections may contain dots until they are refused.
    name = max((each for each in section if f"{path}.".startswith(f"{each}.")), key=len)
    return value_at(section[name], path[len(name) + 1 :])


def inner_sections(section: Any, path: str = "") -> Iterator[tuple[str, Section, Any]]:
    """Yields every section directly inside a section, or inside a table of it, with its path, in order."""
    for name, inner in sections(type(section)).items():
        content = getattr(section, name)
        for each, value in content.items() if inner.repeated else [("", content)]:
            yield f"{path}{name}.{each}" if inner.repeated else f"{path}{name}", inner, value


def leaves(section: Any, path: str = "") -> Iterator[tuple[str, Setting, Any]]:
    """Yields every setting in a section and its inner sections with its path and value, in order.

    Each number in a table of numbers has a path of its own: `food.normal.gives.energy`.
    """
    for name, setting in settings(type(section)).items():
        value = getattr(section, name)
        if isinstance(value, dict):
            for each, number in value.items():
                yield f"{path}{name}.{each}", number_of(setting, each), number
        else:
            yield f"{path}{name}", setting, value
    for place, _, inner in inner_sections(section, path):
        yield from leaves(inner, f"{place}.")
