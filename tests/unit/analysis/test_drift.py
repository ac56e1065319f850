import dataclasses
from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from synthetic_run import write_run

from hedon.analysis.descent.genealogy import Genealogy
from hedon.analysis.descent.walk import MutationLaw, mutation_law, neutral_means
from hedon.analysis.gene.drift import WorldDrift, drift_tests, world_drift
from hedon.analysis.world.record import read_worlds
from hedon.config import load_config
from hedon.config.gene import gene_of
from hedon.record.reader import open_run
from hedon.statistic.correction import holm

LAW = MutationLaw(mean=0.0, sd=0.0, scale=0.1, limit=1e6, tabulated=False, window=10, late=False)


def law_of(fidelity: str) -> MutationLaw:
    config = load_config("baseline", fidelity)
    return mutation_law(config, gene_of(config, "neutral_1"))


def chain(parent: list[int], birth: list[int] | None = None) -> Genealogy:
    steps = np.arange(len(parent)) if birth is None else np.array(birth)
    return Genealogy(np.array(parent), steps, steps + 5, 0)


def quartile(values: np.ndarray) -> float:
    """Half the distance between the quartiles: the scale, if the values are Cauchy."""
    low, high = np.quantile(values, [0.25, 0.75])
    return 0.5 * (high - low)


def test_walks_add_up_as_cauchy_numbers_do() -> None:
    """A line of g births is Cauchy with scale g·0.1; the mean of independent lines has the scale of one line."""
    rng = np.random.default_rng(1)
    line = chain([-1, 0, 1, 2, 3, 4])
    assert quartile(neutral_means(line, np.array([5]), LAW, rng, 20_000)) == pytest.approx(0.5, rel=0.05)
    star = chain([-1, 0, 0, 0, 0])
    leaves = np.array([1, 2, 3, 4])
    assert quartile(neutral_means(star, leaves, LAW, rng, 20_000)) == pytest.approx(0.1, rel=0.05)
    # A shared mutation and each child's own: (2·X + Y + Z)/2 has scale (2 + 1 + 1)/2.
    fork = chain([-1, 0, 1, 1])
    assert quartile(neutral_means(fork, np.array([2, 3]), LAW, rng, 20_000)) == pytest.approx(0.2, rel=0.05)


def test_founders_and_the_limit() -> None:
    rng = np.random.default_rng(2)
    law = dataclasses.replace(LAW, mean=1.0, sd=0.5)
    founders = neutral_means(chain([-1, -1, -1, -1]), np.arange(4), law, rng, 20_000)
    assert founders.mean() == pytest.approx(1.0, abs=0.01)
    assert founders.std() == pytest.approx(0.25, rel=0.05)
    tight = dataclasses.replace(LAW, scale=100.0, limit=2.0)
    values = neutral_means(chain([-1, 0, 1]), np.array([2]), tight, rng, 1000)
    assert np.abs(values).max() == 2.0


def test_frozen_noise_is_shared_by_births_of_equal_number() -> None:
    """Two births in a row, each the first of its window, get the same noise, so the scale doubles."""
    rng = np.random.default_rng(3)
    frozen = dataclasses.replace(LAW, tabulated=True, late=True)
    tree = chain([-1, 0, 1], [0, 5, 15])
    values = neutral_means(tree, np.array([1, 2]), frozen, rng, 20_000)
    assert quartile(values) == pytest.approx(0.15, rel=0.05)  # (X + 2·X)/2
    # Steps far beyond the limit leave only signs: equal noise gives equal signs, noise of another number often not.
    signs = dataclasses.replace(frozen, scale=1e6, limit=1.0)
    for second_birth, equal in ((15, 1.0), (6, 0.5)):
        values = neutral_means(chain([-1, 0, 1], [0, 5, second_birth]), np.array([1, 2]), signs, rng, 4000)
        assert np.mean(np.abs(values) > 0.5) == pytest.approx(equal, abs=0.03)
    assert law_of("released").tabulated
    assert law_of("corrected") == MutationLaw(0.0, 0.1, 0.02, 10.0, False, 1024, False)


@pytest.mark.long
def test_neutral_genes_are_called_selected_as_often_as_promised(tmp_path: Path) -> None:
    """Type I error on whole records: 6 neutral genes in each of 60 worlds without selection."""
    rng = np.random.default_rng(4)
    options = {"intervals": 30, "worlds": 60, "neutral_count": 6, "selection": 0.0, "capacity": 60}
    worlds = read_worlds([open_run(write_run(tmp_path / "run", snapshot=False, **options))])
    scores = np.array([[r.score for r in world_drift(world, rng, 500)] for world in worlds])
    p = 2 * stats.norm.sf(np.abs(scores))
    # 480 p-values, not independent within a world: bounds of 2.5 % to 8.5 % are about 3 standard errors.
    assert 0.025 < np.mean(p < 0.05) < 0.085
    # Genes of one world share its pedigree, but a column has one gene per world, so it is an independent sample.
    assert min(stats.kstest(stats.norm.cdf(column), "uniform").pvalue for column in scores.T) > 1e-3


def test_selection_is_found(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    options = {"intervals": 120, "worlds": 5, "selection": 2.0}
    worlds = read_worlds([open_run(write_run(tmp_path / "run", snapshot=False, **options))])
    found = {
        (t.weight, t.test): t
        for t in drift_tests(
            [world_drift(w, rng) for w in worlds],
            ("w_normal", "w_action"),
            ("neutral_1",),
            {"w_normal": ("neutral_1",)},
            rng,
        )
    }
    assert found["w_normal", "direction"].p_holm < 0.01
    assert found["w_normal", "direction"].effect > 1
    assert found["w_normal", "recorded"].effect > 0
    assert found["neutral_1", "direction"].p > 0.01
    assert np.isnan(found["neutral_1", "direction"].p_holm)
    assert found["w_action", "direction"].p_holm > 0.05


def test_two_modes_are_a_distance_without_a_direction() -> None:
    def world(score: float) -> list[WorldDrift]:
        return [WorldDrift("w", 0.0, score, -2, 0, 2, score, 1.0), WorldDrift("n", 0.0, 0.0, -2, 0, 2, 0.0, 1.0)]

    tests = drift_tests([world(s) for s in (3, -3, 2.5, -2.5)], ("w",), ("n",), {"w": ("n",)}, np.random.default_rng(1))
    direction, distance = tests[0], tests[1]
    assert direction.p == 1.0
    assert direction.drift_low < 0 < direction.drift_high
    assert distance.p == pytest.approx(stats.chi2.sf(2 * 9 + 2 * 6.25, 4))
    assert distance.low > 1  # under drift it is 1
    recorded = tests[-1]
    assert (recorded.effect, recorded.p) == (2.75, 2 / 16)


def scores(values: np.ndarray) -> list[list[WorldDrift]]:
    """One weight and no neutral gene, in one world per value."""
    return [[WorldDrift("w", 0.0, 0.0, -2, 0, 2, float(v), 1.0)] for v in values]


@pytest.mark.parametrize(("scale", "least", "most"), [(1.0, 0.02, 0.08), (0.4, 0.95, 1.0)])
def test_a_weight_that_is_held_is_found_in_the_lower_tail(scale: float, least: float, most: float) -> None:
    """With ten worlds: in 5 % of cases under drift, and nearly always if scores spread 0.4 times as far."""
    rng = np.random.default_rng(6)
    p = []
    for _ in range(500):
        tests = {t.test: t for t in drift_tests(scores(scale * rng.normal(size=10)), ("w",), (), {}, rng)}
        p.append(tests["held"].p)
        assert tests["held"].p == pytest.approx(1.0 - tests["distance"].p)
    assert least <= np.mean(np.array(p) <= 0.05) <= most


def test_the_interval_from_the_spread_of_drift_agrees_with_p() -> None:
    rng = np.random.default_rng(7)
    for shift in (0.0, 0.5, 1.0):
        direction, distance, held = drift_tests(scores(rng.normal(shift, 1, 8)), ("w",), (), {}, rng)
        assert direction.drift_high - direction.drift_low == pytest.approx(2 * 1.959964 / np.sqrt(8), rel=1e-5)
        assert (direction.p < 0.05) == (not direction.drift_low < 0 < direction.drift_high)
        assert direction.p_holm == pytest.approx(min(1.0, holm([direction.p, distance.p, held.p])[0]))
        assert np.isnan([distance.drift_low, held.drift_high]).all()


def test_without_worlds_there_is_no_test() -> None:
    tests = drift_tests([[]], ("w",), ("n",), {"w": ("n",)}, np.random.default_rng(1))
    assert all(np.isnan(test.p) and test.worlds == 0 for test in tests)
