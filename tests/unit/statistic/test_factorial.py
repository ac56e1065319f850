import itertools
import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from hedon.statistic.factorial import Cell, FactorialFit, all_effects, fit_factorial

CELLS: list[Cell] = list(itertools.product((False, True), repeat=3))
TRUE = {(0,): 2.0, (1,): -1.0, (2,): 0.5, (0, 1): 4.0, (0, 2): 0.0, (1, 2): -3.0, (0, 1, 2): 8.0}


def cell_mean(cell: Cell, effects: dict[tuple[int, ...], float], mean: float = 10.0) -> float:
    """By the definition: each effect times the product of ±1/2 of its factors."""
    signs = [0.5 if there else -0.5 for there in cell]
    return mean + sum(size * math.prod(signs[i] for i in group) for group, size in effects.items())


def design(cells: list[Cell], effects: dict[tuple[int, ...], float], sd: float, seeds: int, rng) -> dict:
    return {
        cell: {seed: cell_mean(cell, effects) + sd * rng.normal() for seed in range(1, seeds + 1)} for cell in cells
    }


def estimates(fit: FactorialFit) -> dict[tuple[int, ...], float]:
    return {effect.factors: effect.estimate for effect in fit.effects}


def test_without_noise_effects_are_exact() -> None:
    fit = fit_factorial(design(CELLS, TRUE, 0.0, 2, np.random.default_rng(1)), 3)
    assert estimates(fit) == pytest.approx(TRUE, abs=1e-12)
    assert [effect.factors for effect in fit.effects] == all_effects(3)
    assert fit.left_out == ()
    assert all(effect.seeds == 2 and effect.order == 3 for effect in fit.effects)


def test_an_effect_means_what_it_says() -> None:
    """Main effects and interactions as differences of means of cells, worked by hand."""
    values = dict(zip(CELLS, (1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0), strict=True))
    found = estimates(fit_factorial({cell: {1: value} for cell, value in values.items()}, 3))
    assert found[(0,)] == pytest.approx((16 + 32 + 64 + 128) / 4 - (1 + 2 + 4 + 8) / 4)
    with_second = (64 + 128) / 2 - (4 + 8) / 2
    without_second = (16 + 32) / 2 - (1 + 2) / 2
    assert found[0, 1] == pytest.approx(with_second - without_second)
    assert found[0, 1, 2] == pytest.approx(((128 - 8) - (32 - 2)) - ((64 - 4) - (16 - 1)))


def test_one_world_per_cell_has_no_interval() -> None:
    fit = fit_factorial(design(CELLS, TRUE, 1.0, 1, np.random.default_rng(1)), 3)
    assert all(np.isnan([e.low, e.high, e.p, e.p_holm]).all() for e in fit.effects)
    assert all(e.seed_low == e.seed_high == pytest.approx(e.estimate) for e in fit.effects)


def test_cells_count_equally_whatever_their_number_of_worlds() -> None:
    rng = np.random.default_rng(2)
    cells = design(CELLS, TRUE, 0.0, 2, rng)
    cells[CELLS[0]] |= dict.fromkeys(range(3, 9), cells[CELLS[0]][1])
    cells[CELLS[5]].pop(2)
    fit = fit_factorial(cells, 3)
    assert estimates(fit) == pytest.approx(TRUE, abs=1e-12)
    assert {effect.seeds for effect in fit.effects} == {1}  # seed 2 lacks a cell
    assert all(np.isnan([e.low, e.high, e.p]).all() for e in fit.effects), "a cell of one world has no variance"


@pytest.mark.long
def test_intervals_cover_as_often_as_promised() -> None:
    rng = np.random.default_rng(3)
    trials, covered, false_alarms = 400, 0, 0
    effects = TRUE | {(0, 2): 0.0}
    for _ in range(trials):
        fit = fit_factorial(design(CELLS, effects, 1.5, 2, rng), 3)
        covered += sum(effect.low <= TRUE[effect.factors] <= effect.high for effect in fit.effects)
        false_alarms += next(effect.p for effect in fit.effects if effect.factors == (0, 2)) < 0.05
    # The seven effects of a trial share the variance estimates, hence bounds of about 4 standard errors. Each cell has
    # its own variance, so with two worlds per cell there are few degrees of freedom, and the intervals are too wide.
    assert 0.925 < covered / (7 * trials) < 0.99
    assert false_alarms / trials < 0.095


def test_two_cells_are_compared_with_welchs_test() -> None:
    few, many = [3.0, 9.0, -4.0], [1.0, 1.5, 0.5, 1.2, 0.9]
    fit = fit_factorial({(True,): dict(enumerate(few)), (False,): dict(enumerate(many))}, 1)
    (effect,) = fit.effects
    known: Any = stats.ttest_ind(few, many, equal_var=False)
    assert (effect.p, effect.freedom) == pytest.approx((known.pvalue, known.df))
    assert (effect.low, effect.high) == pytest.approx(tuple(known.confidence_interval()))


def test_intervals_also_cover_with_a_missing_cell_and_unequal_numbers() -> None:
    rng = np.random.default_rng(4)
    true = {(0,): 2.0, (1,): -1.0, (2,): 0.5, (0, 1): 4.0, (0, 2): 0.0, (1, 2): -3.0}
    covered = total = 0
    for _ in range(300):
        cells = design(CELLS[:-1], true, 1.0, 4, rng)
        cells[CELLS[1]].pop(1)
        fit = fit_factorial(cells, 3)
        covered += sum(effect.low <= true[effect.factors] <= effect.high for effect in fit.effects)
        total += len(fit.effects)
    assert covered / total == pytest.approx(0.95, abs=0.03)


def test_a_missing_cell_leaves_out_the_interaction_of_all() -> None:
    """Seven cells determine seven numbers: if there is no three-way interaction, all others are exact."""
    true = {group: size for group, size in TRUE.items() if len(group) < 3}
    for missing in range(8):
        cells = [cell for i, cell in enumerate(CELLS) if i != missing]
        fit = fit_factorial(design(cells, true, 0.0, 2, np.random.default_rng(5)), 3)
        assert fit.left_out == ((0, 1, 2),)
        assert estimates(fit) == pytest.approx(true, abs=1e-9)
        assert {effect.order for effect in fit.effects} == {2}


def test_effects_that_cells_cannot_separate_are_left_out() -> None:
    none, first, every = (False,) * 3, (True, False, False), (True,) * 3
    rng = np.random.default_rng(6)
    # The second and third factors occur only together, so neither is estimated; the first is, though in two cells.
    fit = fit_factorial(design([none, first, every], TRUE, 0.0, 2, rng), 3)
    assert estimates(fit) == pytest.approx({(0,): cell_mean(first, TRUE) - cell_mean(none, TRUE)})
    assert set(fit.left_out) == set(TRUE) - {(0,)}
    # Half of the design: an additive model would mistake the interactions of the others for the second factor.
    half = [none, first, (False, False, True), every]
    assert set(estimates(fit_factorial(design(half, TRUE, 0.0, 2, rng), 3))) == {(0,), (2,)}
    assert fit_factorial(design([none, every], TRUE, 0.0, 2, rng), 3).effects == ()
    assert fit_factorial(design([none], TRUE, 0.0, 2, rng), 3).left_out == tuple(all_effects(3))
    assert fit_factorial({}, 3).left_out == tuple(all_effects(3))


def test_an_estimate_from_some_cells_never_contains_another_effect() -> None:
    """With any cells, changing all effects that do not include a group of factors leaves its estimate unchanged."""
    rng = np.random.default_rng(8)
    told = 0
    for chosen in range(1, 256):
        cells = [cell for i, cell in enumerate(CELLS) if chosen >> i & 1]
        for group in all_effects(3):
            other = {effect: 9.0 * rng.normal() for effect in all_effects(3) if not set(group) <= set(effect)}
            found = estimates(fit_factorial(design(cells, other | {group: 2.0}, 0.0, 1, rng), 3))
            if group in found:
                told += 1
                assert found[group] == pytest.approx(2.0, abs=1e-9)
    assert told > 255


def test_a_clear_effect_is_found_and_corrected_for_seven_tests() -> None:
    fit = fit_factorial(design(CELLS, {(1,): 6.0}, 1.0, 2, np.random.default_rng(7)), 3)
    found = {effect.factors: effect for effect in fit.effects}
    assert found[(1,)].p < 1e-3
    assert found[(1,)].p_holm == pytest.approx(7 * found[(1,)].p)
    assert found[(1,)].seed_low < found[(1,)].estimate < found[(1,)].seed_high
    assert min(effect.p_holm for group, effect in found.items() if group != (1,)) > 0.05
