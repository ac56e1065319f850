"""Assays: contests of two groups that do not differ, and slopes of genes that do nothing."""

from collections.abc import Callable
from typing import Literal

import numpy as np

from calibrations.calibration import Calibration
from hedon.analysis.gene.course import WALKS, WorldCourse
from hedon.assay.contest import Contest, Lines, estimate
from hedon.assay.contingency import distance_ratio, overlap
from hedon.assay.frequency import estimate_frequency
from hedon.assay.gene_effect import gene_effects
from hedon.assay.resample import Estimate, Floats, relative
from hedon.assay.stability import Stability, judge, weight_course

LEVEL = 0.05
MOMENTS, GENERATIONS = 41, 8.0
_GENES, _TIMES = ("w_food", "w_action"), 11


def _lines(rng: np.random.Generator, seed: int, start: float, living: int = 100) -> Lines:
    """Two groups that do not differ: the share drifts as in a population of constant size."""
    share, steps = [start], MOMENTS - 1
    for _ in range(steps):
        moved = rng.binomial(round(living * steps / GENERATIONS), share[-1])
        share.append(moved / round(living * steps / GENERATIONS))
    p = np.array(share)
    founders = np.arange(50) < round(50 * start)
    return Lines(
        seed=seed,
        step=np.arange(MOMENTS),
        count=living * np.stack([p, 1 - p], axis=1),
        generation=np.linspace(0, GENERATIONS, MOMENTS),
        first=founders,
        descendants=rng.exponential(1.0, 50),
        ended=False,
    )


def _contest(rng: np.random.Generator, start: float) -> Contest:
    worlds = int(rng.integers(5, 13))
    return estimate(("a", "b"), [_lines(rng, seed, start) for seed in range(worlds)], 1000)


def _missed(found: Estimate, truth: float) -> bool | None:
    return None if np.isnan(found.low) else not found.low <= truth <= found.high


def _strength(start: float) -> Callable[[np.random.Generator], bool | None]:
    return lambda rng: _missed(_contest(rng, start).result.selection, 0.0)


def _end(rng: np.random.Generator) -> bool | None:
    return _missed(_contest(rng, 0.5).result.end, 0.5)


def _exchange(rng: np.random.Generator) -> bool:
    return _contest(rng, 0.5).p <= LEVEL


def _frequency(part: Literal["least", "slope"]) -> Callable[[np.random.Generator], bool | None]:
    def draw(rng: np.random.Generator) -> bool | None:
        seeds = int(rng.integers(5, 13))
        worlds = {start: [_lines(rng, seed, start) for seed in range(seeds)] for start in (0.1, 0.5, 0.9)}
        found = estimate_frequency(("a", "b"), worlds)
        return _missed(found.shares[0].selection if part == "least" else found.slope, 0.0)

    return draw


def _landscape(rng: np.random.Generator) -> bool:
    """Whether the interval of a slope leaves out 0: families differ by luck, genes do nothing."""
    worlds = int(rng.integers(5, 13))
    world = np.repeat(np.arange(worlds), 60)
    children = rng.poisson(rng.gamma(0.5, 2.0, len(world))).astype(np.float64)
    genes = rng.uniform(-2, 2, (len(world), 1))
    (found,) = gene_effects(["w"], genes, relative(children, world), world, rng)
    return not found.slope_low <= 0 <= found.slope_high


def _landscape_p(rng: np.random.Generator) -> bool:
    world = np.repeat(np.arange(int(rng.integers(3, 13))), 60)
    children = rng.poisson(rng.gamma(0.5, 2.0, len(world))).astype(np.float64)
    (found,) = gene_effects(["w"], rng.uniform(-2, 2, (len(world), 1)), relative(children, world), world, rng)
    return found.slope_p <= LEVEL


def _drifting_course(rng: np.random.Generator) -> WorldCourse:
    """Means of two genes that walk as neutral genes do; steps have heavy tails, and their size is the world's own."""
    walks = np.cumsum(rng.uniform(0.1, 2.0) * rng.standard_t(2, (len(_GENES), 1 + WALKS, _TIMES)), axis=-1)
    walks -= walks[..., :1]
    return WorldCourse(
        generations=GENERATIONS,
        mean={gene: gene_walks[0] for gene, gene_walks in zip(_GENES, walks, strict=True)},
        neutral={gene: gene_walks[1:] for gene, gene_walks in zip(_GENES, walks, strict=True)},
    )


def _stability(rng: np.random.Generator) -> bool:
    """Whether any of two genes from two starts is said to leave, or to be held, though both drift."""
    starts, step = [], np.arange(_TIMES, dtype=float)
    for name in ("one", "two"):
        worlds = [_drifting_course(rng) for _ in range(rng.integers(3, 13))]
        courses = {gene: weight_course(gene, 0.0, step, worlds) for gene in _GENES}
        seeds = tuple(range(len(worlds)))
        starts.append(Stability(name, dict.fromkeys(_GENES, 0.0), len(worlds), 0, GENERATIONS, courses, seeds))
    return any(course.verdict != "as drift" for start in judge(starts) for course in start.courses.values())


def _apart(rng: np.random.Generator, truth: float) -> tuple[list[Floats], Floats]:
    """Futures of 1 to 4 worlds and fresh worlds, whose distances have a known ratio, of one gene or several."""
    law = rng.normal if rng.random() < 0.5 else rng.laplace
    genes = int(rng.choice([1, 16]))
    shared = law(size=genes)
    groups = [truth * law(size=(rng.integers(8, 16), genes)) + shared for _ in range(rng.integers(1, 5))]
    return groups, law(size=(int(rng.integers(8, 31)), genes))


def _ratio(rng: np.random.Generator) -> bool | None:
    _, low, high, _ = distance_ratio(*_apart(rng, 0.5))
    return None if np.isnan(low) else not low <= 0.5 <= high


def _ratio_p(rng: np.random.Generator) -> bool:
    return distance_ratio(*_apart(rng, 1.0))[3] <= LEVEL


def _overlapping(rng: np.random.Generator) -> bool:
    """Whether agents that are interchangeable are said to be successful in every future; few have descendants."""
    futures, agents = int(rng.integers(2, 11)), int(rng.integers(5, 200))
    shares = rng.gamma(0.3, size=(futures, agents)) * (rng.random((futures, agents)) < 0.5) + 1e-9
    return overlap(1, 0, "agent", shares / shares.sum(axis=1, keepdims=True), 200).p <= LEVEL


_ALIKE = "5 to 12 worlds of 100 agents over 8 generations; the groups do not differ; start at {}"
_KINDS = "8 to 15 futures of each of 1 to 4 worlds, and 8 to 30 fresh worlds"
CALIBRATIONS = [
    Calibration("compete, s", ("assay:compete",), _ALIKE.format(0.5), "missed", LEVEL, _strength(0.5)),
    Calibration(
        "invade, s",
        ("assay:invade", "assay:knockout"),
        _ALIKE.format(0.1),
        "missed",
        LEVEL,
        _strength(0.1),
    ),
    Calibration("compete, share at the end", ("assay:compete",), _ALIKE.format(0.5), "missed", LEVEL, _end),
    Calibration(
        "compete, p of exchanged founders", ("assay:compete",), _ALIKE.format(0.5), "false alarms", LEVEL, _exchange
    ),
    Calibration(
        "frequency, s at the least share",
        ("assay:frequency",),
        _ALIKE.format("0.1, 0.5, 0.9"),
        "missed",
        LEVEL,
        _frequency("least"),
    ),
    Calibration(
        "frequency, slope", ("assay:frequency",), _ALIKE.format("0.1, 0.5, 0.9"), "missed", LEVEL, _frequency("slope")
    ),
    Calibration(
        "landscape, interval of a slope",
        ("assay:landscape",),
        "5 to 12 worlds of 60 founders; families differ by luck",
        "missed",
        LEVEL,
        _landscape,
    ),
    Calibration(
        "landscape, p of a slope",
        ("assay:landscape",),
        "3 to 12 worlds of 60 founders; families differ by luck",
        "false alarms",
        LEVEL,
        _landscape_p,
    ),
    Calibration(
        "stability, any verdict",
        ("assay:stability",),
        "two genes that drift from two starts; 3 to 12 worlds, heavy tails",
        "false alarms",
        LEVEL,
        _stability,
    ),
    Calibration(
        "contingency, ratio of distances",
        ("assay:contingency",),
        f"{_KINDS}, which lie half as far apart; normal or Laplace",
        "missed",
        LEVEL,
        _ratio,
    ),
    Calibration(
        "contingency, p of a ratio",
        ("assay:contingency",),
        f"{_KINDS}, which lie as far apart; normal or Laplace",
        "false alarms",
        LEVEL,
        _ratio_p,
    ),
    Calibration(
        "contingency, p of an overlap",
        ("assay:contingency",),
        "2 to 10 futures of 5 to 200 agents that are interchangeable; half have no descendants",
        "false alarms",
        LEVEL,
        _overlapping,
    ),
]
