"""Newborns that inherit at the end of a window: until then, they use what their slot held before."""

import numpy as np
from worlds import DEATHLESS, QUICK, make_simulation

WINDOW = 64
LATE = ("world.inheritance=at_window_end", "birth.kappa=0.02", *QUICK)


def by_slot(world, name):
    return world.view(name).reshape(200, -1)


def test_a_new_world_has_a_network_and_a_genome_in_every_slot():
    world = make_simulation(*LATE, seeds=(3,)).worlds[0]
    for name in ("genome", "params"):
        assert len(np.unique(by_slot(world, name), axis=0)) == 200


def test_a_newborn_keeps_its_slots_network_and_genome_until_the_window_ends():
    simulation = make_simulation(*LATE, "hazard.kappa=0.2", seeds=(3,))
    world, waiting, settled = simulation.worlds[0], 0, 0
    for _ in range(4 * WINDOW):
        before = {name: by_slot(world, name).copy() for name in ("params", "genome")}
        newest = world.agents()["agent_id"].max()
        simulation.run(1)
        agents, slots, ends = world.agents(), world.living, world.step % WINDOW == 0
        recent = agents["birth_step"] > world.step - WINDOW if ends else agents["agent_id"] > newest
        for name, old in before.items():
            kept = (by_slot(world, name)[slots[recent]] == old[slots[recent]]).all(axis=1)
            assert not kept.any() if ends else kept.all(), name
        waiting += recent.sum() * (not ends)
        settled += recent.sum() * ends
        assert (world.view("updates")[slots[recent]] == 0).all() or not ends
    assert waiting > settled > 50


def test_a_newborn_gets_the_same_network_late_as_it_would_at_birth():
    quiet = (*QUICK, *DEATHLESS, "birth.kappa=0.02")
    networks = []
    for rule in ("at_window_end", "at_birth"):
        simulation = make_simulation(*quiet, f"world.inheritance={rule}", seeds=(3,))
        simulation.run(WINDOW)
        world = simulation.worlds[0]
        ids = world.agents()["agent_id"].tolist()
        networks.append(dict(zip(ids, by_slot(world, "params")[world.living], strict=True)))
    both = [agent for agent in networks[0] if agent >= 50 and agent in networks[1]]  # the first 50 have learned
    assert len(both) > 20
    for agent in both:
        np.testing.assert_array_equal(networks[0][agent], networks[1][agent])


def test_a_restored_world_of_species_with_longer_and_shorter_genomes_ends_with_the_same_bits():
    """A young parent's child waits for its genome in a row where a longer one may have waited in an earlier window."""
    settings = (
        *("world.inheritance=at_window_end", "birth.kappa=0.2", "hazard.kappa=0.2", "hazard.alpha_age=0.01"),
        *("population.capacity=30", "population.initial_count=15", *QUICK, "world.rollout_steps=32"),
        *("species.long.reward.family=scaled", "species.short.reward.family=linear"),
    )
    whole, walked = (make_simulation(*settings) for _ in range(2))
    whole.run(100)
    for cut in range(20, 100, 20):
        walked.run(20)
        restored = make_simulation(*settings)
        restored.engine.restore(0, walked.engine.save(0))
        restored.run(100 - cut)
        assert restored.worlds[0].digest() == whole.worlds[0].digest(), cut
