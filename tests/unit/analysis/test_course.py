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
    still = MutationLaw(mean=0.0, sd=1.0, scale=0.0, limit=1e6, tabulated=False, window=1024, late=False)
    living = [living_at(tree, step) for step in (0, 20_480)]
    walked = neutral_courses(tree, living, still, np.random.default_rng(2), 2000)
    assert walked[:, 0].std() == pytest.approx(1 / np.sqrt(50), rel=0.1)  # founders, each with its own gene
    assert walked[:, 1].std() > 1.5 * walked[:, 0].std()  # families were lost


def test_neutral_genes_of_a_pedigree_are_called_held_as_often_as_promised(worlds: list[WorldRecord]) -> None:
    """64 neutral genes with Cauchy mutations, each tested in its own world against walks of that world."""
    rng, p = np.random.default_rng(3), []
    for world in worlds:
        course = world_course(world, 1024.0, rng, walks=100)
        assert course is not None
        found = [reversion([course.mean[name]], [course.neutral[name]]) for name in world.neutral_names]
        p += [one.p for one in found if one is not None]
    assert len(p) == 64
    assert np.mean(np.array(p) <= 0.05) <= 0.05 + 3 * np.sqrt(0.05 * 0.95 / 64)
    assert 0.35 < np.mean(p) < 0.65


def test_the_topic_pools_worlds_and_leaves_out_empty_ones(worlds: list[WorldRecord], tmp_path: Path) -> None:
    three = worlds[:3]
    pooled, by_world = reversion_topic(by_condition(three))
    assert pooled.rows["weight"].to_list() == list(three[0].weight_names)
    assert set(pooled.rows["worlds"]) == {3}
    assert by_world.rows.height == 3 * len(three[0].weight_names)
    assert pooled.rows["p_holm"].null_count() == 8  # neutral genes are not corrected
    assert (pooled.rows["strength_low"] <= pooled.rows["strength"]).all()
    empty = read_worlds([open_run(write_run(tmp_path / "run", intervals=0, worlds=1, snapshot=False))])
    assert reversion_topic(by_condition(empty))[0].rows.is_empty()
