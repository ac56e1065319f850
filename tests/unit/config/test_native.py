import re
from pathlib import Path
from typing import Any

import pytest

from hedon.config import engine_config, load_config
from hedon.config.config import Config
from hedon.config.field import Setting, sections, settings
from hedon.config.native import PYTHON_ONLY, distance_sd

ENGINE = Path(__file__).parents[3] / "engine"


def engine_structs() -> dict[str, list[str]]:
    """Names of the fields of each config struct of the engine, read from its headers."""
    text = "".join(path.read_text() for path in ENGINE.glob("*/config.h"))
    lists = re.findall(r"HEDON_FIELDS\((\w+),([^)]*)\)", text)
    return {name: [field.strip() for field in fields.split(",")] for name, fields in lists}


def paths(section: type = Config, path: str = "") -> list[tuple[str, Setting]]:
    here = [(f"{path}{name}", setting) for name, setting in settings(section).items()]
    return here + [found for name, inner in sections(section).items() for found in paths(inner.type, f"{path}{name}.")]


def reach(native: dict[str, Any], path: str) -> Any:
    value: Any = native
    for name in path.split("."):
        value = value[0] if isinstance(value, list) else value
        value = value[name]
    return value


def test_names_are_those_of_the_engines_structs() -> None:
    structs = engine_structs()
    native = engine_config(load_config("poison"))
    assert list(native) == structs["WorldConfig"]
    for name, section in native.items():
        for table in section if isinstance(section, list) else [section]:
            assert list(table) == structs[f"{name.capitalize()}Config"]
    assert list(native["food"][0]["placement"]) == structs["PlacementConfig"]


@pytest.mark.parametrize(("path", "setting"), paths(), ids=lambda value: value if isinstance(value, str) else "")
def test_every_setting_arrives_or_is_listed(path: str, setting: Setting) -> None:
    native = engine_config(Config())
    if path in PYTHON_ONLY:
        with pytest.raises(KeyError):
            reach(native, path)
    elif path == "birth.distance_sd":
        assert reach(native, path) == (setting.default, setting.default)
    elif path.startswith("food.gene."):  # the engine's genome has the genes of all kinds
        assert reach(native, path.replace("food.gene.", "genome.food.")) == setting.default
    else:
        assert reach(native, path) == setting.default


def test_python_only_settings_exist() -> None:
    assert set(PYTHON_ONLY) <= {path for path, _ in paths()}


def test_food_is_a_list_in_the_order_of_the_kinds() -> None:
    native = engine_config(load_config("poison"))
    assert [food["energy"] for food in native["food"]] == [1.0, -0.6]


def test_distance_is_in_arena_units() -> None:
    assert distance_sd(load_config("small")) == (100.0, 100.0)
    assert engine_config(load_config("small", "text"))["birth"]["distance_sd"] == pytest.approx((28.8, 28.8))
    assert distance_sd(load_config("large", "text")) == pytest.approx((38.4, 38.4))
