"""Generates the engine's structs of all settings: `python -m hedon.config.header > engine/config/schema.h`.

Each section becomes a struct, each setting a member of the same name, and each choice an enumeration named after its
section and setting. Structs include the limits of their members, which the engine checks itself.
"""

import sys
import textwrap
from collections.abc import Iterator
from dataclasses import is_dataclass
from typing import Any, get_args

from hedon.config import room
from hedon.config.channel import LAST, SEVERAL, SOURCES
from hedon.config.field import Setting, engine_sections, engine_settings
from hedon.config.schema.evolution import FAMILY_GENES, LEARNING_GENES, GeneConfig, MutationConfig
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import RULE_USES

_HEAD = """\
/// Every setting that the engine gets, as `src/hedon/config` declares it, with its meaning, unit, range and source.
/// This file is written by `uv run python -m hedon.config.header > engine/config/schema.h`. Do not edit it.
// clang-format off
#pragma once

#include <cstdint>

#include "base/array.h"
#include "base/fields.h"
#include "base/vec2.h"
#include "config/setting.h"

namespace hedon {
"""
_NUMBERS = {float: "float", int: "int32_t", bool: "int32_t"}
_PAIRS = {(float, float): "Vec2", (int, float): "SchedulePoint"}


def header() -> str:
    """The whole header."""
    return "\n".join([_HEAD, *_room(), "", *_structs(), "}  // namespace hedon\n"])


def _room() -> Iterator[str]:
    for name, value in vars(room).items():
        if name.isupper():
            yield f"inline constexpr {'int' if isinstance(value, int) else 'float'} {name} = {value};"


def _structs() -> Iterator[str]:
    structs: dict[str, list[str]] = {}
    for root in (GeneConfig, MutationConfig, Settings):  # layouts contain gene laws and mutations
        _add(root, structs)
    for lines in structs.values():
        yield from lines
    yield f"HEDON_ENUM(GenomeLearning, {', '.join(LEARNING_GENES)})"
    yield f"HEDON_ENUM(GenomeFamily, {', '.join(FAMILY_GENES)})"
    yield f"HEDON_ENUM(RuleUse, {', '.join(RULE_USES)})"
    several = {name: source.several for name, source in SOURCES.items()} | {LAST: LAST}
    words = ("one", "two", *SEVERAL, LAST)
    channels_of = ", ".join(f"ChannelOf::{word}" for word in several.values())
    yield _wrapped(f"HEDON_ENUM(ChannelSource, {', '.join(several)})")
    yield _wrapped(f"HEDON_ENUM(ChannelOf, {', '.join(words)})")
    yield _wrapped(f"inline constexpr ChannelOf CHANNEL_OF[] = {{{channels_of}}};") + "\n"


def _add(section: type, structs: dict[str, list[str]]) -> str:
    """Adds the struct of a section after the structs of its inner sections; returns its name."""
    if is_dataclass(section.__base__):  # same settings, other defaults
        return _add(section.__base__, structs)
    name = section.__name__
    prefix, enums, members = name.removesuffix("Config"), [], []
    for setting in engine_settings(section).values():
        kind = _type(setting)
        if setting.choices:
            kind = prefix + _camel(setting.name)
            enums.append(f"HEDON_ENUM({kind}, {', '.join(setting.choices)})")
        members.append((kind, setting.name, _limit(setting), setting.doc.unit))
    for place, inner in engine_sections(section).items():
        kind = _add(inner.type, structs)
        if inner.names:
            names = [(kind, key, f"Limit::from(0, {factor:.10g})", "") for key, factor in inner.names.items()]
            kind = prefix + _camel(place)
            structs[kind] = _struct(kind, names)
        elif inner.repeated:
            kind = f"FixedList<{kind}, {inner.most}>"
        members.append((kind, place, "Limit()", ""))
    structs[name] = [*enums, *_struct(name, members)]
    return name


def _struct(name: str, members: list[tuple[str, str, str, str]]) -> list[str]:
    units = {member: f"  ///< [{unit}]" if unit else "" for _, member, _, unit in members}
    return [
        f"struct {name} {{",
        *(f"  {kind} {member};{units[member]}" for kind, member, _, _ in members),
        _wrapped(f"  HEDON_FIELDS({name}, {', '.join(member for _, member, _, _ in members)})"),
        _wrapped(f"  static constexpr Limit LIMITS[] = {{{', '.join(limit for _, _, limit, _ in members)}}};"),
        "};\n",
    ]


def _wrapped(line: str) -> str:
    return textwrap.fill(line, 120, subsequent_indent="      ")


def _camel(name: str) -> str:
    return "".join(part.capitalize() for part in name.split("_"))


def _type(setting: Setting) -> str:
    def of(kind: Any) -> str:
        items = get_args(kind)
        if items[1:] == (Ellipsis,):
            return f"FixedList<{of(items[0])}, {setting.doc.range.max_items}>"
        return _PAIRS[items] if items in _PAIRS else _NUMBERS[kind]

    return "" if setting.choices else of(setting.type)


def _limit(setting: Setting) -> str:
    """Limit of a number, or of each number in a list."""
    if setting.choices:
        return "Limit()"
    if setting.type is bool:
        return "Limit::from(0, 1)"
    allowed = setting.doc.range
    low, high = allowed.each or (allowed.ge if allowed.gt is None else allowed.gt, allowed.le or allowed.lt)
    kind = "over" if allowed.gt is not None else "from" if allowed.lt is None else "under"
    return f"Limit::{kind}({low:.10g}, {high:.10g})"


if __name__ == "__main__":
    sys.stdout.write(header())
