from pathlib import Path

import numpy as np
import pytest
from synthetic_run import write_run

from hedon.analysis.descent.genealogy import genealogy, living_at
from hedon.analysis.descent.walk import MutationLaw, neutral_courses
from hedon.analysis.gene.course import WorldCourse, world_course
from hedon.analysis.topic.drift import reversion_topic
from hedon.analysis.world.record import WorldRecord, by_condition, read_worlds
from hedon.record.reader import open_run
from hedon.statistic.reversion import reversion

TIMES = 61


def pulled(rng: np.random.Generator, count: int, rate: float, optimum: float = 0.0) -> np.ndarray:
    """Courses from 0 with steps of three degrees of freedom, whose tails are heavy, shape (count, TIMES)."""
    courses = np.zeros((count, TIMES))
    for i, shock in enumerate(rng.standard_t(3, (TIMES - 1, count))):
        courses[:, i + 1] = courses[:, i] + (1 - np.exp(-rate)) * (optimum - courses[:, i]) + shock
    return courses


def answers(rate: float, optimum: float, worlds: int, trials: int) -> np.ndarray:
    """p, strength with bounds and optimum with bounds of many sets of worlds, shape (7, trials)."""
    rng, found = np.random.default_rng(1), []
    for _ in range(trials):
        neutral = [pulled(rng, 150, 0.0) for _ in range(worlds)]
        one = reversion(list(pulled(rng, worlds, rate, optimum)), neutral)
        assert one is not None
        found.append(
            (one.p, one.strength, one.strength_low, one.strength_high, one.optimum, one.optimum_low, one.optimum_high)
        )
    return np.array(found).T


def covered(low: np.ndarray, value: float, high: np.ndarray) -> float:
    return float(np.mean((low <= value) & (value <= high)))


@pytest.mark.parametrize("worlds", [1, 5])
def test_brownian_motion_is_called_held_as_often_as_promised(worlds: int) -> None:
    p, strength, low, high, optimum, *_ = answers(0.0, 0.0, worlds, 120 // worlds)
    assert np.mean(p <= 0.05) <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / len(p))
    assert covered(low, 0.0, high) >= 0.95 - 3 * np.sqrt(0.05 * 0.95 / len(p))
    assert np.median(strength) < 0.01  # not biased, as the plain estimate is, by some 4 / 60
    assert np.isnan(optimum[p > 0.05]).all()


def test_a_pull_is_found_with_its_strength_and_optimum() -> None:
    """Five worlds of 60 intervals, each of which forgets a tenth of the distance: power nearly 1."""
    trials = 30
    p, strength, low, high, optimum, optimum_low, optimum_high = answers(0.1, 5.0, 5, trials)
    assert np.mean(p <= 0.05) > 0.9
    assert np.median(strength) == pytest.approx(0.1, rel=0.25)
    assert np.median(optimum) == pytest.approx(5.0, abs=1.0)
    least = 0.95 - 3 * np.sqrt(0.05 * 0.95 / trials)
    assert covered(low, 0.1, high) >= least
    assert covered(optimum_low, 5.0, optimum_high) >= least


def test_strength_and_p_do_not_depend_on_units() -> None:
    rng = np.random.default_rng(2)
    courses, neutral = pulled(rng, 3, 0.2, 2.0), [pulled(rng, 150, 0.0) for _ in range(3)]
    one, other = reversion(list(courses), neutral), reversion(list(10 * courses + 3), neutral)
    assert one is not None
    assert other is not None
    assert (other.p, other.strength) == (one.p, pytest.approx(one.strength))
    assert (other.optimum, other.optimum_high) == pytest.approx((10 * one.optimum + 3, 10 * one.optimum_high + 3))


def test_courses_without_a_change_say_nothing() -> None:
    assert reversion([np.zeros(20), np.array([0.0, 1.0])], [np.zeros((9, 20)), np.zeros((9, 2))]) is None
    assert reversion([], []) is None
    late = np.concatenate([np.zeros(19), [1.0]])  # nothing was there to be pulled back from
    assert reversion([late], [np.zeros((9, 20))]) is None
    found = reversion([np.arange(20.0) % 3], [np.stack([late] * 8 + [np.arange(20.0) % 2])])
    assert found is not None
    assert found.p == pytest.approx(2 / 10)  # one neutral gene goes back more surely; those that stand still do not


@pytest.fixture(scope="module")
def worlds(tmp_path_factory: pytest.TempPathFactory) -> list[WorldRecord]:
    folder = tmp_path_factory.mktemp("reversion") / "run"
    options = {"intervals": 40, "worlds": 8, "neutral_count": 8, "selection": 0.0, "capacity": 50}
    return read_worlds([open_run(write_run(folder, snapshot=False, **options))])


def test_courses_are_means_over_the_living(worlds: list[WorldRecord]) -> None:
    world = worlds[0]
    course = world_course(world, 1024.0, np.random.default_rng(1), walks=7)
    assert isinstance(course, WorldCourse)
    assert (course.intervals, course.neutral["w_normal"].shape) == (40, (7, 41))
    np.testing.assert_allclose(course.mean["w_normal"][1:], world.population["w_normal_mean"], rtol=1e-5, atol=1e-6)
    assert course.generations == pytest.approx(world.population["generation_mean"][-1])
    tree = genealogy(world.agents)
    still = MutationLaw(mean=0.0, sd=1.0, scale=0.0, limit=1e6, frozen=False, window=1024, late=False)
    living = [living_at(tree, step) for step in (0, 20_480)]
    walked = neutral_courses(tree, living, still, np.random.default_rng(2), 2000)
    assert walked[:, 0].std() == pytest.approx(1 / np.sqrt(50), rel=0.1)  # founders, each with a gene of its own
    assert walked[:, 1].std() > 1.5 * walked[:, 0].std()  # families were lost


def test_neutral_genes_of_a_pedigree_are_called_held_as_often_as_promised(worlds: list[WorldRecord]) -> None:
    """64 markers with Cauchy mutations: each in its own world, against walks of that world."""
    rng, p = np.random.default_rng(3), []
    for world in worlds:
        course = world_course(world, 1024.0, rng, walks=100)
        assert course is not None
        found = [reversion([course.mean[name]], [course.neutral[name]]) for name in world.neutral_names]
        p += [one.p for one in found if one is not None]
    assert len(p) == 64
    assert np.mean(np.array(p) <= 0.05) <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / 64)
    assert 0.35 < np.mean(p) < 0.65


def test_the_topic_pools_worlds_and_leaves_out_torn_ones(worlds: list[WorldRecord], tmp_path: Path) -> None:
    three = worlds[:3]
    pooled, by_world = reversion_topic(by_condition(three))
    assert pooled.rows["weight"].to_list() == list(three[0].weight_names)
    assert set(pooled.rows["worlds"]) == {3}
    assert by_world.rows.height == 3 * len(three[0].weight_names)
    assert pooled.rows["p_holm"].null_count() == 8  # neutral markers are not corrected
    assert (pooled.rows["strength_low"] <= pooled.rows["strength"]).all()
    empty = read_worlds([open_run(write_run(tmp_path / "run", intervals=0, worlds=1, snapshot=False))])
    assert reversion_topic(by_condition(empty))[0].rows.is_empty()
