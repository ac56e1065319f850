"""Whether weights leave their starting point, stay or drift."""

import math

import numpy as np

from hedon.analysis.gene.course import WorldCourse
from hedon.assay.stability import Stability, judge, weight_course

STEP = np.arange(5.0)


def _worlds(mean: float, spread: float, worlds: int = 6) -> list[WorldCourse]:
    rng = np.random.default_rng(1)
    line = mean * STEP / STEP[-1]
    return [
        WorldCourse(5.0, {"w_food": line}, {"w_food": spread * rng.normal(size=(100, 5)).cumsum(axis=1)})
        for _ in range(worlds)
    ]


def _verdict(worlds: list[WorldCourse]) -> str:
    course = weight_course("w_food", 0.0, STEP, worlds)
    start = Stability("zero", {"w_food": 0.0}, len(worlds), 0, 5.0, {"w_food": course}, tuple(range(len(worlds))))
    return judge([start])[0].courses["w_food"].verdict


def test_a_weight_leaves_is_held_or_drifts():
    assert _verdict(_worlds(mean=50.0, spread=1.0)) == "leaves"
    assert _verdict(_worlds(mean=0.0, spread=1.0)) == "held"
    assert _verdict(_worlds(mean=1.5, spread=1.0)) == "as drift"


def test_a_gene_that_cannot_change_is_not_judged():
    course = weight_course("w_food", 0.0, STEP, _worlds(mean=0.0, spread=0.0))
    assert math.isnan(course.p)
    assert math.isnan(course.p_held)
    assert _verdict(_worlds(mean=0.0, spread=0.0)) == "as drift"


def test_without_worlds_nothing_is_judged():
    course = weight_course("w_food", 0.0, STEP, [])
    assert math.isnan(course.p)
    assert math.isnan(course.p_held)
