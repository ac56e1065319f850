from pathlib import Path

import numpy as np
import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.world.regime import BETWEEN, EXTINCT, FOOD, IDLE, ROOM, interval_regime, regimes
from hedon.config import load_config
from hedon.record.reader import open_run

BASELINE = load_config("baseline")

# One window of 1024 steps with 150 alive, to which no rule applies; each case changes it.
ROW = {
    "step": 1024,
    "steps": 1024,
    "alive": 150,
    "agent_steps": 150 * 1024,
    "births": 20,
    "deaths": 20,
    "births_failed_full": 0,
    "births_failed_space": 0,
    "energy_forgiven": 0.0,
    "energy_basic": 200.0,
    "energy_action": 100.0,
    "eaten_normal": 100,
}


@pytest.mark.parametrize(
    ("changes", "regime"),
    [
        ({}, BETWEEN),
        ({"energy_forgiven": 150.0, "births_failed_space": 10}, ROOM),
        ({"energy_forgiven": 150.0, "births_failed_full": 10}, ROOM),
        ({"energy_forgiven": 150.0}, BETWEEN),  # hungry, but children find places and food is left
        ({"births_failed_space": 10}, BETWEEN),  # no places, but no hunger
        ({"eaten_normal": 190}, FOOD),  # of 204.8 that grow
        ({"eaten_normal": 190, "births_failed_space": 10}, BETWEEN),
        ({"births": 1, "deaths": 1, "alive": 198, "agent_steps": 198 * 1024}, IDLE),
        ({"births": 1, "deaths": 1}, BETWEEN),  # idle, but far from full
        ({"births": 1, "deaths": 1, "births_failed_space": 30}, IDLE),  # no place left, below the capacity
        ({"alive": 0}, EXTINCT),
    ],
)
def test_each_rule(changes: dict, regime: str) -> None:
    assert interval_regime(pl.DataFrame([ROW | changes]), BASELINE, "agent")["regime"] == regime


def test_the_rates() -> None:
    rows = pl.DataFrame([ROW | {"births_failed_space": 5, "energy_forgiven": 30.0}])
    found = interval_regime(rows, BASELINE, "agent")
    assert (found["hunger"], found["refusal"], found["crowding"]) == (0.1, 0.2, 0.75)
    assert found["uptake"] == pytest.approx(100 / 204.8)
    assert found["turnover"] == pytest.approx(20 / (150 * 1024 * 1.963e-4), rel=1e-3)


def test_poison_is_no_supply() -> None:
    config = load_config("poison")
    row = ROW | {"eaten_poison": 1000}
    assert interval_regime(pl.DataFrame([row]), config, "agent")["uptake"] == pytest.approx(100 / 204.8)


def test_undefined_rates_name_no_regime() -> None:
    nothing = {"births": 0, "deaths": 0, "energy_basic": 0.0, "energy_action": 0.0}
    config = load_config("baseline", overrides=["food.normal.growth_rate=0.0"])
    found = interval_regime(pl.DataFrame([ROW | nothing]), config, "agent")
    assert found["regime"] == BETWEEN
    assert np.isnan([found["hunger"], found["refusal"], found["uptake"]]).all()


def test_over_time(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", worlds=2, intervals=60, extinct=1, snapshot=False))
    population = run.population()
    found = regimes(population.filter(pl.col("world") == 0), BASELINE, intervals=7)
    assert [r["step"] for r in found] == sorted({r["step"] for r in found})
    assert found[-1]["step"] == 60 * 1024
    assert sum(r["steps"] for r in found) == 60 * 1024
    assert regimes(population.filter(pl.col("world") == 1), BASELINE)[-1]["regime"] == EXTINCT
    assert regimes(population.head(0), BASELINE) == []
    assert len(regimes(population.head(3), BASELINE)) == 3


def test_a_partial_window_is_not_a_separate_interval() -> None:
    part = {"step": 3 * 1024 + 16, "steps": 16, "agent_steps": 150 * 16, "births": 0, "deaths": 0, "eaten_normal": 3}
    rows = [ROW | {"step": 1024 * i} for i in (1, 2, 3)]
    found = regimes(pl.DataFrame([*rows, ROW | part]), BASELINE)
    assert [(r["step"], r["steps"], r["regime"]) for r in found] == [
        (1024, 1024, BETWEEN),
        (2048, 1024, BETWEEN),
        (3088, 1040, BETWEEN),
    ]
    dies_out = regimes(pl.DataFrame([*rows, ROW | part | {"alive": 0}]), BASELINE)
    assert [(r["steps"], r["regime"]) for r in dies_out[2:]] == [(1024, BETWEEN), (16, EXTINCT)]
    assert [r["steps"] for r in regimes(pl.DataFrame([ROW | part]), BASELINE)] == [16]
