import math

import polars as pl
import pytest

from hedon.analysis.agent.food import food_per_agent_step, food_per_step
from hedon.analysis.agent.lifetime import dead_agents, durations, mean_lifetime
from hedon.analysis.gene.weight import last_agents, last_lived_step, last_living, weight_spreads
from hedon.analysis.world.ledger import world_ledger
from hedon.analysis.world.population import (
    extinct_step,
    history,
    last_generation,
    mean_alive,
    mean_energy,
    run_tail,
)

# Three dead and one alive. Foods per step of life: 2/100, 0/300, 12/600.
AGENTS = pl.DataFrame(
    {
        "world": [0, 0, 0, 0],
        "agent_id": [0, 1, 2, 3],
        "parent_id": [None, None, 0, 1],
        "birth_step": [0, 0, 50, 200],
        "death_step": [100, 300, 650, None],
        "birth_energy": [40.0, 40.0, 10.0, 12.0],
        "eaten_normal": [2, 0, 9, 50],
        "eaten_poor": [0, 0, 3, 1],
        "w_normal": [1.0, 2.0, 3.0, 5.0],
        "w_action": [0.0, 0.0, 0.0, 0.0],
    }
)
POPULATION = pl.DataFrame(
    {
        "world": [0, 0, 0, 0],
        "step": [100, 200, 300, 400],
        "steps": [100, 100, 100, 100],
        "alive": [2, 4, 1, 0],
        "agent_steps": [200, 300, 250, 50],
        "births": [1, 2, 0, 0],
        "deaths": [0, 0, 3, 1],
        "births_failed_full": [0, 0, 1, 0],
        "births_failed_space": [2, 0, 0, 0],
        "energy_mean": [10.0, 20.0, 5.0, None],
        "generation_mean": [0.0, 0.5, 2.0, None],
        "w_normal_mean": [1.0, 2.0, 4.0, None],
        "eaten_normal": [10, 6, 4, 0],
        "eaten_poor": [0, 0, 4, 0],
        "energy_eaten": [10.0, 6.0, 4.8, 0.0],
        "energy_forgiven": [0.0, 1.0, 0.0, 0.0],
        "energy_basic": [5.0, 5.0, 5.0, 1.0],
        "energy_action": [5.0, 2.0, 5.0, 1.0],
        "energy_capped": [0.0, 0.0, 1.0, 0.0],
        "energy_lost": [0.0, 0.0, 3.8, 68.0],
        "energy_shared": [4.0, 2.0, 0.0, 0.0],
        "energy_total": [80.0, 80.0, 70.0, 0.0],
    }
)


def test_lifetimes_of_the_dead() -> None:
    assert dead_agents(AGENTS)["lifetime"].to_list() == [100, 300, 600]
    assert mean_lifetime(AGENTS) == pytest.approx(1000 / 3)
    assert mean_lifetime(AGENTS, last=2) == 450
    assert mean_lifetime(AGENTS, born_in_run=True) == 600
    assert mean_lifetime(AGENTS.tail(1)) is None


def test_food_by_both_rules() -> None:
    kinds = ("normal", "poor")
    assert food_per_step(AGENTS, kinds) == pytest.approx((0.02 + 0.0 + 0.02) / 3)
    assert food_per_step(AGENTS, kinds, last=2) == pytest.approx(0.01)
    assert food_per_step(AGENTS, ("normal",)) == pytest.approx((0.02 + 0.0 + 0.015) / 3)
    assert food_per_agent_step(POPULATION, kinds) == pytest.approx(24 / 800)
    assert food_per_agent_step(POPULATION, ("poor",)) == pytest.approx(4 / 800)


def test_food_if_no_agent_died_or_lived() -> None:
    assert food_per_step(AGENTS.tail(1), ("normal",)) is None
    assert food_per_agent_step(POPULATION.head(0), ("normal",)) is None
    same_step = AGENTS.head(2).with_columns(death_step=pl.Series([0, 300]))  # a life of zero steps has no rate
    assert food_per_step(same_step, ("normal",)) == 0


def test_weights_of_the_last_born() -> None:
    assert last_agents(AGENTS, 2)["agent_id"].to_list() == [2, 3]


def test_the_living_at_the_end_or_at_the_last_step_with_any() -> None:
    living = AGENTS.with_columns(death_step=pl.Series([100, 300, None, None], dtype=pl.Int64))
    going = POPULATION.with_columns(alive=pl.Series([2, 4, 2, 2]))
    assert last_living(living, going)["agent_id"].to_list() == [2, 3]
    extinct = AGENTS.with_columns(death_step=pl.Series([100, 300, 310, 350]))
    assert (last_lived_step(POPULATION), last_lived_step(POPULATION.head(0))) == (300, 0)
    assert last_living(extinct, POPULATION)["agent_id"].to_list() == [2, 3]
    assert last_living(AGENTS, POPULATION.head(0))["agent_id"].to_list() == [0, 1]  # nothing recorded: the founders


def test_spreads_of_weights() -> None:
    spread = weight_spreads(AGENTS.tail(2), ("w_normal", "w_action"))["w_normal"]
    assert spread["mean"] == 4
    assert spread["sd"] == pytest.approx(math.sqrt(2))
    assert weight_spreads(AGENTS.tail(1), ("w_normal",))["w_normal"] == {"mean": 5.0, "sd": None}
    assert weight_spreads(AGENTS.head(0), ("w_normal",))["w_normal"] == {"mean": None, "sd": None}


def test_last_agents_are_counted_per_world() -> None:
    both = pl.concat([AGENTS, AGENTS.with_columns(world=pl.lit(1, pl.Int64))])
    assert last_agents(both, 1)["world"].to_list() == [0, 1]


def test_ledger_closes_on_the_hand_example() -> None:
    ledger = world_ledger(POPULATION, AGENTS)
    assert ledger["initial"] == 80
    assert ledger["final"] == 0
    assert ledger["eaten"] == pytest.approx(20.8)
    assert ledger["shared"] == 6
    assert ledger["residual"] == pytest.approx(0, abs=1e-12)


def test_ledger_finds_a_leak() -> None:
    leaky = POPULATION.with_columns(energy_total=pl.Series([80.0, 80.5, 70.5, 0.5]))
    assert world_ledger(leaky, AGENTS)["residual"] == pytest.approx(0.5)
    founders_early = AGENTS.with_columns(birth_energy=pl.lit(39.0))
    assert world_ledger(POPULATION, founders_early)["residual"] == pytest.approx(2.0)


def test_ledger_without_rows() -> None:
    ledger = world_ledger(POPULATION.head(0), AGENTS.head(0))
    assert (ledger["initial"], ledger["final"], ledger["residual"]) == (None, None, None)


def test_state_of_a_world() -> None:
    assert mean_alive(POPULATION) == 2
    assert mean_energy(POPULATION) == pytest.approx((2 * 10 + 4 * 20 + 5) / 7)
    assert last_generation(POPULATION) == 2
    assert extinct_step(POPULATION) == 400
    assert extinct_step(POPULATION.head(2)) is None
    assert run_tail(POPULATION)["step"].to_list() == [400]
    empty = POPULATION.head(0)
    assert (mean_alive(empty), mean_energy(empty), last_generation(empty)) == (None, None, None)
    assert run_tail(empty).is_empty()


def test_history_in_two_intervals() -> None:
    rows = history(POPULATION, ("normal",), ("w_normal",), points=2)
    assert rows["step"].to_list() == [200, 400]
    assert rows["alive"].to_list() == [3.0, 0.5]
    assert rows["births"].to_list() == [15.0, 0.0]
    assert rows["eaten_normal"].to_list() == pytest.approx([1000 * 16 / 500, 1000 * 4 / 300])
    assert rows["w_normal_mean"].to_list() == [1.5, 4.0]
    assert history(POPULATION.head(0), ("normal",)).is_empty()


def test_a_partial_window_makes_no_spike() -> None:
    whole = {"births": 20, "deaths": 10, "eaten_normal": 100, "agent_steps": 100 * 1024, "steps": 1024, "alive": 100}
    part = {"births": 2, "deaths": 0, "eaten_normal": 4, "agent_steps": 100 * 64, "steps": 64, "alive": 102}
    means = {"energy_mean": 1.0, "generation_mean": 2.0, "births_failed_full": 0, "births_failed_space": 0}
    ends = {0: (1024, 2048, 2112), 1: (64,)}  # world 1 died out in its first window
    rows = [
        {"world": world, "step": step} | means | (whole if step % 1024 == 0 else part)
        for world, steps in ends.items()
        for step in steps
    ]
    found = history(pl.DataFrame(rows), ("normal",), points=100)
    first = found.filter(pl.col("world") == 0)
    assert first["step"].to_list() == [1024, 2048, 2112]
    assert first["alive"].to_list() == [100, 100, 102]
    assert first["births"].to_list() == pytest.approx([20e3 / 1024, 20e3 / 1024, 22e3 / 1088])
    assert first["eaten_normal"][-1] == pytest.approx(104e3 / (100 * 1088))
    assert found.filter(pl.col("world") == 1)["births"].to_list() == [31.25]


def test_living_agents_are_censored_at_the_end() -> None:
    agents = pl.DataFrame({"birth_step": [0, 10, 40], "death_step": [30, None, None]})
    duration, died = durations(agents, 50)
    assert duration.tolist() == [30, 40, 10]
    assert died.tolist() == [True, False, False]
