"""What a child inherits: its parent's network, genes of two parents, thresholds set by genes."""

import math

import numpy as np
import pytest
from worlds import DEATHLESS, QUICK, STILL, make_simulation, set_scene

from hedon.config import ConfigError, load_config

FERTILE = ("birth.kappa=1", "birth.beta=10", "energy.basic_cost=0", "food.normal.growth_rate=0")
PAIRS = ("birth.mating=pairs",)
CALM = (*QUICK, *STILL, *DEATHLESS)


def networks(world) -> np.ndarray:
    return world.view("params")[world.living].copy()


@pytest.mark.parametrize(("network", "noise"), [("learned", 0.0), ("initial", 0.0), ("learned", 0.02)])
def test_a_child_gets_the_network_that_the_setting_specifies(network, noise):
    settings = (*CALM, f"birth.network={network}", f"birth.network_noise={noise}", "learning.learning_rate=0.01")
    simulation = make_simulation(*settings, "birth.kappa=0.005", "birth.beta=10")

    def by_id() -> dict[int, np.ndarray]:
        world = simulation.worlds[0]
        return dict(zip(world.agents()["agent_id"].tolist(), networks(world), strict=True))

    start = by_id()
    simulation.run(128)
    before = by_id()
    moved = np.mean([np.abs(before[i] - start[i]).mean() for i in start])
    assert moved > 1e-3  # two windows of learning
    simulation.run(20)  # no agent learns in these steps
    source = before if network == "learned" else start
    lives, now = simulation.worlds[0].agents(), by_id()
    parents = dict(zip(lives["agent_id"].tolist(), lives["parent_id"].tolist(), strict=True))
    born = [i for i in now if i not in before and parents[i] in source]
    assert born
    for child in born:
        difference = now[child] - source[parents[child]]
        assert difference.std() == pytest.approx(noise, rel=0.05)
        assert abs(difference.mean()) <= 5 * noise / math.sqrt(len(difference))


def test_by_default_a_child_gets_a_new_network():
    simulation = make_simulation(*CALM, *FERTILE)
    set_scene(simulation, [(200, 200, 0.0)])
    simulation.run(1)
    world = simulation.worlds[0]
    assert world.alive == 2
    parent, child = networks(world)
    assert abs(np.corrcoef(parent, child)[0, 1]) < 0.1


def test_an_instinct_is_passed_on_over_generations_and_checkpoints():
    settings = (*QUICK, "birth.network=initial", "birth.network_noise=0", "birth.kappa=0.01", "hazard.alpha_age=0.005")
    one, two = make_simulation(*settings), make_simulation(*settings, threads=2)
    first = one.worlds[0].view("params")[one.worlds[0].living].copy()
    one.run(448)
    two.run(300)
    two.engine.restore(0, two.engine.save(0))
    two.run(148)
    assert one.worlds[0].digest() == two.worlds[0].digest()
    world = one.worlds[0]
    assert world.agents()["generation"].max() >= 2
    kept = world.view("initial_params")[world.living]
    # Every agent was born with a founder's network.
    assert all((np.abs(first - own).max(axis=1) == 0).any() for own in kept)


def test_two_parents_share_the_costs_and_the_genes():
    genes = ("genome.mutation_scale=0", "genome.neutral.initial_sd=1", "genome.neutral_count=16")
    simulation = make_simulation(*CALM, *FERTILE, *PAIRS, *genes, "birth.mating_range=1", "energy.initial=60")
    set_scene(simulation, [(200, 200, 0.0), (220.5, 200, 0.0)], energy=60.0)
    simulation.run(1)
    world = simulation.worlds[0]
    lives = world.agents()
    assert world.alive == 3
    assert {int(lives["parent_id"][2]), int(lives["mate_id"][2])} == {0, 1}
    assert lives["mate_id"][:2].tolist() == [-1, -1]
    assert lives["energy"].tolist() == pytest.approx([48.0, 48.0, 24.0])
    assert lives["children"].tolist() == [1, 1, 0]
    assert lives["generation"].tolist() == [0, 0, 1]
    first, second, child = lives["genome"]
    from_first, from_second = child == first, child == second
    assert (from_first ^ from_second).all()
    assert 2 <= from_first.sum() <= len(child) - 2


def test_each_gene_comes_from_either_parent_half_of_the_time():
    genes = ("genome.mutation_scale=0", "genome.neutral.initial_sd=1")
    simulation = make_simulation(*CALM, *FERTILE, *PAIRS, *genes, "birth.mating_range=300", "birth.mating_window=5")
    simulation.run(6)
    world = simulation.worlds[0]
    lives = world.agents()
    genome = dict(zip(lives["agent_id"].tolist(), lives["genome"], strict=True))
    children = [i for i in range(world.alive) if lives["parent_id"][i] >= 0]
    shares = [
        (lives["genome"][i] == genome[int(lives["parent_id"][i])]).mean()
        for i in children
        if not np.array_equal(genome[int(lives["parent_id"][i])], genome[int(lives["mate_id"][i])])
    ]
    assert len(children) > 20
    assert np.mean(shares) == pytest.approx(0.5, abs=0.12)


@pytest.mark.parametrize(("apart", "born"), [(20.9, True), (21.1, False)])
def test_mates_must_be_near(apart, born):
    simulation = make_simulation(*CALM, *FERTILE, *PAIRS, "birth.mating_range=1")
    set_scene(simulation, [(200, 200, 0.0), (200 + apart, 200, 0.0)])
    simulation.run(3)
    assert (simulation.worlds[0].alive > 2) is born


def test_a_parent_waits_for_a_mate_only_for_a_while():
    """The chance of a draw is small, so two parents are rarely ready in the same step; a window helps them meet."""

    def births(window: int) -> int:
        settings = ("birth.kappa=0.004", "birth.beta=10", f"birth.mating_window={window}", "birth.mating_range=500")
        simulation = make_simulation(*CALM, *PAIRS, *settings, "population.capacity=400", "population.initial_count=20")
        simulation.run(200)
        return simulation.worlds[0].counters["births"]

    assert births(0) < 0.3 * births(100)
    assert births(100) > 5


def test_no_agent_mates_alone_or_with_another_species():
    alone = make_simulation(*CALM, *FERTILE, *PAIRS, "birth.mating_range=1000")
    set_scene(alone, [(200, 200, 0.0)])
    alone.run(5)
    assert alone.worlds[0].alive == 1
    mixed = make_simulation(
        *CALM,
        *FERTILE,
        *PAIRS,
        "birth.mating_range=1000",
        "species.one.population.initial_count=1",
        "species.two.population.initial_count=1",
    )
    mixed.run(5)
    assert mixed.worlds[0].alive == 2


def test_threads_and_a_restore_do_not_change_mating():
    settings = (*QUICK, *PAIRS, "birth.kappa=0.02", "birth.beta=10", "birth.mating_range=40")
    one, two = make_simulation(*settings), make_simulation(*settings, threads=2)
    one.run(192)
    two.run(101)
    two.engine.restore(0, two.engine.save(0))
    two.run(91)
    assert one.worlds[0].counters["births"] > 5
    assert one.worlds[0].digest() == two.worlds[0].digest()


@pytest.mark.parametrize("gene", [-0.5, 0.0, 0.7])
def test_the_threshold_may_be_a_gene(gene):
    """`below`: w σ((θ − E)/δ) with θ and δ multiplied by ten to the power of their genes."""
    settings = ("reward.family=below", "reward.threshold=30", "reward.threshold_width=8", "reward.meal_coef=0")
    genes = ("genome.family.threshold.initial_sd=0", f"genome.family.threshold.initial_mean={gene}")
    width = ("genome.family.threshold_width.initial_sd=0", "genome.family.threshold_width.initial_mean=0.3")
    weight = ("genome.action.initial_mean=2", "genome.action.initial_sd=0", "reward.action_norm=none")
    simulation = make_simulation(
        *QUICK, *DEATHLESS, *settings, *genes, *width, *weight, "energy.basic_cost=0", "energy.action_cost=0"
    )
    set_scene(simulation, [(200, 200, 0.0)])
    simulation.run(1)
    lives = simulation.worlds[0].agents()
    force = math.hypot(lives["force_left"][0], lives["force_right"][0])
    share = 1 / (1 + math.exp(-(30 * 10**gene - 40) / (8 * 10**0.3)))
    assert lives["reward"][0] == pytest.approx(0.01 * 2 * share * force, rel=1e-5)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        (["world.inheritance=at_window_end", "birth.network=learned"], 'must be "none" with world.inheritance'),
        (["world.inheritance=at_window_end", "birth.mating=pairs"], 'must be "none" with world.inheritance'),
        (["birth.network=learned", "learning.policy=random"], "there is no network to inherit"),
        (["birth.mating=pairs", "population.capacity=1", "population.initial_count=1"], "nobody mates alone"),
        (["genome.family.threshold.initial_sd=0.1"], 'reward.family = "linear" has no threshold'),
        (["genome.family.treshold.initial_sd=0.1", "reward.family=above"], "did you mean threshold"),
    ],
)
def test_contradictions_are_refused_by_name(settings, message):
    with pytest.raises(ConfigError, match=message):
        load_config("baseline", overrides=settings)
