import dataclasses

import pytest

from hedon.config.config import Config
from hedon.config.field import Range, Setting, leaves, sections, settings, value_at


def all_settings(section: type = Config) -> list[Setting]:
    inner = [setting for below in sections(section).values() for setting in all_settings(below.type)]
    return [*settings(section).values(), *inner]


@pytest.mark.parametrize("setting", all_settings(), ids=lambda setting: setting.name)
def test_every_setting_is_documented(setting: Setting) -> None:
    assert setting.doc.meaning
    assert setting.doc.source.startswith(("paper", "code", "ours"))
    if setting.type in (int, float):
        assert setting.doc.range != Range(), "a number needs a range"


def test_every_field_is_a_setting_or_a_section() -> None:
    def check(section: type) -> None:
        names = {field.name for field in dataclasses.fields(section)}
        assert names == set(settings(section)) | set(sections(section))
        for below in sections(section).values():
            check(below.type)

    check(Config)


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("species.agent.energy.initial", "a number from 0 to 1000000 [energy]"),
        ("species.agent.body.radius", "a number > 0 and <= 1000 [u]"),
        ("species.agent.sensor.scaling", 'one of "raw", "unit"'),
        ("species.agent.sensor.ray_count", "an integer from 1 to 32"),
        (
            "food.normal.placement.centers",
            "a list of [number, number] with at most 16 items, with numbers from 0 to 100000 [u]",
        ),
        ("food.normal.color", "a text of the form `#rrggbb`"),
    ],
)
def test_allowed_values_are_described(path: str, text: str) -> None:
    assert {place: setting for place, setting, _ in leaves(Config())}[path].allowed == text


def test_a_path_leads_to_a_value() -> None:
    config = Config()
    assert all(value_at(config, path) == value for path, _, value in leaves(config))
    assert value_at(config, "food.normal.placement") is config.food["normal"].placement
    assert value_at({"a": {"b": 1}, "a.b": {"c": 2}}, "a.b.c") == 2
    for path in ("enrgy", "food.norml", "arena.inner_walls.x"):
        with pytest.raises((ValueError, AttributeError)):
            value_at(config, path)
