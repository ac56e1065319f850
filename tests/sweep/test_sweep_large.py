"""A large sweep is planned from what its conditions change, and its results are read concurrently."""

import json
import threading
import time
from pathlib import Path

import polars as pl
import pytest
from sweep_case import condition_configs, planned, sweep_file

from hedon.config import ConfigError, digest
from hedon.ensemble.collect import collect
from hedon.ensemble.condition import DIGITS
from hedon.ensemble.plan import load_plan
from hedon.ensemble.store import READERS, Store
from hedon.experiment.plan import RunPlan
from hedon.sweep.condition import Loader
from hedon.sweep.read import read_sweep

COUNT = 2_000
COSTS = f'[factor]\n"energy.basic_cost" = {{ log = [1e-4, 1e-2], count = {COUNT // 2} }}\n"energy.initial" = [8, 9.5]\n'


def test_a_condition_costs_a_fraction_of_loading_its_config(tmp_path):
    """Measured in processor time, so a busy machine affects both; `python -m benchmarks.sweep` has the numbers."""
    path = sweep_file(tmp_path, rest=COSTS)
    loader = Loader(path, "baseline", None, [])
    begun = time.process_time()
    for i in range(100):
        loader.load({"energy.basic_cost": 0.001 * (i + 1), "energy.initial": 8})
    whole = (time.process_time() - begun) / 100
    begun = time.process_time()
    file = read_sweep(path)
    assert len(file.plan.conditions) == COUNT
    assert (time.process_time() - begun) / COUNT < 0.4 * whole
    assert len(file.bases) == 1, "conditions are differences from one config"
    assert len(file.plan.text()) < 100 * COUNT


FACTORS = {
    "one value in every species": ('base = "predator"', '"birth.kappa" = [0.001, 0.003]\n"hazard.kappa" = [0.01]'),
    "one species beside all": (
        'base = "predator"',
        '"birth.kappa" = [0.001, 0.003]\n"species.prey.birth.kappa" = [0.002, 0.004]',
    ),
    "every food": ("", '"food.*.capacity" = [100, 120]\n"population.capacity" = [150, 200]'),
    "a new food": ("", '"food.berry.capacity" = [30, 50]\n"food.berry.gives.energy" = [1, 2]'),
    "what was not there": ("", '"genome.mutation.w_action.scale" = [0.1, 0.2]\n"energy.initial" = [9, 10]'),
    "a choice and a list": ("", '"birth.mating" = ["none", "pairs"]\n"arena.inner_walls" = [[[10, 10, 60, 60]], []]'),
    "presets": ("", 'preset = ["small", "poison"]\nfidelity = ["corrected", "as_printed"]\n"energy.initial" = [9, 10]'),
    "a policy": ("", '"learning.policy" = ["ppo", "idle"]\n"energy.initial" = [9, 10]'),
}


@pytest.mark.parametrize("name", FACTORS)
def test_conditions_are_the_configs_that_a_run_would_load(name, tmp_path):
    base, factors = FACTORS[name]
    path = tmp_path / "any.toml"
    path.write_text(f"steps = 64\n{base}\n[factor]\n{factors}\n")
    try:
        file = read_sweep(path)
    except ConfigError as error:
        pytest.fail(str(error))
    loader = Loader(path, base.partition('"')[2].rstrip('"') or "baseline", None, [])
    for condition, config in zip(file.plan.conditions, condition_configs(file), strict=True):
        assert config == loader.load(condition.settings).config
        assert condition.digest == digest(config)[:DIGITS]
        assert RunPlan(config, [1], 64, tmp_path).config == config


def test_invalid_settings_are_listed_and_refused_or_left_out(tmp_path):
    path = tmp_path / "some.toml"
    path.write_text(
        'steps = 64\n[factor]\n"population.initial_count" = [50, 150, 250]\n"population.capacity" = [100, 200]\n'
    )
    with pytest.raises(ConfigError) as error:
        read_sweep(path)
    said = str(error.value)
    assert "3 of 6 settings cannot be; --skip-invalid leaves them out" in said
    assert "with population.initial_count = 250, population.capacity = 200: " in said
    file = read_sweep(path, skip_invalid=True)
    kept = [tuple(each.settings.values()) for each in file.plan.conditions]
    assert kept == [(50, 100), (50, 200), (150, 200)]
    assert len(file.left_out) == 3
    path.write_text('steps = 64\n[factor]\n"population.capacity" = [-1, -2]\n')
    with pytest.raises(ConfigError, match="2 of 2 settings cannot be"):
        read_sweep(path, skip_invalid=True)


def test_results_are_read_concurrently(tmp_path, monkeypatch):
    """As many at once as there are readers: each read waits until all of them have started."""
    count = 3 * READERS
    costs = f'[factor]\n"energy.basic_cost" = {{ range = [0.1, 0.2], count = {count} }}\n'
    plan, store = planned(sweep_file(tmp_path, seeds=1, rest=costs), str(tmp_path / "place"))
    for batch in plan.batches():
        content = {"seconds": 1.0, "worlds": [{"seed": 1, "digest": "0", "extinct": False}]}
        store.write(f"results/{batch.name}.json", json.dumps(content).encode())
    together, read = threading.Barrier(READERS, timeout=60), Store.read

    def read_together(self: Store, name: str) -> bytes | None:
        together.wait()
        return read(self, name)

    monkeypatch.setattr(Store, "read", read_together)
    table = collect(plan, store)
    assert table["energy.basic_cost"].to_list() == [each.settings["energy.basic_cost"] for each in plan.conditions]
    assert table["condition"].to_list() == list(range(count))
    assert table.schema["extinct"] == pl.Boolean


def test_a_plan_reads_as_it_was_written(tmp_path):
    rest = (
        '[factor]\n"energy.initial" = [8, 9.5]\n"food.*.capacity" = { range = [100, 140], count = 3 }\n'
        'preset = ["small", "poison"]\n'
    )
    path = tmp_path / "any.toml"
    path.write_text(f'steps = 64\nseeds = "3-5,9"\nworlds = 3\n{rest}')
    plan, store = planned(path, str(tmp_path / "place"))
    again = load_plan(store)
    assert again == plan
    assert again.rounds == ((3, 4, 5), (9,))
    assert next(batch.name for batch in again.batches()).endswith("-64-3-5")
    assert Path(tmp_path / "place" / "plan.json").stat().st_size < 3000
