"""Rewards for what rays see, compared with the observation that they pay for."""

import numpy as np
import pytest
from worlds import CHILDLESS, DEATHLESS, QUICK, STILL, make_simulation, set_scene


def rewards(channel: str, weight: float) -> tuple[float, np.ndarray]:
    """The reward of a prey agent for a step in which it sees a predator, and its readings of the predator."""
    simulation = make_simulation(
        *QUICK,
        *STILL,
        *DEATHLESS,
        *CHILDLESS,
        "reward.action_coef=0",
        "species.prey.body.radius=10",
        "species.prey.reward.pay.see_predator.coef=0.1",
        f'species.prey.reward.pay.see_predator.channel="{channel}"',
        f"species.prey.reward.pay.see_predator.gene.initial_mean={weight}",
        "species.prey.reward.pay.see_predator.gene.initial_sd=0",
        "species.predator.body.radius=14",
    )
    set_scene(simulation, [(100, 100, 0.0), (110, 160, 0.0)], species=[0, 1])
    world = simulation.worlds[0]
    seen = world.rays(0)[0]
    simulation.run(1)
    return float(world.view("reward")[world.living[0], 0]), seen[:, 1]


@pytest.mark.parametrize(("channel", "reduce"), [("see_predator", np.mean), ("see_predator_max", np.max)])
def test_the_reward_is_the_weight_times_what_is_seen(channel, reduce):
    paid, readings = rewards(channel, 2.5)
    assert (readings > 0).sum() >= 3
    assert paid == pytest.approx(0.1 * 2.5 * reduce(np.maximum(readings, 0)), rel=1e-5)


def test_a_weight_of_zero_pays_nothing():
    assert rewards("see_predator", 0.0)[0] == 0.0
