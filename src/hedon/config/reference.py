"""Generates the reference page of all settings: `python -m hedon.config.reference > docs/config.md`."""

import sys
from collections.abc import Iterator
from inspect import getdoc

from hedon.config.channel import SEVERAL, SOURCES, Source
from hedon.config.field import sections, settings, type_name
from hedon.config.load import FIDELITIES, PRESETS, describe_fidelity, describe_preset
from hedon.config.problem import format_value
from hedon.config.schema.settings import Settings
from hedon.config.schema.species import SpeciesConfig

_HEAD = """\
# Settings

This page is written by `uv run python -m hedon.config.reference > docs/config.md`. Do not edit it.

A config is a TOML file. It may start with `preset` and `fidelity`; after that it has only the settings that differ:

```toml
preset = "baseline"
fidelity = "corrected"

[energy]
initial = 20.0

[food.fungus]        # a new kind of food must say what it gives
gives = { energy = 0.5, water = 2.0 }

[store.water]        # a new store must say its capacity
capacity = 50.0

[food."*"]           # every kind of food
growth_rate = 0.5
```

If a setting is given more than once, the last one counts. The order is: preset, fidelity, file, then
`--set section.name=value` on the command line. `normal = false` under `[food]` removes a kind of food. The order of
the kinds is the order of the sensor's channels and of the genome's weights. A file with `complete = true`, as
`hedon config show` prints it, has all settings and takes none from its preset.

Sources: "paper" is the value printed in Kanagawa & Doya (2024), "code" is the value in the configuration of its
released code, "ours" is a choice of this project; "paper or code" is the paper's value if it prints one, else the
code's.
"""


def reference() -> str:
    """The whole page in Markdown."""
    names = _table(("preset", "what it is"), ((f"`{name}`", describe_preset(name)) for name in PRESETS))
    overlays = _table(("fidelity", "what it is"), ((f"`{name}`", describe_fidelity(name)) for name in FIDELITIES))
    return "\n".join([_HEAD, names, overlays, *_sections(Settings(), ""), _channels()]).rstrip() + "\n"


_CHANNELS = """\
## Channels

A channel is a number that can be known of an agent in a step. `reward.pay` pays for channels, `reward.gate` compares
one with a threshold, `sensor.observes` lets agents observe them ([guide](guide/reward.md)). What is *of the step* is
known only when a step is done: who observes it gets that of the step before.
"""


def _channels() -> str:
    """The page's part on channels."""

    def row(source: Source) -> tuple[str, ...]:
        names, place = SEVERAL[source.of] if isinstance(source.of, str) else (source.of, "")
        names_text = ", ".join(f"`{source.name.format(name)}`" for name in names)
        meaning = " or ".join(f"`{name}`" if "<" in name else name for name in names)
        return names_text, source.meaning.format(meaning), source.unit, place, "yes" if source.of_step else ""

    head = ("channel", "meaning", "unit", "where", "of the step")
    return f"{_CHANNELS}\n{_table(head, map(row, SOURCES.values()))}"


def _sections(default: object, path: str) -> Iterator[str]:
    """The page's parts on a section, with its defaults, and on its inner sections."""
    section = type(default)
    yield f"## `[{path}]`\n" if path else "## At the top\n"
    yield f"{getdoc(section)}\n"
    rows = (
        (
            f"`{setting.name}`",
            f"`{format_value(getattr(default, setting.name))}`",
            setting.doc.meaning,
            setting.doc.unit,
            " or ".join(f"`{choice}`" for choice in setting.choices)
            or f"{type_name(setting.type)} {setting.doc.range}".strip(),
            setting.doc.source,
        )
        for setting in settings(section).values()
    )
    if settings(section):
        yield _table(("name", "default", "meaning", "unit", "allowed", "source"), rows)
    if section is SpeciesConfig:
        names = ", ".join(f"`{name}`" for name in sections(section))
        yield f"At the top of a file, each of these sections is a default for all its species: {names}.\n"
        path = ""
    for name, inner in sections(section).items():
        inner_path = f"{path}.{name}".lstrip(".") + (".<kind>" if inner.repeated else "")
        yield from _sections(inner.type() if inner.repeated else getattr(default, name), inner_path)


def _table(head: tuple[str, ...], rows: Iterator[tuple[str, ...]]) -> str:
    lines = [head, ("---",) * len(head), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(reference())
