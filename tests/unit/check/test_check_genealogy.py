"""The rules on agents and their parents, checked on small tables."""

from dataclasses import replace

import polars as pl
import pytest

from hedon.check.genealogy import check_agents
from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run
from hedon.record.manifest import Manifest


def family(rows: list[tuple[int, int | None, int | None, int]]) -> pl.DataFrame:
    """Agents of one world: id, first and second parent, generation; the child is the last."""
    ids = {"agent_id": pl.Int64, "parent_id": pl.Int64, "mate_id": pl.Int64, "generation": pl.Int64}
    agents = pl.DataFrame(rows, schema=ids, orient="row")
    birth = pl.when(pl.col("parent_id").is_null() & (pl.col("generation") == 0)).then(0).otherwise(pl.col("generation"))
    return agents.with_columns(
        world=pl.lit(0), seed=pl.lit(1), birth_step=10 * birth, death_step=pl.lit(None, pl.Int64), energy=pl.lit(1.0),
        birth_energy=pl.lit(1.0), children=pl.lit(0),
    )  # fmt: skip


@pytest.mark.parametrize("lost", [None, 1, 4])
@pytest.mark.parametrize(("generation", "wrong"), [(3, False), (2, True), (4, True)])
def test_a_generation_is_checked_only_if_both_parents_are_recorded(manifest, lost, generation, wrong):
    rows = [(0, None, None, 0), (1, None, None, 0), (2, 0, 1, 1), (4, 2, 1, 2), (5, 1, 4, generation)]
    agents = family([row for row in rows if row[0] != lost])
    found = [finding.what for finding in check_agents(agents, manifest, None, complete=False)]
    assert any("agent 5: its generation" in what for what in found) == (wrong and lost is None)


@pytest.fixture
def manifest(tmp_path) -> Manifest:
    """The manifest of a run of one world that was killed."""
    config = load_config("baseline", overrides=["population.initial_count=2", "population.capacity=2"])
    return replace(run(RunPlan(config, (1,), 1, tmp_path / "run", 1)), status="running")
