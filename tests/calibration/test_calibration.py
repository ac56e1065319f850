"""Every number behind a claim holds its nominal level, and has a calibration that shows it."""

import os

import numpy as np
import pytest

from calibrations.calibration import Calibration, Level, holds, observe
from calibrations.page import PAGE, page, read_levels
from calibrations.registry import all_calibrations

SIMULATIONS = int(os.environ.get("HEDON_CALIBRATIONS", "100"))
COMMITTED = 1000
"""Minimum number of simulations behind a committed level."""
ENTRIES = all_calibrations()


@pytest.mark.repeated
@pytest.mark.parametrize("key", ENTRIES)
def test_a_number_holds_its_level(key):
    entry = ENTRIES[key]
    level = observe(entry, SIMULATIONS)
    assert holds(entry, level), f"{entry.kind}: {level.observed:.3f} ± {level.error:.3f}, nominal {entry.nominal}"


def test_each_number_has_a_committed_level_and_holds_it():
    levels = read_levels()
    assert levels.keys() == ENTRIES.keys()
    for key, entry in ENTRIES.items():
        assert levels[key].simulations >= COMMITTED, key
        assert holds(entry, levels[key]), key


def test_the_page_shows_the_committed_levels():
    assert PAGE.read_text(encoding="utf-8") == page(ENTRIES, read_levels())


@pytest.mark.parametrize(
    ("kind", "observed", "fits"),
    [("false alarms", 0.05, True), ("false alarms", 0.2, False), ("missed", 0.001, True), ("found", 0.5, False)],
)
def test_a_level_that_is_off_does_not_hold(kind, observed, fits):
    entry = Calibration("n", ("x",), "d", kind, 0.8 if kind == "found" else 0.05, lambda rng: None)
    assert holds(entry, Level(1000, 1000, observed, 0.01)) is fits


def test_neither_a_bias_nor_a_number_without_answers_holds():
    entry = Calibration("n", ("x",), "d", "bias", 0.0, lambda rng: float(rng.normal(0.5, 0.1)))
    assert not holds(entry, observe(entry, 50))
    assert not holds(entry, observe(Calibration("n", ("x",), "d", "missed", 0.05, lambda rng: None), 5))


def test_the_same_calibration_draws_the_same_data():
    entry = Calibration("n", ("x",), "d", "missed", 0.05, lambda rng: bool(rng.random() < 0.5))
    assert observe(entry, 30) == observe(entry, 30)
    assert not np.isnan(observe(entry, 30).observed)
