"""Measures that a config adds: shown wherever those of the catalog are, and checked before anything runs."""

from pathlib import Path

import polars as pl
import pytest
from command import hedon
from polars.exceptions import PolarsError
from worlds import QUICK

from hedon import ArgumentError, RunPlan, load_config, make, run
from hedon.analysis import read_worlds
from hedon.compare.contrast import compare_answer
from hedon.compare.power import spreads
from hedon.compare.source import read_table
from hedon.compare.sweep_answer import settings_table
from hedon.config import Config, ConfigError, digest
from hedon.ensemble.collect import collect
from hedon.ensemble.plan import load_bases, load_plan
from hedon.ensemble.store import Store
from hedon.measure.summary_key import FARE_KEYS, RESERVED, RUN_KEYS, WORLD_KEYS
from hedon.measure.world_measure import measures_of, own_measure, own_measures, titles_of
from hedon.record.reader import open_run
from hedon.report.run import run_summary
from hedon.study.claim import Claim
from hedon.study.item import Condition
from hedon.study.verdict import judge

OWN = """preset = "{preset}"

[measure.turnover]
of = "sum(births) + sum(deaths)"
title = "births and deaths"

[measure.oldest]
table = "agents"
of = "max(coalesce(death_step, 192) - birth_step)"
"""


def config_of(folder: Path, preset: str = "baseline", text: str = OWN) -> Config:
    path = folder / "mine.toml"
    path.write_text(text.format(preset=preset), encoding="utf-8")
    return load_config(path, overrides=[*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01"])


@pytest.mark.parametrize("preset", ["baseline", "predator"])
def test_a_measure_of_a_config_appears_in_summaries_tables_comparisons_and_claims(tmp_path: Path, preset: str) -> None:
    config = config_of(tmp_path, preset)
    for name, cost in (("a", 0.001), ("b", 0.01)):
        run(RunPlan(config.with_("energy.basic_cost", cost), (1, 2, 3), 192, tmp_path / name))
    found = open_run(tmp_path / "a")
    worlds, summary = read_worlds([found]), run_summary(found)
    rows = found.population().group_by("world").agg(pl.col("births").sum() + pl.col("deaths").sum()).sort("world")
    several = len(config.species) > 1
    parts = summary["species"] if several else {"": summary}
    values = [sum(world["species"][name]["turnover"] for name in parts) if several else world["turnover"]
              for world in summary["worlds"]]  # fmt: skip
    assert values == rows["births"].to_list()
    assert summary["measures"] == {"turnover": "births and deaths", "oldest": "oldest"}
    assert all(part["turnover"]["worlds"] == 3 and part["oldest"]["mean"] <= 192 for part in parts.values())

    printed = hedon("report", "a", "--figures", "none", cwd=tmp_path)
    assert "births and deaths" in printed.stdout, printed.stderr
    table = read_table(str(tmp_path))
    shown = compare_answer(table, "condition").tables[0]
    title = "births and deaths: prey" if several else "births and deaths"
    assert title in shown.rows["measure"].to_list()
    assert any(each.measure == title for each in spreads(table))

    claim = Claim("lively", Condition(preset), "many come and go", own_measure("turnover").of, "mean", "> 0", low=0.0)
    mine = [world for world in worlds if world.species == worlds[0].species]
    known = [value for world in mine if (value := own_measure("turnover").value(world)) is not None]
    assert judge(claim, preset, mine).value == pytest.approx(sum(known) / 3)


def test_sweeps_have_the_measures_of_their_base(tmp_path: Path) -> None:
    quick = ", ".join(f'"{path}" = {value}' for path, _, value in (each.partition("=") for each in QUICK))
    config_of(tmp_path)
    (tmp_path / "sweep.toml").write_text(
        f'base = "mine.toml"\nsteps = 128\nseeds = "1-2"\nset = {{ {quick} }}\n'
        '[factor]\n"energy.basic_cost" = [0.001, 0.004]\n',
        encoding="utf-8",
    )
    done = hedon("sweep", "run", "sweep.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "births and deaths" in done.stdout
    store = Store(str(tmp_path / "sweeps" / "sweep"))
    plan = load_plan(store)
    table = settings_table(plan, collect(plan, store), titles=titles_of(load_bases(plan, store)))
    assert "births and deaths" in table.rows.columns
    refused = hedon("sweep", "check", "sweep.toml", "--set", "measure.turnover.of=sum(birth)", cwd=tmp_path)
    assert refused.returncode == 2


def test_a_measure_changes_no_digest_and_is_kept(tmp_path: Path) -> None:
    mine = config_of(tmp_path)
    plain = load_config("baseline", overrides=[*QUICK, "birth.kappa=0.05", "hazard.alpha_age=0.01"])
    assert digest(mine) == digest(plain)
    run(RunPlan(mine, (1,), 64, tmp_path / "run"))
    assert open_run(tmp_path / "run").config.measure == mine.measure
    assert hedon("resume", "run", "--steps", "128", cwd=tmp_path).returncode == 0
    assert hedon("check", "run", "--replay", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('[measure.rate]\nof = "sum(birth)"', "the table population has no column birth .*did you mean births"),
        ('[measure.rate]\nof = "births"', "must give one number for all rows: use aggregates"),
        ('[measure.rate]\nof = "sum("', "cannot be computed: unable to parse"),
        ("[measure.rate]\nof = \"'much'\"", "must give a number, not String"),
        ('[measure.rate]\ntitle = "no expression"', r"measure\.rate\.of = \"\": must be an expression"),
        ('[measure.rate]\nof = "1"\ntable = "frames"', 'must be one of "population", "agents"'),
        ('[measure.alive_mean]\nof = "sum(births)"', "is the name of something that summaries have already"),
        ('[measure.worlds]\nof = "sum(births)"', "is the name of something that summaries have already"),
        ('[measure.w_rate]\nof = "sum(births)"', "is the name of something that summaries have already"),
        ('[measure.Rate]\nof = "sum(births)"', "must have from 1 to 40 lower-case letters"),
        ('[measure.rate]\nvalue = "sum(births)"', r"measure\.rate\.value"),
    ],
)
def test_a_faulty_measure_is_refused_before_a_run(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        RunPlan(config_of(tmp_path, text=text), (1,), 64, tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_driven_worlds_are_refused_with_a_wrong_measure(tmp_path: Path) -> None:
    config = config_of(tmp_path, text='[measure.rate]\nof = "births"')
    with pytest.raises((ConfigError, ArgumentError), match="must give one number for all rows"):
        make(config, record=tmp_path / "run")


def test_names_of_keys_are_reserved(tmp_path: Path) -> None:
    assert {*RUN_KEYS, *WORLD_KEYS, *FARE_KEYS} <= RESERVED
    config = config_of(tmp_path)
    assert list(measures_of(config))[-2:] == ["turnover", "oldest"]
    assert own_measures(load_config("baseline")) == {}
    with pytest.raises(PolarsError):
        pl.sql_expr("(")
