"""The entry to the engine: any config built in Python is either refused by name or simulated, without a crash.

HEDON_DOOR=N tries N random configs instead of the default number.
"""

import copy
import dataclasses
import os
import random
import re
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import pytest

import hedon
from hedon import _engine
from hedon.config.config import Config
from hedon.config.engine import engine_input, engine_paths
from hedon.config.field import leaves
from hedon.config.load import PRESETS
from hedon.error import EngineError

TRIALS = int(os.environ.get("HEDON_DOOR", "400"))
SECONDS = 20.0
"""Time limit of a trial: anything longer is a hang, since each runs only a few steps [s]."""


def changed(config: Any, path: str, value: Any) -> Any:
    """A config, or part of one, with one setting replaced without checks, as `dataclasses.replace` does."""
    name, _, rest = path.partition(".")
    if isinstance(config, dict):
        return {**config, name: changed(config[name], rest, value) if rest else value}
    return dataclasses.replace(config, **{name: changed(getattr(config, name), rest, value) if rest else value})


REPORTED = [
    ("population.initial_count", 1000),
    ("population.capacity", -5),
    ("learning.minibatch_size", 0),
    ("learning.minibatch_size", 63),
    ("learning.minibatch_size", 48),
    ("world.rollout_steps", 0),
    ("world.rollout_steps", -64),
    ("sensor.touch_sectors", 1000),
    ("sensor.touch_sectors", -1),
    ("sensor.ray_count", 33),
    ("sensor.ray_length", float("nan")),
    ("body.radius", -1),
    ("food.normal.initial_count", 100_000),
    ("food.normal.capacity", -1),
    ("food.normal.placement.form", "gaussian"),
]


@pytest.mark.parametrize(("path", "value"), REPORTED)
def test_impossible_values_are_refused_by_name(path, value):
    shared = path.startswith(("food.", "world."))
    config = changed(hedon.load_config("baseline"), path if shared else f"species.agent.{path}", value)
    place = "food.normal" if path.startswith("food") else path
    with pytest.raises(hedon.ConfigError, match=place.replace(".", r"\.")):
        hedon.Simulation(config, [1])


@pytest.mark.parametrize(("path", "value"), REPORTED)
def test_the_engine_itself_refuses_them_too(path, value):
    native = engine_input(hedon.load_config("baseline"))
    table: Any = native.settings
    shared = path.startswith(("food.", "world."))
    within = path.replace("food.normal", "food.0") if shared else f"species.0.{path}"
    *names, last = within.split(".")
    for name in names:
        table = table[int(name) if name.isdigit() else name]
    table[last] = value
    with pytest.raises(EngineError, match=r"must be"):
        _engine.Simulation(native.settings, native.walls, native.outer_walls, [1])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"seeds": []}, "seeds"),
        ({"threads": 5000}, "threads"),
        ({"outer_walls": 2}, "outer_walls"),
        ({"outer_walls": 10**6}, "outer_walls"),
        ({"slot_order": [0] * 200}, "slot_order"),
        ({"slot_order": [1, 0]}, "slot_order"),
        ({"walls": [[0.0, 0.0, float("nan"), 1.0]] * 4}, "walls"),
        ({"walls": [[0.0, 0.0, 0.0, 0.0]] * 4}, "walls"),
    ],
)
def test_arguments_other_than_the_config_are_checked(arguments, words):
    import numpy as np

    native = engine_input(hedon.load_config("baseline"))
    given = {"walls": native.walls, "outer_walls": native.outer_walls, "seeds": [1], **arguments}
    given["walls"] = np.asarray(given["walls"], np.float32)
    with pytest.raises(EngineError, match=words):
        _engine.Simulation(native.settings, **given)


def test_the_engine_takes_whatever_the_settings_allow():
    """Its own limits are never narrower than the documented ones."""
    base, taken, left_out = hedon.load_config("poison"), 0, 0
    for path, setting, _ in leaves(base):
        for bound in (setting.doc.range.ge, setting.doc.range.le):
            if bound is None or setting.type not in (int, float):
                continue
            try:
                given = engine_input(changed(base, path, setting.type(bound)))
            except hedon.ConfigError:
                left_out += 1  # it contradicts another setting
                continue
            _engine.memory_needed(given.settings, len(given.walls), 1, 1)
            taken += 1
    assert taken > 4 * left_out


def test_the_engine_refuses_every_number_that_the_settings_refuse():
    """It has the same limits, and its error gives the path."""
    base = hedon.load_config("poison")
    native, places, refused = engine_input(base), engine_paths(base), 0
    for path, setting, _ in leaves(base):
        limits = setting.doc.range
        if setting.type not in (int, float) or path not in places or path.endswith("_force"):
            continue  # the engine takes forces in the units of a body
        at = places[path][0]
        low, high = (limits.ge if limits.gt is None else limits.gt), limits.le or limits.lt
        assert low is not None
        assert high is not None
        for wrong in (low - 1, high + max(1, high / 1e6)):
            table = changed_at(native.settings, at, setting.type(wrong))
            with pytest.raises(EngineError, match=f"^{re.escape(at)} = .*: must be "):
                _engine.memory_needed(table, len(native.walls), 1, 1)
            refused += 1
    assert refused > 150


def changed_at(tree: Any, path: str, value: Any) -> Any:
    """A copy of nested dicts and lists with a new value at an engine path, such as `food[0].energy`."""
    copied = copy.deepcopy(tree)
    *names, last = re.findall(r"\w+", path)
    inner: Any = copied
    for name in names:
        inner = inner[int(name) if isinstance(inner, list) else name]
    inner[int(last) if isinstance(inner, list) else last] = value
    return copied


NASTY = [-1, 0, 1, 2, 3, 7, 16, 33, 48, 63, 64, 200, 1000, 2**31 - 1, 2**31, -(2**31), 2**63, 10**30]
NASTY_FLOATS = [0.0, -0.0, -1.0, 1.0, 0.5, 2.5, 1e-45, 1e-30, 1e5, 1e30, 1e300, float("inf"), float("nan")]
ODD = [None, "x", "", "death", True, (), (1.0, 2.0), ((1.0, 2.0),), {}, [], b"x", 1 + 2j, object()]


def random_config(seed: int) -> Config:
    """A preset with one to three settings replaced by arbitrary values, small enough to simulate."""
    draw = random.Random(seed)
    config = hedon.load_config(
        draw.choice(PRESETS),
        overrides=["world.rollout_steps=16", "learning.minibatch_size=8", "learning.update_epochs=1"],
    )
    paths = [path for path, _, _ in leaves(config)]
    for _ in range(draw.randint(1, 3)):
        config = changed(config, draw.choice(paths), draw.choice([*NASTY, *NASTY_FLOATS, *draw.sample(ODD, 3)]))
    return config


TRIAL = """
    import signal, sys
    import hedon
    from contract.test_door import random_config, SECONDS

    lived = 0
    for seed in range(int(sys.argv[1]), int(sys.argv[2])):
        print(seed, flush=True)
        signal.alarm(int(SECONDS))  # ends the process, and so the test
        config = random_config(seed)
        try:
            memory = sum(hedon.experiment.memory.memory_needed(config, 1, 1).values())
            species = config.species.values()
            if memory > 2e9 or config.physics.substeps * sum(each.population.initial_count for each in species) > 5000:
                continue
            simulation = hedon.Simulation(config, [1], 1)
            simulation.run(3)
            lived += 1
            if config.world.rollout_steps * max(each.learning.update_epochs for each in species) <= 1000:
                simulation.run(30)
        except hedon.HedonError as error:
            assert str(error).strip()
    print(lived, "done", flush=True)
"""


@pytest.mark.repeated
def test_random_configs_are_refused_by_name_or_simulated():
    """In a separate process, so that a crash or a hang there fails the test here and identifies the config."""
    tests = Path(__file__).parents[1]
    code = "import hedon.experiment.memory\n" + textwrap.dedent(TRIAL)
    done = subprocess.run(
        [sys.executable, "-c", code, "0", str(TRIALS)],
        cwd=tests,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(tests)},
    )
    last = done.stdout.split()[-1] if done.stdout else ""
    assert (done.returncode, last) == (0, "done"), f"config {last}: {done.stderr[-2000:]}"
    assert int(done.stdout.split()[-2]) > 0.05 * TRIALS, "too few configs were simulated"
