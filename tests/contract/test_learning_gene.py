"""Genes that set learning parameters, compared with worlds whose config sets the same values."""

import math

import numpy as np
import pytest
from ppo_reference import split
from worlds import CHILDLESS, DEATHLESS, QUICK, RELEASED, make_simulation

from hedon.experiment.simulation import Simulation

ALIKE = (*QUICK, *DEATHLESS, *CHILDLESS)


def gene(name: str, value: float) -> tuple[str, str]:
    return f"genome.learning.{name}.initial_mean={value}", f"genome.learning.{name}.initial_sd=0"


def learned(*settings: str) -> np.ndarray:
    """Parameters of all networks after one window."""
    simulation = make_simulation(*ALIKE, *settings)
    simulation.run(64)
    world = simulation.worlds[0]
    return np.array(world.view("params")[world.living])


@pytest.mark.parametrize(
    ("name", "configured", "doubled"),
    [
        ("learning_rate", 3e-4, 6e-4),
        ("entropy_coef", 0.01, 0.02),
        ("gamma", 0.9, 18 / 19),
    ],
)
def test_a_gene_does_what_the_setting_does(name, configured, doubled):
    plain = learned(f"learning.{name}={configured}")
    by_gene = learned(f"learning.{name}={configured}", *gene(name, math.log10(2)))
    by_setting = learned(f"learning.{name}={doubled}")
    assert by_gene == pytest.approx(by_setting, abs=1e-6)
    assert np.abs(by_gene - plain).max() > 1e-5


def log_sd(simulation: Simulation) -> np.ndarray:
    world = simulation.worlds[0]
    inputs = world.observations().shape[1]
    return np.array([split(params, inputs)["log_sd"] for params in world.view("params")[world.living]])


@pytest.mark.parametrize("inheritance", [(), RELEASED])
def test_newborns_have_the_action_sd_of_their_own_gene(inheritance):
    """From birth or, if genomes are drawn at the end of a window, from then on."""
    simulation = make_simulation(
        *QUICK,
        *DEATHLESS,
        *inheritance,
        "learning.update_epochs=0",
        "genome.learning.action_sd.initial_sd=0.5",
        "birth.kappa=0.02",
        "birth.beta=100",
        "world.parents=all",
    )
    simulation.run(64)
    world = simulation.worlds[0]
    assert world.counters["births"] > 10
    number = simulation.config.species["agent"].genome.neutral_count + 1
    own = world.agents()["genome"][:, -number].astype(np.float64)
    assert np.ptp(own) > 0.5
    spread = log_sd(simulation)
    assert spread == pytest.approx(np.column_stack([own, own]) * math.log(10), abs=1e-5)
