"""What founders have learned: the questions that are put to their networks, and the tests of the answers."""

from pathlib import Path

import numpy as np
import polars as pl
import ppo_reference
import pytest

import hedon
from hedon_studies.rule import NO, OPEN, YES
from hedon_studies.same_genes_another_learner import behavior
from hedon_studies.same_genes_another_learner.answer import NONE
from hedon_studies.same_genes_another_learner.landscape import FOOD, SIGHT


@pytest.fixture(scope="module")
def world() -> hedon.World:
    simulation = hedon.Simulation(behavior.config_of("fast"), [3])
    simulation.run(1)
    return simulation.worlds[0]


def test_the_networks_are_those_of_the_engine(world: hedon.World) -> None:
    seen = world.observations()[:5]
    actions, values = behavior.forward(world.state.params[world.living][:5], seen)
    for i in range(5):
        reference = ppo_reference.forward(world.state.params[world.living][i].astype(float), seen[i : i + 1])[2][0]
        assert [*actions[i], values[i]] == pytest.approx(reference, abs=1e-5)


def test_an_agent_that_turns_to_food_steers_and_one_that_turns_away_does_not(
    world: hedon.World, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = behavior.config_of("fast")
    rays = config.species["agent"].sensor.ray_count

    def turns(params: np.ndarray, seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        food = seen[:, rays : 2 * rays]
        right, left = food[:, : rays // 2].sum(axis=1), food[:, rays // 2 :].sum(axis=1)  # rays go from right to left
        toward = np.where(np.arange(len(seen)) % 2 == 0, 1.0, -1.0) * (left - right)
        return np.column_stack([-toward, toward]), food.max(axis=1)

    monkeypatch.setattr(behavior, "forward", turns)
    answers = behavior.probe(world, config)
    assert (answers["steering"][::2] > 0.9).all(), "the right motor turns the body to the left"
    assert (answers["steering"][1::2] < -0.9).all()
    assert answers["value"] == pytest.approx(behavior.NEAR + 1)
    assert answers["approach"] == pytest.approx(0)


def test_slopes_are_those_of_the_genes() -> None:
    rng = np.random.default_rng(1)
    genes = {name: rng.uniform(-2, 2, 500) for name in (SIGHT, FOOD)}
    found = behavior.slopes(genes, 1 + 0.3 * genes[SIGHT] - 0.1 * genes[FOOD])
    assert found == pytest.approx({SIGHT: 0.3, FOOD: -0.1})


def answers(sight: float, food: float, worlds: int = 30) -> pl.DataFrame:
    """Rows of worlds in which the fast learner's slopes exceed the baseline's by these numbers, only early."""
    rng = np.random.default_rng(2)
    return pl.DataFrame(
        {
            "learner": learner,
            "seed": seed,
            "step": step,
            "measure": measure,
            "mean": 0.0,
            SIGHT: 0.1 + rng.normal(0, 0.01) + sight * (learner == "fast" and step <= behavior.EARLY),
            FOOD: 0.1 + rng.normal(0, 0.01) + food * (learner == "fast" and step <= behavior.EARLY),
        }
        for learner in ("baseline", "fast")
        for seed in range(worlds)
        for step in (behavior.EARLY, behavior.STEPS)
        for measure in ("intake", "steering", "value")
    )


def test_a_steeper_slope_on_sight_alone_is_found_and_one_on_both_is_not() -> None:
    turned = {row["test"]: row for row in behavior.named_tests(answers(0.05, 0.0)).iter_rows(named=True)}
    primary = turned["primary: early intake, sight less food"]
    assert primary["effect"] == pytest.approx(0.05, abs=0.01)
    assert primary["low"] > 0
    assert turned["early steering, sight"]["low"] > 0
    assert turned["late intake, sight"]["low"] < 0 < turned["late intake, sight"]["high"]
    larger = behavior.named_tests(answers(0.05, 0.05)).row(0, named=True)
    assert larger["low"] < 0 < larger["high"]


def test_answers_follow_from_the_expectation() -> None:
    rows = answers(0.05, 0.0)
    slow = rows.filter(pl.col("learner") == "baseline").with_columns(learner=pl.lit("slow"))
    found = behavior.answers(pl.concat([rows, slow]))
    came = dict(found.select("test", "answer").iter_rows())
    assert came["primary: early intake, sight less food"] == YES
    assert came["late intake, sight"] == NONE
    assert came["early value, sight"] == NO, "it changes by half of the baseline's slope"
    assert came["early value, food"] == YES
    assert set(behavior.answers(rows)["answer"]) == {OPEN, NONE}, "the slow learner has not run"


def test_worlds_are_simulated_and_tested(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for learner in ("baseline", "fast"):
        words = ["run", learner, "1", "2", str(tmp_path / f"{learner}.parquet"), "--steps", "1024"]
        behavior.main(words)
    rows = pl.read_parquet(tmp_path / "fast.parquet")
    assert rows.select("seed", "step", "measure").rows() == [
        (seed, 1024, measure) for seed in (1, 2) for measure in ("intake", "steering", "approach", "value")
    ]
    behavior.main(["tests", str(tmp_path / "baseline.parquet"), str(tmp_path / "fast.parquet")])
    assert "primary: early intake" in capsys.readouterr().out
