"""The landscape assay finds a known fitness, and nothing if there is none."""

import numpy as np
import polars as pl
import pytest
from assay_world import birth_death_world
from scipy import stats

from hedon.assay.gene_effect import flatness, gene_effects
from hedon.assay.outcome import founder_outcomes
from hedon.assay.resample import relative, world_interval
from hedon.assay.surface import fit_quadratic, fit_smooth, quadratic_terms

BOUNDS = (np.full(2, -8.0), np.full(2, 8.0))


def founders(rng: np.random.Generator, worlds: int = 10, count: int = 50):
    return rng.uniform(-8, 8, (worlds * count, 2)), np.repeat(np.arange(worlds), count)


def test_outcomes_count_lines_and_lives() -> None:
    rng = np.random.default_rng(5)
    genes = {"w_normal": np.linspace(-1, 1, 30), "w_action": np.zeros(30)}
    agents = birth_death_world(genes, lambda g: np.full(30, 2e-3), rng)
    found = founder_outcomes(agents, list(genes), 2000)
    parent = dict(zip(agents["agent_id"], agents["parent_id"], strict=True))

    def first(agent: int) -> int:
        while parent[agent] is not None:
            agent = parent[agent]
        return agent

    living = [first(i) for i, end in zip(agents["agent_id"], agents["death_step"], strict=True) if end is None]
    assert found["agent_id"].to_list() == list(range(30))
    assert found["descendants"].to_list() == [living.count(i) for i in range(30)]
    assert found["offspring"].to_list() == agents["children"][:30].to_list()
    np.testing.assert_allclose(found["food"], 2e-3, rtol=1e-6)
    np.testing.assert_array_equal(found["w_normal"], agents["w_normal"][:30])
    ends = agents["death_step"].fill_null(2000) - agents["birth_step"]
    assert found["lifespan"].to_list() == ends[:30].to_list()


def test_with_two_parents_each_has_half_of_a_child() -> None:
    lives = {
        "agent_id": [0, 1, 2, 3],
        "parent_id": [None, None, 0, 2],
        "mate_id": [None, None, 1, 0],
        "birth_step": [0, 0, 100, 200],
        "death_step": [150, 150, None, None],
        "children": [2, 1, 1, 0],
        "energy_gained": [15.0, 15.0, 90.0, 40.0],
        "w_normal": [1.0, 2.0, 1.5, 1.25],
    }
    found = founder_outcomes(pl.DataFrame(lives), ["w_normal"], 300)
    # Agent 2 has half of each founder; its child with founder 0 has half of that and half of founder 0.
    assert found["descendants"].to_list() == [0.5 + 0.75, 0.5 + 0.25]
    np.testing.assert_allclose(found["food"], [(15 + 45 + 30) / (150 + 100 + 75), (15 + 45 + 10) / (150 + 100 + 25)])


def test_a_quadratic_fitness_is_found_with_intervals_that_cover() -> None:
    # Poisson descendants with mean 5 + 0.1 x − 0.05 y − 0.02 x² − 0.015 y² + 0.01 xy: all derivatives are known.
    truth = np.array([0.1, -0.05, -0.04, -0.03, 0.01])
    covered, optima = np.zeros(5), []
    trials = 60
    for trial in range(trials):
        rng = np.random.default_rng(trial)
        z, world = founders(rng)
        expected = 5.0 + quadratic_terms(z) @ truth
        fitness = rng.poisson(np.maximum(expected, 0.0)).astype(float)
        found = fit_quadratic(z, fitness, world, rng)
        estimates = [*found.slope, *found.curvature, found.interaction]
        covered += [each.low <= value <= each.high for each, value in zip(estimates, truth, strict=True)]
        optima.append([each.value for each in found.optimum])
    hessian = np.array([[truth[2], truth[4]], [truth[4], truth[3]]])
    peak = -np.linalg.solve(hessian, truth[:2])
    np.testing.assert_allclose(np.nanmedian(optima, axis=0), peak, atol=0.3)
    # 95 % intervals: over all five coefficients, coverage within what a binomial law allows; percentile intervals from
    # ten worlds would cover only about 0.90.
    low, high = stats.binom.interval(0.999, 5 * trials, 0.95)
    assert low <= covered.sum() <= high


def test_the_smooth_surface_finds_a_peak_that_no_quadratic_has() -> None:
    rng = np.random.default_rng(3)
    z, world = founders(rng, worlds=20, count=100)
    peak = np.array([2.0, -3.0])
    expected = 1.0 + 6.0 * np.exp(-((z - peak) ** 2).sum(axis=1) / 12.0)
    fitness = relative(rng.poisson(expected).astype(float), world)
    smooth = fit_smooth(z, fitness, world, BOUNDS, rng)
    best = np.array([each.value for each in smooth.optimum])
    np.testing.assert_allclose(best, peak, atol=0.8)
    assert all(each.low <= value <= each.high for each, value in zip(smooth.optimum, peak, strict=True))
    assert not smooth.at_edge
    points = np.array([[2.0, -3.0], [0.0, 0.0], [-6.0, 6.0]])
    truth = (1.0 + 6.0 * np.exp(-((points - peak) ** 2).sum(axis=1) / 12.0)) / expected.mean()
    for estimate, value in zip(smooth.at(points), truth, strict=True):
        assert estimate.value == pytest.approx(value, abs=0.35)
        assert estimate.low - 0.15 <= value <= estimate.high + 0.15
    assert smooth.slope[0].low > 0 > smooth.slope[1].high, "at 0 fitness rises toward the peak"
    assert smooth.value.mean() == pytest.approx(1.0, abs=0.1), "the mean over founders is 1"


def birth_rate(genes: dict[str, np.ndarray]) -> np.ndarray:
    """Births per step, highest at a weight of 2."""
    return 1e-3 + 4e-4 * (1 - ((genes["w_normal"] - 2) / 5) ** 2)


def test_a_birth_death_process_with_known_rates_gives_its_surface() -> None:
    # Agents die at 1e-3 per step, so a founder expects exp((births − 1e-3) · 2500) living descendants.
    rng = np.random.default_rng(11)
    names, tables = ["w_normal", "w_action", "neutral_1"], []
    for world in range(12):
        genes = {name: rng.uniform(-6, 6, 60) for name in names}
        tables.append(founder_outcomes(birth_death_world(genes, birth_rate, rng, steps=2500, world=world), names, 2500))
    z = np.concatenate([table.select(names).to_numpy() for table in tables]).astype(float)
    world = np.repeat(np.arange(12), 60)
    fitness = relative(np.concatenate([table["descendants"].to_numpy() for table in tables]), world)
    effects = gene_effects(names, z, fitness, world, rng)
    assert effects[0].slope_low > 0
    assert effects[0].curvature_high < 0
    assert max(effects[0].slope_p, effects[0].curvature_p) < 0.01
    assert min(effects[2].slope_p, effects[1].slope_p) > 0.01
    assert flatness(quadratic_terms(z[:, :2]), fitness, world, rng) < 0.01
    smooth = fit_smooth(z[:, :2], fitness, world, (np.full(2, -6.0), np.full(2, 6.0)), rng)
    assert smooth.optimum[0].low <= 2.0 <= smooth.optimum[0].high
    assert smooth.optimum[0].value == pytest.approx(2.0, abs=1.3)
    expected = np.exp((birth_rate({"w_normal": np.concatenate([z[:, 0], [-5.0, 2.0]])}) - 1e-3) * 2500)
    truth = expected[-2:] / expected[:-2].mean()
    for estimate, value in zip(smooth.at(np.array([[-5.0, 0.0], [2.0, 0.0]])), truth, strict=True):
        assert estimate.low <= value <= estimate.high


@pytest.mark.long
def test_genes_without_effect_are_found_to_have_one_once_in_twenty() -> None:
    trials, found, flat, tests = 200, 0, 0, 0
    for trial in range(trials):
        rng = np.random.default_rng([7, trial])
        world = np.repeat(np.arange(6), 20)
        # As skewed as numbers of descendants, and on a different scale in each world.
        fitness = relative(rng.geometric(0.2, 120) * (rng.random(120) < 0.4) * (1.0 + world), world)
        z = rng.uniform(-8, 8, (120, 2))
        effects = gene_effects(("a", "b"), z, fitness, world, rng)
        found += (effects[0].slope_p < 0.05) + (effects[0].curvature_p < 0.05)
        flat += flatness(quadratic_terms(z), fitness, world, rng) < 0.05
        tests += 2
    low, high = stats.binom.interval(0.99, tests, 0.05)
    assert low <= found <= high, f"{found} of {tests}"
    low, high = stats.binom.interval(0.99, trials, 0.05)
    assert low <= flat <= high, f"{flat} of {trials}"
    print(f"size: {found} of {tests}, {flat} of {trials}")


def test_intervals_need_worlds_and_values() -> None:
    values = np.random.default_rng(0).normal(size=(1000, 2))
    assert np.isnan(world_interval(values, 2)).all()
    low, high = world_interval(values, 1000)
    np.testing.assert_allclose([low, high], [[-1.96] * 2, [1.96] * 2], atol=0.2)
    few_low, _ = world_interval(values, 5)
    assert (few_low < low).all(), "few worlds, wide intervals"
    values[:40, 0] = np.nan
    values[:60, 1] = np.nan
    known = np.isfinite(world_interval(values, 10))
    assert known.tolist() == [[True, False], [True, False]]


def test_relative_fitness_is_one_on_average_and_unknown_without_any() -> None:
    found = relative(np.array([1.0, 3.0, 0.0, 0.0]), np.array([0, 0, 1, 1]))
    np.testing.assert_array_equal(found, [0.5, 1.5, np.nan, np.nan])
