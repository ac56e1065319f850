import warnings

import numpy as np

from hedon.statistic.selection import linear_selection


def test_the_gradient_is_a_multiple_regression() -> None:
    rng = np.random.default_rng(1)
    z = rng.normal(size=(500, 3)) @ np.array([[1, 0.5, 0], [0, 1, 0.3], [0, 0, 2.0]])
    fitness = rng.poisson(np.exp(0.2 * z[:, 0]))
    omega = fitness / fitness.mean()
    s, _, beta, _ = linear_selection(z, omega[:, None])[0]
    design = np.column_stack([np.ones(500), z])
    np.testing.assert_allclose(beta, np.linalg.lstsq(design, omega, rcond=None)[0][1:], rtol=1e-9)
    np.testing.assert_allclose(s, [np.cov(omega, z[:, i], ddof=0)[0, 1] for i in range(3)], rtol=1e-9)


def test_a_fitness_of_zero_for_all_raises_no_warning() -> None:
    rng = np.random.default_rng(1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isnan(linear_selection(rng.normal(size=(12, 2)), np.zeros((12, 1)))[0]).all()
