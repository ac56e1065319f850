"""Every setting reaches the engine, which refuses settings that it does not know."""

import re
from typing import Any

import numpy as np
import pytest

from hedon import _engine
from hedon.config import FIDELITIES, PRESETS, engine_config, load_config
from hedon.config.engine import engine_input
from hedon.error import EngineError


def flat(tree, path=""):
    """All leaves of a nested structure by path."""
    if isinstance(tree, dict):
        return {k: v for name, value in tree.items() for k, v in flat(value, f"{path}.{name}").items()}
    if isinstance(tree, list | tuple):
        return {k: v for i, value in enumerate(tree) for k, v in flat(value, f"{path}[{i}]").items()}
    return {path: tree}


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("fidelity", FIDELITIES)
def test_every_setting_arrives(preset, fidelity):
    given = engine_config(load_config(preset, fidelity))
    arrived = flat(_engine.read_config(given))
    expected = flat(given)
    assert arrived.keys() == expected.keys()
    for path, value in expected.items():
        assert arrived[path] == (float(np.float32(value)) if isinstance(value, float) else value), path


def change(tree: Any, path: str) -> Any:
    """A copy of a nested structure with 1 added to the number at a path."""
    head, _, rest = path.partition(".") if not path.startswith("[") else path[1:].partition("]")
    key = int(head) if path.startswith("[") else head
    copied: Any = dict(tree) if isinstance(tree, dict) else list(tree)
    copied[key] = change(tree[key], rest.removeprefix(".")) if rest else tree[key] + 1
    return copied


def test_changing_one_setting_changes_only_that_setting_in_the_engine():
    # Change each number in turn, to detect two fields that are swapped.
    given = engine_config(load_config("relocation"))
    before = flat(_engine.read_config(given))
    numbers = [path for path, value in before.items() if isinstance(value, int | float)]
    assert len(numbers) > 60
    for path in numbers:
        after = flat(_engine.read_config(change(given, path.removeprefix(".").replace("[", ".["))))
        assert [name for name in before if after[name] != before[name]] == [path]


@pytest.mark.parametrize(
    ("section", "name", "value", "message"),
    [
        ("physics", "dt", None, "physics.dt: missing"),
        ("physics", "dx", 1.0, "physics.dx: unknown"),
        ("learning", "critic_target", "sometimes", "species[0].learning.critic_target: unknown name 'sometimes'"),
        ("population", "capacity", "many", "species[0].population.capacity: wrong type"),
    ],
)
def test_an_invalid_setting_is_named(section, name, value, message):
    given = engine_config(load_config("baseline"))
    table = given[section] if section in given else given["species"][0][section]
    if value is None:
        del table[name]
    else:
        table[name] = value
    with pytest.raises((KeyError, ValueError, TypeError), match=re.escape(message)):
        _engine.read_config(given)


@pytest.mark.parametrize(
    ("which", "i", "index"),
    [("observed", 0, 2), ("observed", 4, 1), ("recorded", 1, 1), ("recorded", 5, 2)],
    ids=["velocity", "store", "store_before", "force"],
)
def test_the_engine_refuses_a_channel_whose_index_is_out_of_range(which, i, index):
    given = engine_input(load_config("baseline"))
    for number in (index - 1, index):
        given.settings["layout"][0][which][i]["index"] = number
        if number < index:
            assert _engine.memory_needed(given.settings, len(given.walls), 1, 1)
            continue
        with pytest.raises(EngineError, match=re.escape(f"layout[0].{which}[{i}].index = {number}: must be")):
            _engine.memory_needed(given.settings, len(given.walls), 1, 1)
