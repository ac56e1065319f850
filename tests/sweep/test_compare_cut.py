"""Worlds cut to the length of shorter ones are compared as if their records ended there."""

import json

import pytest
from command import hedon
from worlds import QUICK

from hedon import RunPlan, load_config, run
from hedon.analysis.world.record import read_worlds
from hedon.record.reader import open_run


@pytest.mark.parametrize(
    ("preset", "settings"),
    [("predator", ()), ("baseline", ('birth.mating="pairs"', "birth.kappa=0.01")), ("baseline", ("hazard.kappa=0.1",))],
)
def test_a_longer_run_of_the_same_worlds_does_not_differ_where_it_is_cut(preset, settings, tmp_path):
    """What is known about a world at a step does not depend on later records."""
    config = load_config(preset, overrides=[*QUICK, *settings])
    for name, steps in (("short", 256), ("long", 512)):
        run(RunPlan(config, seeds=(1, 2), steps=steps, out=tmp_path / name))
    answer = hedon("compare", tmp_path / "short", tmp_path / "long", "--out", tmp_path / "answer")
    assert answer.returncode == 0, answer.stderr
    rows = json.loads((tmp_path / "answer" / "compare.json").read_text())["tables"]["contrast"]["rows"]
    means = [row for row in rows if row["measure"].startswith("mean of w_")]
    assert len(means) == (8 if preset == "predator" else 2)
    assert all(row["worlds"] == 2 for row in means)
    assert {row["difference"] for row in rows if row["worlds"]} == {0.0}
    long, short = (read_worlds([open_run(tmp_path / name)]) for name in ("long", "short"))
    for cut, whole in zip((world.until(256) for world in long), short, strict=True):
        known = ["agent_id", *{"species", "mate_id", "parent_id", "birth_step"} & set(whole.agents.columns)]
        assert cut.agents.select(known).sort("agent_id").equals(whole.agents.select(known).sort("agent_id"))
