"""Argument errors in the Python API: each message names the argument, its value and what is allowed."""

from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

import hedon

CONFIG = hedon.load_config("small")


def plan(**changes) -> hedon.RunPlan:
    return hedon.RunPlan(**{"config": CONFIG, "seeds": [1], "steps": 64, "out": "x", **changes})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"seeds": ()}, "seeds: there must be from 1"),
        ({"seeds": 3}, "seeds = 3: must be a list"),
        ({"seeds": "12"}, "must be a list"),
        ({"seeds": (1, 2, 1)}, "1 appears twice"),
        ({"seeds": (-1,)}, "seeds = -1: must be a whole number from 0"),
        ({"seeds": (2**63,)}, "must be a whole number from 0"),
        ({"seeds": (1.5,)}, "must be a whole number"),
        ({"seeds": range(10**15)}, "from 1 to 10,000"),
        ({"seeds": np.zeros((2, 2), int)}, "must be a whole number"),
        ({"checkpoint_seconds": 10**400}, "must be a number"),
        ({"checkpoint_seconds": "5"}, "checkpoint_seconds = '5'"),
        ({"steps": -5}, "steps = -5: must be a whole number from 1"),
        ({"steps": True}, "steps = True"),
        ({"steps": 10**5000}, "steps = an integer of thousands of digits"),
        ({"out": ""}, "out = ''"),
        ({"out": 3}, "must be the path of a folder"),
        ({"threads": -1}, "threads = -1"),
        ({"frames": -1}, "frames = -1"),
        ({"checkpoint_seconds": float("nan")}, "checkpoint_seconds = nan"),
        ({"checkpoint_seconds": -1}, "checkpoint_seconds = -1"),
        ({"config": "small"}, "config: must be a Config"),
    ],
)
def test_a_plan_names_what_is_wrong(changes, words):
    with pytest.raises(hedon.ArgumentError) as caught:
        plan(**changes)
    assert words in str(caught.value)


def test_a_plan_accepts_equivalent_values():
    made = plan(seeds=range(1, 3), out="folder", steps=np.int64(70), threads=np.int32(1))
    assert (made.seeds, made.out, made.steps, made.threads) == ((1, 2), Path("folder"), 70, 1)
    assert type(made.steps) is int
    assert plan(seeds=np.array([4, 5])).seeds == (4, 5)


def test_paths_may_be_strings_everywhere(tmp_path):
    out = str(tmp_path / "run")
    quick = hedon.load_config("small", overrides=["world.rollout_steps=64", "learning.minibatch_size=32"])
    assert hedon.run(hedon.RunPlan(quick, [1], 70, out, 1)).status == "finished"
    assert hedon.resume(out, 100, threads=1).steps_asked == 100
    assert hedon.branch(out, str(tmp_path / "branch"), steps=120, threads=1).status == "finished"
    assert hedon.open_run(out).agents().height > 0
    assert hedon.load_config(str(tmp_path / "run" / "config.toml")) == quick


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: hedon.Simulation(cast(Any, "baseline"), [1]), "config: must be a Config"),
        (lambda: hedon.Simulation(CONFIG, [-1]), "seeds = -1"),
        (lambda: hedon.Simulation(CONFIG, [1], threads=-2), "threads = -2"),
        (lambda: hedon.Simulation(CONFIG, [1], backend=cast(Any, 3)), "backend"),
        (lambda: hedon.Simulation(CONFIG, [1], 1).run(cast(Any, 1.5)), "steps = 1.5"),
        (lambda: hedon.Simulation(CONFIG, [1], 1).run(-1), "steps = -1"),
        (lambda: hedon.run(cast(Any, CONFIG)), "plan: must be a RunPlan"),
        (lambda: hedon.load_config(cast(Any, None)), "source"),
        (lambda: hedon.load_config("small", overrides=cast(Any, [3])), "overrides"),
        (lambda: hedon.resume(cast(Any, None)), "folder"),
    ],
)
def test_other_calls_name_what_is_wrong(call, words):
    with pytest.raises(hedon.ArgumentError) as caught:
        call()
    assert words in str(caught.value)


def test_a_single_override_need_not_be_in_a_list():
    assert hedon.load_config("small", overrides="energy.initial=7").species["agent"].energy.initial == 7.0


def test_every_error_is_public_and_a_hedon_error():
    names = ("ArgumentError", "ConfigError", "EngineError", "MemoryNeedError", "RecordError")
    for name in names:
        assert issubclass(getattr(hedon, name), hedon.HedonError)
        assert name in hedon.__all__
