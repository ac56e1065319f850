"""Random numbers against published vectors and distributions, and elementary functions against the C library."""

import numpy as np
import pytest
from scipy import stats

from hedon._engine import random

# Known answers of Philox4x32-10 (Salmon et al. 2011, Random123): counter, key, words.
KNOWN = [
    ([0] * 4, [0] * 2, [0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8]),
    ([0xFFFFFFFF] * 4, [0xFFFFFFFF] * 2, [0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD]),
    (
        [0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344],
        [0xA4093822, 0x299F31D0],
        [0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1],
    ),
]
COUNT = 200_000


@pytest.mark.parametrize(("counter", "key", "words"), KNOWN)
def test_philox_gives_the_published_words(counter, key, words):
    assert list(random.philox(counter, key)) == words


FORMS = {"uniform": stats.uniform, "normal": stats.norm, "cauchy": stats.cauchy, "student_t": stats.t(2)}


@pytest.mark.parametrize("form", FORMS)
def test_draws_follow_their_distribution(form):
    draws = random.draw(20240722, form, COUNT)
    assert stats.kstest(draws, FORMS[form].cdf).pvalue > 1e-3
    # Neighbors in the counter are independent.
    ranks = stats.rankdata(draws) / COUNT
    assert abs(np.corrcoef(ranks[:-1], ranks[1:])[0, 1]) < 4 / np.sqrt(COUNT)


def test_seeds_give_different_draws():
    assert not np.any(random.draw(1, "uniform", 100) == random.draw(2, "uniform", 100))


def test_uniforms_stay_below_one():
    draws = random.draw(3, "uniform", COUNT)
    assert draws.min() >= 0.0
    assert draws.max() < 1.0


@pytest.mark.parametrize(
    ("name", "low", "high", "tolerance"),
    [
        ("exp", -700, 700, 1e-14),
        ("log", 1e-300, 1e300, 1.5e-14),  # the first term left out of the series: 2/17 · 0.1716^17
        ("sin", -1e4, 1e4, 1e-11),  # argument reduction loses 1e4 · 1e-16 and the last bits of the constants
        ("cos", -1e4, 1e4, 1e-11),
    ],
)
def test_elementary_functions_agree_with_the_c_library(name, low, high, tolerance):
    x = np.geomspace(low, high, 100_001) if name == "log" else np.linspace(low, high, 100_001)
    expected = getattr(np, name)(x)
    scale = np.abs(expected) if name == "exp" else np.maximum(np.abs(expected), 1.0)
    assert np.max(np.abs(getattr(random, name)(x) - expected) / scale) < tolerance


def test_the_angle_of_a_vector_agrees_with_the_c_library():
    turn = np.linspace(-np.pi, np.pi, 100_001)
    for long in (1e-30, 1.0, 1e30):
        y, x = long * np.sin(turn), long * np.cos(turn)
        assert np.max(np.abs(random.atan2(y, x) - np.arctan2(y, x))) < 2e-15
    y, x = np.array([0.0, 0.0, 1.0, -1.0]), np.array([0.0, -1.0, 0.0, 0.0])
    np.testing.assert_allclose(random.atan2(y, x), [0.0, np.pi, np.pi / 2, -np.pi / 2], rtol=1e-15)
