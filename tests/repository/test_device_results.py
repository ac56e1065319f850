"""The numbers on the page about the device match the committed trial."""

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


def test_kernels_that_were_tried_and_the_clocks_of_a_step():
    kept = json.loads((ROOT / "benchmarks" / "h100-variants.json").read_text(encoding="utf-8"))
    for row in kept["variants"]:
        if row["worlds"] == 256 or "predator" in row["change"]:
            assert f"{round(row['world_steps_per_second'], -2):,}" in PAGE, row
    clocks = kept["clocks_of_a_step"]
    for part, digits in (("sense_and_act", -4), ("islands", -3), ("neighbor_list", -3), ("ledger", -3)):
        assert f"| {round(clocks[part], digits):,} |" in PAGE
    others = sum(clocks[part] for part in ("commit", "check_and_eat", "rewards_costs_fates", "rules", "grow", "scene"))
    assert f"| {round(others, -4):,} |" in PAGE


def test_updates_of_the_yardstick():
    lines = (ROOT / "benchmarks" / "h100-population.jsonl").read_text(encoding="utf-8").splitlines()
    for row in map(json.loads, lines):
        assert f"{row['updates_per_second']:,.0f}" in PAGE
        assert f"{row['learners']:,}" in PAGE
