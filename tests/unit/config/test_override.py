import re
from typing import Any

import pytest

from hedon import ConfigError, load_config
from hedon.config.override import parse_override
from hedon.config.problem import Problem


@pytest.mark.parametrize(
    ("text", "tables"),
    [
        ("energy.initial=20", {"energy": {"initial": 20}}),
        (" energy.initial = 2e1 ", {"energy": {"initial": 20.0}}),
        ("sensor.scaling=unit", {"sensor": {"scaling": "unit"}}),
        ('sensor.scaling="unit"', {"sensor": {"scaling": "unit"}}),
        ("food.normal.color=#aabbcc", {"food": {"normal": {"color": "#aabbcc"}}}),
        ("food.*.gives.energy=1", {"food": {"*": {"gives": {"energy": 1}}}}),
        ('food."*".gives.energy=1', {"food": {"*": {"gives": {"energy": 1}}}}),
        ("food.normal=false", {"food": {"normal": False}}),
        ("arena.inner_walls=[[1, 2, 3, 4]]", {"arena": {"inner_walls": [[1, 2, 3, 4]]}}),
        ("food.x={energy = 1, capacity = 3}", {"food": {"x": {"energy": 1, "capacity": 3}}}),
        ("name=a=b", None),
        ("energy.initial", None),
        ("=3", None),
        ("energy..initial=3", None),
        ("energy.=3", None),
        ("energy initial=3", None),
        ("name=two words", None),
        ("name=", None),
        ("energy.initial=[1", None),
        ("energy.initial=1\n[energy]", None),
    ],
)
def test_parse_override(text: str, tables: dict[str, Any] | None) -> None:
    found = parse_override(text)
    assert isinstance(found, Problem) if tables is None else found == tables


@pytest.mark.parametrize(
    "overrides", [["energy.inital=3"], ["energy.initial"], ["=3"], ["energy.initial=a b"], ["fidelity=as_printed"]]
)
def test_errors_name_the_override_but_no_command_line_option(overrides: list[str]) -> None:
    with pytest.raises(ConfigError, match=re.escape(overrides[0][:8])) as caught:
        load_config("baseline", overrides=overrides)
    assert "--set" not in str(caught.value)


@pytest.mark.parametrize(
    ("preset", "override", "near"),
    [
        ("baseline", "species.agnet.birth.kappa=0", "agent"),
        ("predator", "species.pray.population.capacity=4", "prey"),
    ],
)
def test_a_misspelled_species_does_not_replace_another(preset: str, override: str, near: str) -> None:
    with pytest.raises(ConfigError, match=rf"there is no such species; .*; did you mean {near}\?"):
        load_config(preset, overrides=[override])
    assert list(load_config("baseline", overrides=["species.guest.birth.kappa=0"]).species) == ["guest"]
