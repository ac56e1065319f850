import dataclasses
from pathlib import Path

import polars as pl
import pytest
from synthetic_run import write_run

from hedon.analysis.agent.cohort import complete_share, genome_distribution, window_bounds, with_cohorts
from hedon.analysis.agent.reproduction import reproduction
from hedon.analysis.world.budget import energy_budget
from hedon.analysis.world.record import by_condition, read_worlds
from hedon.record.reader import open_run

AGENTS = pl.DataFrame(
    {
        "agent_id": list(range(6)),
        "birth_step": [0, 0, 49, 50, 99, 100],
        "death_step": [10, None, 60, 70, 110, None],
        "children": [3, 0, 0, 12, 0, 0],
        "w_normal": [1.0, 2.0, 3.0, 5.0, 6.0, 7.0],
        "neutral_1": [0.0] * 6,
    }
)


def test_cohorts_cut_the_run_into_equal_windows() -> None:
    rows = with_cohorts(AGENTS, 100, 2)
    assert rows["window"].to_list() == [0, 0, 0, 1, 1, 1]  # born at the very end: in the last window
    assert window_bounds(100, 2).tolist() == [0, 50, 100]
    assert with_cohorts(AGENTS, 0, 3)["window"].to_list() == [0, 0, 2, 2, 2, 2]


def test_genomes_by_cohort() -> None:
    found = genome_distribution(with_cohorts(AGENTS, 100, 2), ["w_normal", "neutral_1"])
    first = found.row(0, named=True)
    assert (first["window"], first["weight"], first["agents"], first["mean"]) == (0, "w_normal", 3, 2.0)
    assert first["sd"] == 1
    assert found.filter(pl.col("weight") == "w_normal")["q25"].to_list() == [1.5, 5.5]


def test_lifetime_reproductive_success() -> None:
    found = reproduction(AGENTS)
    assert found["complete"] == complete_share(AGENTS) == pytest.approx(4 / 6)
    assert found["mean"] == 2.5
    assert found["variance"] == pytest.approx(23.1)
    assert found["opportunity"] == pytest.approx(23.1 / 6.25)
    assert found["childless"] == pytest.approx(4 / 6)
    assert found["top_tenth"] == pytest.approx(12 / 15)
    assert [found[name] for name in found if name.startswith("with_")] == [4, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]
    assert reproduction(AGENTS.head(0))["mean"] is None


def test_the_budget_agrees_with_the_ledger(tmp_path: Path) -> None:
    run = open_run(write_run(tmp_path / "run", worlds=1, intervals=20, snapshot=False))
    rows = run.population()
    found = energy_budget(rows)
    lived = rows["agent_steps"].to_numpy().sum() / 1000
    assert found is not None
    assert found["basic"] == pytest.approx(1.0)  # 1e-3 per step
    assert found["eaten"] == pytest.approx(rows["energy_eaten"].to_numpy().sum() / lived)
    assert found["forgiven_share"] == pytest.approx(found["forgiven"] / (found["basic"] + found["action"]))
    assert energy_budget(rows.head(0)) is None


def test_worlds_of_equal_config_are_one_condition_and_a_seed_counts_once(tmp_path: Path) -> None:
    short = open_run(write_run(tmp_path / "short", worlds=2, intervals=5, snapshot=False))
    long = open_run(write_run(tmp_path / "long", worlds=3, intervals=9, snapshot=False))
    other = open_run(write_run(tmp_path / "other", worlds=1, intervals=5, extinct=0, snapshot=False))
    digests = {"short": "a", "long": "a", "other": "b"}
    runs = []
    for run in (short, long, other):
        manifest = dataclasses.replace(run.manifest, config_digest=digests[run.path.name])
        runs.append(dataclasses.replace(run, manifest=manifest))
    groups = by_condition(read_worlds(runs))
    assert list(groups) == ["baseline (corrected)", "baseline (corrected) [other]"]
    first = groups["baseline (corrected)"]
    assert [world.seed for world in first] == [1, 2, 3]
    assert all(world.run == "long" and world.last_step == 9 * 1024 for world in first)
    assert first[0].weight_names == ("w_normal", "w_action", "neutral_1")
    assert first[0].agents["agent_id"].is_sorted()
