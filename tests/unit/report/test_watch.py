"""The report says how to watch a run, and at which step its largest change starts."""

from types import SimpleNamespace
from typing import Any

import polars as pl

from hedon.report.watch import WeightChange, how_to_watch, largest_change

STEPS = [100 * (i + 1) for i in range(40)]


def recorded(rows, seeds=(3, 4)) -> Any:
    """A run with a population table."""
    return SimpleNamespace(
        population=lambda skip_damaged: rows, reward_names=("w_food", "w_action"), manifest=SimpleNamespace(seeds=seeds)
    )


def population(seed, food, action):
    return pl.DataFrame({"seed": seed, "step": STEPS[: len(food)], "w_food_mean": food, "w_action_mean": action})


def test_the_largest_change_is_found_over_a_twentieth_of_the_records():
    jump = [0.0] * 20 + [0.1, 0.5] + [0.5] * 18
    flat = [0.0] * 39 + [0.2]
    run = recorded(pl.concat([population(3, flat, jump), population(4, flat, flat)]))
    assert largest_change(run, 3) == WeightChange(3, 2000, 2200, "w_action")
    late = largest_change(run, 4)
    assert late is not None
    assert late.step == 3800
    sentence = how_to_watch(run, 3)
    assert "With --step 2000 --seed 3, it opens at the start of the largest change in the mean of w_action" in sentence
    assert "--seed" not in how_to_watch(recorded(population(3, flat, jump), (3,)), 3)


def test_each_species_is_compared_with_itself():
    prey, predator = [0.0] * 5, [9.0, 9.0, 9.5, 9.5, 9.5]
    rows = [
        population(3, values, moving).with_columns(species=pl.lit(name))
        for name, values, moving in (("prey", prey, [float("nan")] * 5), ("predator", predator, [None] * 5))
    ]
    rows = pl.concat([each.with_columns(pl.col("w_action_mean").cast(pl.Float64)) for each in rows])
    assert largest_change(recorded(rows), 3) == WeightChange(3, 200, 300, "w_food")


def test_without_two_rows_no_moment_is_named():
    run = recorded(population(3, [0.0], [0.0]))
    assert largest_change(run, 3) is None
    assert how_to_watch(run, 3) == "To watch how it got there, run hedon view with this folder."
