import dataclasses

import numpy as np
import pytest
from scipy.integrate import quad

from hedon.config.schema.life import BirthConfig, HazardConfig
from hedon.demography import life

HAZARD, BIRTH = HazardConfig(), BirthConfig()
ENERGIES = [0.0, 1.0, 10.0, 20.0, 100.0]
STEEP = HazardConfig(kappa=0.1, alpha_energy=1.0, beta_energy=0.05, alpha_age=1e-4, beta_age=1e-2)


def test_values_of_the_paper() -> None:
    assert life.hazard(HAZARD, 0, 0) == pytest.approx(1.963e-4, rel=2e-4)
    assert life.hazard(HAZARD, 0, 20) == pytest.approx(3.9e-6, rel=1e-2)
    assert life.birth_rate(BIRTH, 0) == pytest.approx(2e-4)
    assert life.birth_rate(BIRTH, 1000) == pytest.approx(4e-4)


def test_life_at_zero_energy() -> None:
    assert life.expected_lifetime(HAZARD, 0) == pytest.approx(5090, rel=1e-3)
    assert life.reproduction_number(HAZARD, BIRTH, 0) == pytest.approx(1.02, abs=5e-3)
    assert life.reproduction_number(HAZARD, BIRTH, 0, placed=0.5) == pytest.approx(0.51, abs=3e-3)


@pytest.mark.parametrize("config", [HAZARD, STEEP, dataclasses.replace(HAZARD, beta_age=0.0)])
@pytest.mark.parametrize("energy", ENERGIES)
def test_cumulative_hazard_is_the_integral_of_the_hazard(config: HazardConfig, energy: float) -> None:
    for age in (0.0, 10.0, 500.0):
        total, _ = quad(lambda t: float(life.hazard(config, t, energy)), 0, age, epsrel=1e-12)
        assert life.cumulative_hazard(config, age, energy) == pytest.approx(total, rel=1e-9)
        assert life.survival(config, age, energy) == pytest.approx(np.exp(-total), rel=1e-9)


@pytest.mark.parametrize("config", [HAZARD, STEEP, dataclasses.replace(HAZARD, alpha_energy=0.0)])
@pytest.mark.parametrize("energy", ENERGIES)
def test_the_lifetime_is_the_integral_of_survival(config: HazardConfig, energy: float) -> None:
    mean = float(life.expected_lifetime(config, energy))
    # In units of the mean, so the integrand has no scale of its own.
    whole, _ = quad(lambda x: mean * float(life.survival(config, x * mean, energy)), 0, 60, limit=500)
    assert mean == pytest.approx(whole, rel=1e-7)
    children = float(life.birth_rate(BIRTH, energy)) * whole
    assert life.reproduction_number(config, BIRTH, energy) == pytest.approx(children, rel=1e-7)


def test_sum_over_steps_is_close() -> None:
    """The simulation draws once per step with the hazard at the advanced age."""
    ages = np.arange(1, 200_000)
    alive = np.cumprod(1 - life.hazard(HAZARD, ages, 0.0))
    assert 1 + alive.sum() == pytest.approx(float(life.expected_lifetime(HAZARD, 0.0)), rel=5e-4)


def test_limits_of_the_lifetime() -> None:
    ageless = dataclasses.replace(HAZARD, alpha_age=0.0)
    flat = life.energy_hazard(ageless, ENERGIES)
    np.testing.assert_allclose(life.expected_lifetime(ageless, ENERGIES), 1 / flat)
    nearly = dataclasses.replace(HAZARD, beta_age=1e-15)
    steady = dataclasses.replace(HAZARD, beta_age=0.0)
    np.testing.assert_allclose(
        life.expected_lifetime(nearly, ENERGIES),
        life.expected_lifetime(steady, ENERGIES),
        rtol=1e-6,
    )
    immortal = dataclasses.replace(ageless, kappa=0.0)
    assert np.isinf(life.expected_lifetime(immortal, 0.0))


def test_forms_of_death_and_birth() -> None:
    aging = dataclasses.replace(HAZARD, form="gompertz", beta_age=0.0, alpha_age=1e-3)
    assert life.hazard(aging, 7.0, 0.0) == pytest.approx(1e-3)
    np.testing.assert_allclose(life.expected_lifetime(aging, ENERGIES), 1000.0)
    steady = dataclasses.replace(HAZARD, form="constant", kappa=0.02, alpha_age=0.5)
    np.testing.assert_allclose(life.hazard(steady, 1e6, ENERGIES), 0.02)
    np.testing.assert_allclose(life.expected_lifetime(steady, ENERGIES), 50.0)
    np.testing.assert_allclose(life.survival(steady, 50.0, 0.0), np.exp(-1.0))
    birth = BirthConfig(form="threshold", kappa=0.1, beta=0.5, logit_offset=10.0)
    np.testing.assert_array_equal(life.birth_rate(birth, np.array([19.9, 20.0, 300.0])), [0.0, 0.1, 0.1])


def test_shapes_follow_the_energy() -> None:
    energy = np.linspace(0, 40, 6).reshape(2, 3)
    assert life.expected_lifetime(HAZARD, energy).shape == (2, 3)
    assert life.survival(HAZARD, np.arange(5), energy[..., None]).shape == (2, 3, 5)
    assert np.all(np.diff(life.expected_lifetime(HAZARD, energy).ravel()) > 0)
