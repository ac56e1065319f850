"""The committed verdicts on the corrected worlds of full length agree with the tool's rules.

The records of these worlds are too large to keep, so the rules are applied to the table of worlds.
`PYTHONPATH=tests uv run python -m repository.test_full_length` writes the verdicts again.
"""

from collections.abc import Callable, Mapping
from dataclasses import asdict, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import polars as pl
from project_files import ROOT
from result_page import page, table, text

from hedon.config import digest, load_config
from hedon.statistic.interval import distance_interval
from hedon.study.verdict import Verdict, judge
from hedon_studies.kanagawa_doya_2024.claim import CLAIMS

VERDICTS = ROOT / "docs" / "results" / "full-six" / "tables" / "verdict.csv"
CONDITION = "baseline (corrected)"
WEIGHTS = ("w_normal", "w_action")
COLUMNS: Mapping[str, Callable[[Mapping[str, Any]], float]] = {
    "food weight positive": lambda world: world["w_normal"],
    "food weight above 4": lambda world: world["w_normal"] - 4.0,
    "two modes of action": lambda world: world["w_action"],
    "food weight no random walk": lambda world: world["w_normal_score"],
    "action weight no random walk": lambda world: world["w_action_score"],
    "mean lifetime": lambda world: world["mean_lifetime"],
    "food per step": lambda world: world["food_per_step"],
    "population": lambda world: world["alive_mean"],
    "generation": lambda world: world["generation"],
    "extinction": lambda world: world["extinct_step"],
}
"""The measure of a world for each claim about the baseline, except its lifespan, which is the same in all worlds."""


def verdicts() -> list[Verdict]:
    """The verdicts of the rules on the worlds in the table."""
    rows = table("full-six/worlds.csv").to_dicts()
    worlds: list[Any] = [
        SimpleNamespace(row=row, extinct_step=row["extinct_step"], last_step=row["steps"], condition=CONDITION)
        for row in rows
    ]
    settings = digest(load_config("baseline"))
    claims = [
        claim for claim in CLAIMS if claim.name in COLUMNS and digest(claim.condition.config("corrected")) == settings
    ]
    assert {claim.name for claim in claims} == COLUMNS.keys()
    return [
        judge(replace(claim, measure=lambda world, of=COLUMNS[claim.name]: of(world.row)), CONDITION, worlds)
        for claim in claims
    ]


def as_table() -> pl.DataFrame:
    return pl.DataFrame([asdict(verdict) for verdict in verdicts()])


def test_the_verdicts_follow_from_the_rules():
    assert VERDICTS.read_text(encoding="utf-8") == as_table().write_csv()


def test_the_page_has_each_world():
    shown, worlds = page("baseline.md"), table("full-six/worlds.csv")
    assert worlds["seed"].to_list() == list(range(101, 107))
    for column, show in (
        ("mean_lifetime", lambda value: f"{value:,.0f}"),
        ("food_per_step", lambda value: f"{value:.5f}"),
        ("alive_mean", lambda value: f"{value:.0f}"),
        ("generation", lambda value: f"{value:.0f}"),
        ("w_normal", lambda value: text(value, 2)),
        ("w_action", lambda value: text(value, 2)),
    ):
        assert f"| {' | '.join(map(show, worlds[column]))} |" in shown, column


def test_the_page_has_how_far_the_weights_moved():
    shown, worlds = " ".join(page("baseline.md").split()), table("full-six/worlds.csv")
    scores = {name: worlds[f"{name}_score"].to_numpy() for name in WEIGHTS}
    neutral = worlds.select(f"neutral_{i}_score" for i in range(1, 17)).to_numpy().ravel()
    food, action, control = (
        "{:.2f} ({:.2f} … {:.2f})".format(*distance_interval(each)) for each in (*scores.values(), neutral)
    )
    assert f"are {food} for food and {action} for action" in shown
    assert f"{np.sum(np.abs(neutral) > 1.96)} of {neutral.size} neutral genes" in shown
    assert f"a root mean square of {control}" in shown


if __name__ == "__main__":
    VERDICTS.parent.mkdir(exist_ok=True)
    as_table().write_csv(VERDICTS)
