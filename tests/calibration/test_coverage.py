"""Everything that prints a p value, an interval or a verdict has a calibration."""

from typing import get_args

import pytest

from calibrations.registry import all_calibrations
from hedon.cli.assay import app
from hedon.report.topic import TOPICS
from hedon.study.claim import Comparison, OverWorlds

COVERED = {key for entry in all_calibrations().values() for key in entry.covers}
WITHOUT_CHANCE = {
    "topic:regime": "counts and classes of what was recorded",
    "verdict:setting": "the setting of a config, the same in every world",
}
"""Entries that print no number that could be wrong by chance, and why."""
PRINTED = [
    *(f"topic:{name}" for name in TOPICS),
    *(f"verdict:{name}" for name in get_args(OverWorlds)),
    *(f"verdict:order {name}" for name in get_args(Comparison)),
    *(f"rule:{name}" for name in ("mean", "count")),
    *(f"tool:{name}" for name in ("compare", "factorial", "power")),
    *(f"assay:{command.callback.__name__}" for command in app.registered_commands if command.callback),
]


@pytest.mark.parametrize("key", PRINTED)
def test_it_has_a_calibration(key):
    assert (key in COVERED) != (key in WITHOUT_CHANCE)
