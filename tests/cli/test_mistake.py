"""Typing errors, empty values and misplaced settings get one helpful message."""

import os
import subprocess

import polars as pl
import pytest
from command import hedon

from hedon.compare.contrast import choose_levels
from hedon.compare.error import CompareError


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("run", "clumped.tml"), "did you mean clumped.toml?"),
        (("run", "baselin"), "did you mean baseline?"),
        (("run", "energy.toml"), "store.energy: is every species' own store: set it in the section energy"),
        (("run", "baseline", "--out", ""), "--out: is empty"),
        (("run", "baseline", "--out="), "--out: is empty"),
        (("run", "baseline", "--set=reward.rule="), "reward.rule"),
        (("report", "clone"), "clone is not a run folder: it has no manifest.json"),
    ],
)
def test_a_mistake_is_named(tmp_path, words, message):
    (tmp_path / "clumped.toml").write_text("")
    (tmp_path / "energy.toml").write_text("[store.energy]\ncapacity = 5.0\n")
    (tmp_path / "clone").mkdir()
    (tmp_path / "clone" / "link").symlink_to(tmp_path)
    before = sorted(tmp_path.iterdir())
    answer = hedon(*words, cwd=tmp_path)
    assert answer.returncode == 2
    assert message in answer.stderr
    assert "Traceback" not in answer.stderr
    assert sorted(tmp_path.iterdir()) == before, "nothing should be written"


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("run", "--steps", "10k"), "--steps 10k: must be an integer from 1 to 2,147,483,647, such as 10000 or 10_000"),
        (("run", "--steps", "0"), "--steps 0: must be an integer from 1 to 2,147,483,647"),
        (("branch", "here", "--at", "1e4"), "--at 1e4: must be an integer, such as 10000 or 10_000"),
        (("view", "--agent", "-1"), "--agent -1: must be an integer of at least 0"),
        (("run", "--checkpoint", "often"), "--checkpoint often: must be a number of at least 0"),
        (("power", "--sd", "x"), "--sd x: must be a number"),
        (("power", "--power", "3"), "--power 3: must be a number from 0.06 to 0.999"),
        (("export", "agents", "here", "--format", "pdf"), "--format: 'pdf' is not one of 'csv', 'parquet', 'arrow'"),
    ],
)
def test_a_refused_value_gets_a_message_with_the_allowed_ones(words, message):
    answer = hedon(*words)
    assert (answer.returncode, answer.stderr) == (2, f"hedon: {message}\n")


def test_the_plotting_backend_of_the_environment_does_not_matter(tmp_path):
    command = ["hedon", "run", "baseline", "--steps", "64", "--out", str(tmp_path / "run")]
    answer = subprocess.run(
        command, env=os.environ | {"MPLBACKEND": "nonsense"}, capture_output=True, text=True, check=False
    )
    assert answer.returncode == 0, answer.stderr
    assert (tmp_path / "run" / "figures" / "world.svg").exists()


def test_values_of_a_factor_are_numbers():
    values = pl.Series([30.0, 120.0, 300.0]).to_list()
    assert choose_levels("growth", values, "30,120") == (30.0, 120.0)
    assert choose_levels("growth", values, "3e1, 120.00") == (30.0, 120.0)
    with pytest.raises(CompareError, match="there are 30"):
        choose_levels("growth", values, "30,31")


def test_values_may_contain_commas():
    labels = ["predator", "prey, alone", "prey, many"]
    assert choose_levels("condition", labels, "predator,prey, alone") == ("predator", "prey, alone")
    assert choose_levels("condition", labels, "prey, alone,prey, many") == ("prey, alone", "prey, many")
    with pytest.raises(CompareError, match="there are predator; prey, alone; prey, many"):
        choose_levels("condition", labels, "prey,predator")
