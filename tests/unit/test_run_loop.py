"""The host loop's records."""

import polars as pl

from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.run import run

# A window with far more deaths than the engine's buffer of 16 per slot can hold.
BRIEF = (
    "world.rollout_steps=16384",
    "learning.update_epochs=0",
    "population.capacity=12",
    "population.initial_count=12",
    "energy.initial=400",
    "energy.basic_cost=0",
    "food.normal.growth_rate=0",
    "hazard.alpha_age=0.02",
    "birth.kappa=0.5",
)


class Shown:
    """A display that keeps all moments."""

    def __init__(self):
        self.moments = []

    def update(self, moment):
        self.moments.append(moment)

    @property
    def last(self):
        return self.moments[-1]


def test_every_death_is_kept_however_many_a_window_has(tmp_path):
    config = load_config("baseline", overrides=BRIEF)
    run(RunPlan(config, (1,), 1500, tmp_path / "run", threads=1))
    dead = pl.read_parquet(tmp_path / "run" / "agents" / "*.parquet").filter(pl.col("death_step").is_not_null())
    assert len(dead) > 16 * 12
    assert dead["agent_id"].n_unique() == len(dead)
    population = pl.read_parquet(tmp_path / "run" / "population" / "*.parquet")
    assert population["deaths"].sum() == len(dead)


def test_the_last_moment_shown_is_the_last_row_even_within_a_window(tmp_path):
    display = Shown()
    run(RunPlan(load_config("baseline", overrides=BRIEF), (1,), 500, tmp_path / "run", threads=1), [display.update])
    row = pl.read_parquet(tmp_path / "run" / "population" / "*.parquet").sort("step").row(-1, named=True)
    assert (display.last.step, row["step"]) == (500, 500)
    assert [moment.step for moment in display.moments].count(500) == 1
    assert {name: display.last.rows[0][name] for name in ("alive", "births", "deaths")} == {
        name: row[name] for name in ("alive", "births", "deaths")
    }


def test_each_of_several_species_is_shown_with_the_step_of_its_extinction(tmp_path):
    """The predators die out first, and the world continues."""

    settings = (
        *("world.rollout_steps=256", "learning.update_epochs=0", "birth.kappa=0", "hazard.form=constant"),
        *("species.prey.population.initial_count=12", "species.predator.population.initial_count=4"),
        *("species.prey.hazard.kappa=0.01", "species.predator.hazard.kappa=0.2"),
    )
    display = Shown()
    run(RunPlan(load_config("predator", overrides=settings), (1,), 500, tmp_path / "run", threads=1), [display.update])
    dead = (
        pl.read_parquet(tmp_path / "run" / "agents" / "*.parquet").group_by("species").agg(pl.col("death_step").max())
    )
    last = dict(dead.iter_rows())
    assert last["predator"] < last["prey"]
    assert display.last.extinct == (last["prey"], last["predator"])
