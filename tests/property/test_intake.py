"""Forecasts of what is eaten, against worlds: laws of places, growth, arenas, bodies and costs are drawn.

The factor was chosen on other draws than these. HEDON_INTAKE=N compares N settings instead of the few of the suite.
"""

import os

import numpy as np
import pytest
from food_setting import draw_setting

from hedon.config import Config
from hedon.demography.forecast import forecast
from hedon.demography.intake import FACTOR, FORECAST_STEPS
from hedon.error import EngineError
from hedon.experiment.simulation import Simulation

FIRST = 1_000_000
"""The first seed of the settings that are compared; those below it are for development."""
SETTINGS = int(os.environ.get("HEDON_INTAKE", "4"))
WORLDS = 6
LEARNERS = 5
"""In one of so many settings agents learn, which takes ten times as long."""
SCATTER = 3.0
"""Standard errors of the mean over worlds by which it may lie beyond the factor."""


def eaten(config: Config) -> np.ndarray:
    """Foods of each kind eaten per step in worlds that can be made, (worlds, kinds)."""
    rows = []
    for seed in range(WORLDS):
        try:
            simulation = Simulation(config, seeds=[seed], threads=1)
        except EngineError as error:
            if "initial_placement" not in str(error):
                raise
            continue
        simulation.run(FORECAST_STEPS)
        rows.append(simulation.worlds[0].view("food_stock.eaten") / FORECAST_STEPS)
    return np.array(rows).reshape(len(rows), len(config.food))


@pytest.mark.repeated
@pytest.mark.parametrize("seed", range(FIRST, FIRST + SETTINGS))
def test_worlds_eat_what_is_forecast_within_its_factor(seed: int) -> None:
    config = draw_setting(seed, "ppo" if seed % LEARNERS == LEARNERS - 1 else "random")
    found, measured = forecast(config), eaten(config)
    cannot = any("cannot start" in text for text in found.warnings)
    doubtful = any("may fail to start" in text for text in found.warnings)
    assert not (cannot and len(measured) == WORLDS), "the forecast refuses what every world accepts"
    assert cannot or doubtful or len(measured), "no world can be made, and the forecast does not say so"
    if cannot or not len(measured):
        return
    for k, each in enumerate(found.intake):
        assert 0 <= each.low <= each.eaten <= each.high
        assert 0 <= each.present <= config.food[each.kind].capacity
        expected, mean = each.eaten * FORECAST_STEPS, measured[:, k].mean() * FORECAST_STEPS
        variance = max(measured[:, k].var(ddof=1) * FORECAST_STEPS**2 if len(measured) > 1 else 0.0, expected, 1.0)
        slack = SCATTER * np.sqrt(variance / len(measured))
        low, high = each.low * FORECAST_STEPS - slack, each.high * FORECAST_STEPS + slack
        text = f"{each.kind}: {mean:.1f} foods per world, forecast {expected:.1f} within {FACTOR:g}; {config.food}"
        assert low <= mean <= high, text
