import dataclasses

import pytest

from hedon.config.config import Config
from hedon.config.field import Range, Setting, find, sections, settings


def all_settings(section: type = Config) -> list[Setting]:
    inner = [setting for below in sections(section).values() for setting in all_settings(below.type)]
    return [*settings(section).values(), *inner]


@pytest.mark.parametrize("setting", all_settings(), ids=lambda setting: setting.name)
def test_every_setting_says_what_it_is(setting: Setting) -> None:
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
        (("species", "x", "energy", "initial"), "a number from 0 to 1000000 [energy]"),
        (("species", "x", "body", "radius"), "a number > 0 and <= 1000 [u]"),
        (("species", "x", "sensor", "scaling"), 'one of "raw", "unit"'),
        (("species", "x", "sensor", "ray_count"), "an integer from 1 to 32"),
        (
            ("food", "x", "placement", "centers"),
            "a list of [number, number] with at most 16 items, with numbers from 0 to 100000 [u]",
        ),
        (("food", "x", "color"), "a text of the form `#rrggbb`"),
    ],
)
def test_allowed_in_words(path: tuple[str, ...], text: str) -> None:
    setting = find(Config, path)
    assert isinstance(setting, Setting)
    assert setting.allowed == text


def test_find_leads_into_settings_and_to_sections() -> None:
    assert find(Config, ("arena", "inner_walls", 0, 3)) is settings(sections(Config)["arena"].type)["inner_walls"]
    assert find(Config, ("physics",)) is sections(Config)["physics"].type
    assert find(Config, ("food", "any", "placement")) is find(Config, ("food", "other", "placement"))
    assert find(Config, ("enrgy",)) is None
    assert find(Config, (0,)) is None
