"""Retired names of settings and choices are refused with the names that replaced them."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from hedon.config import ConfigError, dump_toml, load_config
from hedon.config.dump import flatten
from hedon.config.field import sections, settings
from hedon.config.retired import MOVED, VALUES
from hedon.config.schema.species import SpeciesConfig
from hedon.config.schema.store import StoreConfig
from hedon.config.schema.world import WorldConfig

Write = Callable[[str], Path]


@pytest.mark.parametrize("old", MOVED)
def test_a_setting_that_moved_is_refused_with_its_new_name(write: Write, old: str) -> None:
    new = MOVED[old]
    known = {f"{place}.{name}" for place, each in sections(SpeciesConfig).items() for name in settings(each.type)}
    known |= {
        f"store.{store}.{name}"
        for store in ("nutrient", "toxin")
        for name in (*settings(StoreConfig), *sections(StoreConfig))
    }
    known |= {"energy.set_point"}
    assert old not in known
    assert new in known | {f"world.{name}" for name in settings(WorldConfig)}
    said = f"{old}: is called {new} now"
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config("baseline", overrides=[f"{old}=1"])
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config(write(f"{old} = 1\n"))
    with pytest.raises(ConfigError, match=rf"species\.prey\.{re.escape(old)}: is called .*{re.escape(new)} now"):
        load_config(write(f"species.prey.{old} = 1\n"))
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_config("baseline").with_(old, 1)


@pytest.mark.parametrize("path", VALUES)
def test_a_renamed_choice_is_refused_with_its_new_name(path: str) -> None:
    for old, new in VALUES[path].items():
        said = f'{path} = "{old}": is called "{new}" now'
        with pytest.raises(ConfigError, match=re.escape(said)):
            load_config("baseline", overrides=[f"{path}={old}"])
        rest = ["birth.network=initial"] if new == "fixed" else []
        assert flatten(load_config("baseline", overrides=[f"{path}={new}", *rest]))[path] == new


def test_paths_of_sights_are_refused_with_their_new_names() -> None:
    with pytest.raises(ConfigError, match=r"reward\.see\.normal: is called reward\.pay\.see_normal now"):
        load_config("baseline", overrides=["reward.see.normal.over_rays=max"])
    with pytest.raises(ConfigError, match=r"is called reward\.pay\.see_normal\.channel now"):
        load_config("baseline").with_("reward.see.normal.reads", "wall")


def test_another_schema_is_refused(write: Write) -> None:
    text = dump_toml(load_config("baseline"))
    for other in ('"2"', "1"):
        with pytest.raises(ConfigError, match=f'schema = {other}: must be "1"'):
            load_config(write(text.replace('schema = "1"', f"schema = {other}")))
