"""Every mechanism and every setting has a case; a new one without a case fails here."""

from collections.abc import Iterator
from typing import Any

from golden_case import cases
from mechanism import BASE, mechanisms

from hedon.config.config import Config
from hedon.config.field import sections, settings
from hedon.config.load import FIDELITIES, PRESETS
from hedon.config.schema.evolution import FAMILY_GENES, LEARNING_GENES
from hedon.config.schema.settings import changes_worlds
from hedon.config.schema.species import PER_SPECIES, SpeciesConfig

AS_DATA = {"world.founders": "founders", "world.networks": "networks"}
"""Settings that a run sets itself, with the names that mechanisms use for them."""


def every_setting(section: type = Config, path: str = "") -> Iterator[tuple[str, tuple[str, ...], Any]]:
    """The path of every setting in a single-species file (`*` for names), its choices and its default."""
    for name, setting in settings(section).items():
        if changes_worlds(f"{path}{name}"):
            yield path + name, setting.choices, setting.default
    for name, inner in sections(section).items():
        below = "" if name == "species" else f"{path}{name}." + ("*." if inner.repeated else "")
        yield from every_setting(inner.type, below)


def general(path: tuple[str, ...]) -> str:
    """The path of a setting with `*` for names."""
    here: type = SpeciesConfig if path[0] in PER_SPECIES else Config
    told, words = [], list(path)
    while words and (not told or told[-1] not in settings(here)):
        told.append(words.pop(0))
        if told[-1] in sections(here):
            inner = sections(here)[told[-1]]
            here = inner.type
            if inner.repeated:
                words = words[-1:] if told[-1] == "set" else words[1:]  # the key of `set` is a whole path
                told.append("*")
    return ".".join(told)


def tried() -> dict[str, list[object]]:
    """The values of each setting in the mechanisms and their draws."""
    found: dict[str, list[object]] = {}
    for table in (BASE, *(each.settings for each in ALL)):
        for path, value in table.items():
            found.setdefault(general(path), []).append(value)
    for each in ALL:
        for path, values in each.draw.items():
            found.setdefault(general(tuple(path.split("."))), []).extend(values)
    return found


ALL = tuple(mechanisms().values())


def test_every_preset_has_a_case_of_every_fidelity():
    assert {f"preset.{preset}.{fidelity}" for preset in PRESETS for fidelity in FIDELITIES} <= set(cases())


def test_every_setting_is_set_by_a_mechanism():
    said = {path for each in ALL for path in map(general, each.settings)}
    known = {path for path, _, _ in every_setting()}
    assert said <= known
    assert sorted(known - said - set(AS_DATA) - set(map(general, BASE))) == []
    for what in AS_DATA.values():
        assert any(getattr(each, what) for each in ALL)


def test_every_choice_is_tried():
    found = tried()
    for path, choices, default in every_setting():
        missing = [choice for choice in choices if choice != default and choice not in found.get(path, ())]
        assert not missing, f"{path}: no mechanism has {', '.join(missing)}"
    for section, genes in (("learning", LEARNING_GENES), ("family", FAMILY_GENES)):
        paths = {path[:3] for each in ALL for path in each.settings}
        assert {("genome", section, gene) for gene in genes} <= paths
