"""Every setting arrives in the engine, and nothing that it does not know."""

from copy import deepcopy

import numpy as np
import pytest

from hedon import _engine
from hedon.config import FIDELITIES, PRESETS, engine_config, load_config


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


def test_a_changed_setting_changes_what_arrives():
    # Each number in turn, so that no two fields can be mixed up.
    given = engine_config(load_config("relocation"))
    paths = [path for path, value in flat(given).items() if isinstance(value, int | float)]
    assert len(paths) > 60
    for path in paths:
        changed = deepcopy(given)
        node, keys = changed, path.replace("[", ".[").strip(".").split(".")
        for key in keys[:-1]:
            node = node[int(key[1:-1])] if key.startswith("[") else node[key]
        last = int(keys[-1][1:-1]) if keys[-1].startswith("[") else keys[-1]
        if isinstance(node, tuple):
            continue
        node[last] += 1
        differing = [p for p, value in flat(_engine.read_config(changed)).items() if value != flat_base(given)[p]]
        assert differing == [path]


def flat_base(given):
    return flat(_engine.read_config(given))


@pytest.mark.parametrize(
    ("section", "name", "value", "message"),
    [
        ("physics", "dt", None, "physics.dt: missing"),
        ("physics", "dx", 1.0, "physics.dx: unknown"),
        ("learning", "critic_target", "sometimes", "learning.critic_target: unknown name 'sometimes'"),
        ("population", "capacity", "many", "population.capacity: wrong type"),
    ],
)
def test_what_does_not_fit_is_named(section, name, value, message):
    given = engine_config(load_config("baseline"))
    if value is None:
        del given[section][name]
    else:
        given[section][name] = value
    with pytest.raises((KeyError, ValueError, TypeError), match=message.replace(".", r"\.")):
        _engine.read_config(given)
