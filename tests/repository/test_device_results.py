"""The figures of a device on its page are those of the trial that is kept."""

import json

import pytest
from project_files import ROOT

TRIAL = json.loads((ROOT / "benchmarks" / "h100-trial.json").read_text(encoding="utf-8"))
PAGE = (ROOT / "docs" / "gpu.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("worlds", ["1", "16", "64", "128", "256", "512"])
def test_times_by_number_of_worlds(worlds):
    row = TRIAL["times"][worlds]
    kernels = " | ".join(f"{row[f'{name}_seconds']:.3f}" for name in ("step", "learn", "copying"))
    shown = f"| {worlds} | {row['world_steps_per_second']:,} | {kernels} | {row['making_seconds']:.1f} |"
    assert shown in PAGE


def test_bits_were_equal():
    for name in ("same_first_steps", "same_one_window"):
        assert all(found["equal"] == found["worlds"] == 2 for found in TRIAL[name].values())
    assert TRIAL["repeat"] == {"steps": 1025, "repeated": True, "among_16": True}
    assert TRIAL["resume"]["equal"]


def test_updates_of_the_yardstick():
    lines = (ROOT / "benchmarks" / "h100-population.jsonl").read_text(encoding="utf-8").splitlines()
    for row in map(json.loads, lines):
        assert f"{row['updates_per_second']:,.0f}" in PAGE
        assert f"{row['learners']:,}" in PAGE
