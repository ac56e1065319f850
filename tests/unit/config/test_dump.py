import dataclasses
import tomllib
from pathlib import Path
from typing import Any, cast

import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st

from hedon.config import FIDELITIES, PRESETS, ConfigError, diff, digest, dump_toml, load_config
from hedon.config import field as doc
from hedon.config.config import Config
from hedon.config.dump import LATER, flatten, section_paths
from hedon.config.load import parse_config
from hedon.config.schema.evolution import GeneConfig, MutationConfig, PayConfig
from hedon.config.schema.schedule import ScheduleConfig
from hedon.config.schema.settings import changes_worlds
from hedon.config.schema.species import SpeciesConfig
from hedon.error import ArgumentError


def reload(config: Config, folder: Path) -> Config:
    path = folder / "dumped.toml"
    path.write_text(dump_toml(config), encoding="utf-8")
    return load_config(path)


@pytest.mark.parametrize("fidelity", FIDELITIES)
@pytest.mark.parametrize("preset", PRESETS)
def test_dump_loads_to_an_equal_config(preset: str, fidelity: str, tmp_path: Path) -> None:
    config = load_config(preset, fidelity)
    again = reload(config, tmp_path)
    assert again == config
    assert list(again.food) == list(config.food)
    assert digest(again) == digest(config)


def test_dump_keeps_order_and_removal_of_kinds(tmp_path: Path) -> None:
    config = load_config("poor", overrides=["food.normal=false", "food.a.gives.energy=2", 'name="beetle_x"'])
    again = reload(config, tmp_path)
    assert list(again.food) == ["poor", "a"]
    assert again == config


def test_dump_holds_every_setting_with_its_meaning() -> None:
    config = load_config("poison")
    text = dump_toml(config)
    for path, value in flatten(config).items():
        name = path.split(".")[2 if path.startswith("food.") and ".gives." in path else -1]
        assert f"\n{name} = " in text, path
        assert value is not None
    assert "growth_rate = 0.2  # growth of the supply [food/step]" in text
    assert text.startswith("# Complete")


def test_dump_of_a_section() -> None:
    config = load_config("poison")
    text = dump_toml(config, "food.poison")
    assert list(tomllib.loads(text)["food"]) == ["poison"]
    assert "[food.poison.placement]" in text
    assert list(tomllib.loads(dump_toml(config, "food"))["food"]) == ["normal", "poison"]
    some = ["measure.peak.of='max(alive)'", "store.water.capacity=3", "neighbor.near={}", 'reward.rule="my.py:pay"']
    config = load_config("poison", overrides=some)
    for path in section_paths(config):
        assert dump_toml(config, path).startswith("[")
    assert dump_toml(config, "energy") == dump_toml(config, "species.agent.energy")
    assert dump_toml(load_config("predator"), "energy").count("basic_cost") == 2
    for path in ("", "fod", "energy.initial"):
        with pytest.raises(KeyError):
            dump_toml(config, path)


def number(setting: doc.Setting) -> st.SearchStrategy[Any]:
    limits, least = setting.doc.range, setting.doc.range.ge
    if setting.type is int:
        assert least is not None
        assert limits.le is not None
        return st.integers(int(least), int(limits.le))
    low = limits.gt if least is None else least
    high = limits.lt if limits.le is None else limits.le
    floats = st.floats(low, high, exclude_min=limits.gt is not None, exclude_max=limits.lt is not None)
    return floats.map(lambda value: value + 0.0)  # The digest distinguishes -0.0 from 0.0, which are equal.


NUMBERS = [
    (f"{place}.{setting.name}", setting)
    for place, section in [
        *((n, s.type) for n, s in {**doc.sections(Config), **doc.sections(SpeciesConfig)}.items() if not s.repeated)
    ]
    for setting in doc.settings(section).values()
    if setting.type in (int, float)
]


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_any_override_survives_dump_and_load(data: st.DataObject, tmp_path_factory: pytest.TempPathFactory) -> None:
    path, setting = data.draw(st.sampled_from(NUMBERS))
    value = data.draw(number(setting))
    try:
        config = load_config("baseline", overrides=[f"{path}={value!r}"])
    except ConfigError:
        reject()  # In range, but in conflict with another setting.
    assert flatten(config)[path] == value
    assert reload(config, tmp_path_factory.getbasetemp()) == config
    changed = value != setting.default
    assert diff(load_config("baseline"), config) == ([(path, setting.default, value)] if changed else [])
    assert (digest(config) != digest(load_config("baseline"))) is changed


def test_digest_ignores_names_and_colors_but_not_the_order_of_kinds() -> None:
    config = load_config("poor")
    renamed = dataclasses.replace(config, name="x", preset="y", fidelity="as_printed")
    assert digest(renamed) == digest(config)
    assert digest(load_config("poor", overrides=["food.poor.color=#000000"])) == digest(config)
    backwards = dataclasses.replace(config, food=dict(reversed(config.food.items())))
    assert digest(backwards) != digest(config), "the order of the kinds is the order of the channels"
    assert diff(config, backwards) == [("food", ("normal", "poor"), ("poor", "normal"))]
    assert len(digest(config)) == 64


RICH = (
    "genome.learning.gamma={}",
    "genome.family.threshold={}",
    "genome.extra.kindness={}",
    "genome.set.store.water.basic_cost={}",
    "neighbor.near={}",
    'reward.rule="my.py:pay"',
    'genome.mutation.w_action={law="normal"}',
    "hazard.schedule.scale={points=[[0, 1.0], [5, 2.0]]}",
    "obstacle.schedule.harmful={points=[[0, 1.0], [5, 0.0]]}",
    "food.normal.schedule.capacity={points=[[0, 1.0], [5, 0.5]]}",
    'reward.family="above"',
    'sensor.smells=["normal"]',
    "species.prey.reward.pay.see_normal={}",
    "reward.pay.moved={}",
    "sensor.observes.age=100",
    "reward.drive_reduction_coef=1",
    "store.water={capacity=3, basic_cost=0.1}",
    "food.normal.gives.water=1",
    "food.normal.needs.water=1",
    "genome.action={initial_mean=1.0, initial_sd=0.2}",
)
"""Overrides that give a config an entry in each of its tables."""


def rich() -> Config:
    """Two species with an entry in each table."""
    return load_config("predator", overrides=RICH)


def put(section: Any, path: list[str], value: Any) -> Any:
    """A copy of a section with another value at a path below it."""
    name, *below = path
    if isinstance(section, dict):  # its names may contain dots
        name = next((each for each in section if path[: each.count(".") + 1] == each.split(".")), name)
        below = path[name.count(".") + 1 :]
    inner = section.get(name) if isinstance(section, dict) else getattr(section, name)
    new = put(inner, below, value) if below else value
    return section | {name: new} if isinstance(section, dict) else dataclasses.replace(section, **{name: new})


def others(value: Any, setting: doc.Setting) -> list[Any]:
    """Values that differ from a setting's value."""
    if isinstance(value, bool):
        return [not value]
    if setting.choices:
        return [choice for choice in setting.choices if choice != value]
    if isinstance(value, int | float):
        return [value + 1, value * 2 + 3]
    return [value + "x", value + "y"] if isinstance(value, str) else [(*value, 7), (*value, 8)]


@pytest.mark.parametrize("config", [load_config("poison"), load_config("predator"), load_config("pitfall"), rich()])
def test_no_two_configs_share_a_digest(config: Config) -> None:
    found = {digest(config): "none"}
    for path, setting, value in doc.leaves(config):
        if not changes_worlds(path) or path.endswith(".color"):
            continue
        for other in others(value, setting):
            changed = put(config, path.split("."), other)
            # A change to one species could be taken for the same change to another, so all are compared with all.
            assert digest(changed) not in found, (path, other, found[digest(changed)])
            found[digest(changed)] = f"{path} = {other}"
    assert len(found) > 290


tables = {
    "reward": st.builds(
        lambda pay: {"pay": pay},
        st.dictionaries(st.sampled_from(["see_prey", "see_predator", "moved"]), st.builds(PayConfig)),
    ),
    "genome": st.builds(
        lambda learning, mutation: {"learning": learning, "mutation": mutation},
        st.dictionaries(st.sampled_from(["gamma", "action_sd"]), st.builds(GeneConfig)),
        st.dictionaries(st.just("w_action"), st.builds(MutationConfig)),
    ),
    "hazard": st.sampled_from([{"schedule": {}}, {"schedule": {"scale": ScheduleConfig(points=((0, 1.0), (9, 2.0)))}}]),
}


@settings(max_examples=60, deadline=None)
@given(own=st.fixed_dictionaries({name: st.fixed_dictionaries(tables) for name in ("prey", "predator")}))
def test_a_reloaded_species_has_only_the_tables_it_was_written_with(own: dict[str, Any]) -> None:
    config = load_config("predator", overrides=['sensor.smells=["normal"]'])
    for name, sections in own.items():
        for section, values in sections.items():
            for table, value in values.items():
                config = put(config, ["species", name, section, table], value)
    again = parse_config(dump_toml(config), "text")
    assert again == config
    assert digest(again) == digest(config)


def test_diff_lists_absent_settings() -> None:
    rows = diff(load_config("poor"), load_config("baseline"))
    assert rows[0] == ("food", ("normal", "poor"), ("normal",))
    assert ("food.normal.capacity", 90, 100) in rows
    assert ("food.poor.gives.energy", 0.2, None) in rows


def test_an_invalid_config_or_path_is_refused():
    config = load_config("baseline")
    with pytest.raises(ArgumentError, match=r"b: must be a Config, as `load_config` gives it, not 3"):
        diff(config, cast(Any, 3))
    with pytest.raises(ArgumentError, match=r"path: must be that of a setting, such as energy\.initial, not 3"):
        config.with_(cast(Any, 3), 4)


def test_complete_files_from_before_a_setting_was_added_still_load(tmp_path):
    config = load_config("baseline")
    endings = tuple(f"{ending.removeprefix('.')} = " for ending in LATER)
    lines = dump_toml(config).splitlines()
    older = [line for line in lines if not line.startswith(endings)]
    assert len(lines) - len(older) == len(LATER)
    path = tmp_path / "older.toml"
    path.write_text("\n".join(older), encoding="utf-8")
    assert load_config(path) == config
    assert digest(config.with_("reward.drive_root", 3.0)) != digest(config)
