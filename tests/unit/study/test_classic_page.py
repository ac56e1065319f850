"""The pages on studies of classic claims agree with the tables behind them."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from hedon.assay import Lines
from hedon.statistic import mean_interval
from hedon_studies.lifespan_and_plasticity.study import control_rows, named_test
from hedon_studies.mating_strategies import study as mating
from hedon_studies.optimal_reward import study as optimal
from hedon_studies.optimal_reward.study import FREE, GATED
from hedon_studies.rule import NO, OPEN, YES, by_seed, pair_differences, pair_test, verdict_table
from hedon_studies.two_needs import study as needs
from hedon_studies.two_needs.study import ADDITIVE, PAID

RESULTS = Path(__file__).parents[3] / "docs" / "results"


def answers(*tests) -> list[str]:
    return verdict_table("made_up", tests).rows["answer"].to_list()


def interval(values) -> Any:
    """`mean_interval`, of enough values that it has bounds."""
    return mean_interval(values)


def number(value: Any, digits: int = 3) -> str:
    return f"{value:.{digits}f}".replace("-", "\N{MINUS SIGN}")


def test_the_page_on_lifespans_has_the_numbers_of_its_tables() -> None:
    page = " ".join((RESULTS / "lifespan.md").read_text(encoding="utf-8").split())
    worlds = pl.read_csv(RESULTS / "lifespan" / "worlds.csv")
    assert (worlds.height, worlds["died out"].sum()) == (120, 5)
    assert worlds.filter("died out")["hazard"].unique().to_list() == [4.0]
    found = named_test(worlds.to_dicts())
    assert answers(found) == [YES]
    assert f"{found.effect:.3f} ({found.low:.3f} … {found.high:.3f}) on average over 30 seeds (p {found.p:.2f})" in page
    control = control_rows(worlds.to_dicts(), [name for name in worlds.columns if name.startswith("neutral_")])
    (outside,) = [row for row in control if row["low"] > 0 or row["high"] < 0]
    assert f"shows a larger rise ({outside['effect']:.3f})" in page
    for row in pl.read_csv(RESULTS / "lifespan" / "hazards.csv").iter_rows(named=True):
        bounds = interval(worlds.filter(pl.col("hazard") == row["hazard"])["slope"].to_list())
        assert (row["slope"], row["low"], row["high"]) == pytest.approx((bounds.mean, bounds.low, bounds.high))
        slope_text = f"{row['slope']:.3f} ({row['low']:.3f} … {row['high']:.3f})"
        children = ", ".join(f"{value:.2f}" for value in list(row.values())[8:])
        numbers = f"{row['lifespan']:,.0f} | {row['alive']:.0f} | {slope_text} | {children}"
        assert f"| \N{MULTIPLICATION SIGN} {row['hazard']:g} | {numbers} |" in page


def test_the_page_on_the_optimal_reward_has_the_numbers_of_its_tables() -> None:
    page = " ".join((RESULTS / "optimal-reward.md").read_text(encoding="utf-8").split())
    worlds = pl.read_csv(RESULTS / "optimal-reward" / "worlds.csv")
    assert (worlds.height, worlds["died out"].sum()) == (60, 0)
    rows = worlds.to_dicts()
    slope, difference = optimal.named_tests(rows)
    assert answers(slope, difference) == [YES, YES]
    assert max(row["p (Holm)"] for row in verdict_table("made_up", (slope, difference)).rows.to_dicts()) < 0.0001
    assert f"slope of relative intake of food is {slope.effect:.2f} ({slope.low:.2f} … {slope.high:.2f})" in page
    assert f"smaller by {difference.effect:.2f} ({difference.low:.2f} … {difference.high:.2f})" in page
    pieces = worlds.with_columns(pl.col("slope") * pl.col("food")).to_dicts()
    of_children = interval(pair_differences(rows, (GATED, FREE), "children slope"))
    assert f"two cases is {of_children.mean:.2f} ({of_children.low:.2f} … {of_children.high:.2f}; not" in page
    low, high = (pl.read_csv(RESULTS / "optimal-reward" / "conditions.csv")["unfinished"] * 100).to_list()
    assert f"{low:.0f} % of founders are then alive if food needs water, {high:.0f} % if not" in page
    rates = [interval(by_seed(rows, condition, "rate slope").values()) for condition in (GATED, FREE)]
    rates.append(interval(pair_differences(rows, (GATED, FREE), "rate slope")))
    first, second, change = (f"{bounds.mean:.2f} ({bounds.low:.2f} … {bounds.high:.2f})" for bounds in rates)
    assert f"are {first} and {second}, a difference of {change}" in page
    for values, text in (
        (list(by_seed(pieces, GATED, "slope").values()), "worth {} if food needs water"),
        (list(by_seed(pieces, FREE, "slope").values()), "and {} if not"),
        (pair_differences(pieces, (GATED, FREE), "slope"), "if not, {} more"),
    ):
        bounds = interval(values)
        assert text.format(f"{bounds.mean:.1f} ({bounds.low:.1f} … {bounds.high:.1f})") in page
    neutral = [name for name in worlds.columns if name.startswith("neutral_")]
    outside = [row["test"] for row in optimal.control_rows(rows, neutral) if row["low"] > 0 or row["high"] < 0]
    assert (len(neutral), outside) == (16, ["difference"])
    for row in pl.read_csv(RESULTS / "optimal-reward" / "conditions.csv").iter_rows(named=True):
        intervals = []
        for name, key in (("slope", "slope"), ("children slope", "children slope")):
            bounds = interval(by_seed(rows, row["condition"], key).values())
            assert row[name] == pytest.approx(bounds.mean)
            intervals.append(f"{bounds.mean:.2f} ({bounds.low:.2f} … {bounds.high:.2f})")
        intake = list(row.values())[-4:]
        eaten = ", ".join(f"{value:.1f}" for value in intake)
        assert f"| {row['condition']} | {row['alive']:.0f} | {' | '.join(intervals)} | {eaten} |" in page


def test_the_page_on_two_needs_has_the_numbers_of_its_tables() -> None:
    page = " ".join((RESULTS / "two-needs.md").read_text(encoding="utf-8").split())
    worlds = pl.read_csv(RESULTS / "two-needs" / "worlds.csv")
    assert (worlds.height, worlds["died out"].sum()) == (120, 0)
    rows = worlds.to_dicts()
    tests = needs.named_tests(rows)
    table = verdict_table("made_up", tests).rows.to_dicts()
    assert [row["answer"] for row in table] == [OPEN, OPEN, NO]
    for row in table:
        bounds = f"{number(row['effect'])} ({number(row['low'])} … {number(row['high'])}; p {row['p (Holm)']:.2f})"
        assert bounds in page
    found = needs.follow_up(rows)
    assert answers(found) == [OPEN]
    assert f"{number(found.effect)} ({number(found.low)} … {number(found.high)}; p {found.p:.2f}) more" in page
    unplanned = pair_test("additive, larger pay", rows, (ADDITIVE, PAID), "change")
    assert f"by {number(unplanned.effect)} ({number(unplanned.low)} … {number(unplanned.high)}) more than" in page
    assert f"from {number(worlds['change'].min(), 2)} to {number(worlds['change'].max(), 2)}" in page
    for row in pl.read_csv(RESULTS / "two-needs" / "conditions.csv").iter_rows(named=True):
        bounds = interval(by_seed(rows, row["condition"], "change").values())
        assert row["change"] == pytest.approx(bounds.mean)
        change = f"{number(bounds.mean)} ({number(bounds.low)} … {number(bounds.high)})"
        eaten = [
            ", ".join(f"{row[f'{group} {kind}']:.1f}" for kind in ("food", "water")) for group in ("reducers", "eaters")
        ]
        assert (
            f"| {row['condition']} | {row['alive']:.0f} | {row['generations']:.1f} | {change} | {' | '.join(eaten)} |"
            in page
        )
        worlds_of = worlds.filter(condition=row["condition"])
        for kind in ("food", "water"):
            less = interval((worlds_of[f"reducers {kind}"] - worlds_of[f"eaters {kind}"]).to_list())
            assert less.mean < 0
            if (row["condition"], kind) == (ADDITIVE, "food"):
                assert f"{number(less.mean, 2)} ({number(less.low, 2)} … {number(less.high, 2)})" in page
            else:
                assert less.high < 0


def test_the_page_on_mating_has_the_numbers_of_its_tables() -> None:
    page = " ".join((RESULTS / "mating.md").read_text(encoding="utf-8").split())
    worlds = pl.read_csv(RESULTS / "mating" / "worlds.csv")
    assert (worlds.height, worlds["died out"].sum()) == (150, 0)
    for start, share in ((0.05, 0.0), (0.95, 1.0)):
        some = worlds.filter(pl.col("foragers") == start)
        rare_one = (some["end"] - some["start"]) * (1 if start < 0.5 else -1)
        bounds = interval(rare_one.to_list())
        change = f"{'+' if bounds.mean > 0 else ''}{number(bounds.mean)} ({number(bounds.low)} … {number(bounds.high)}"
        assert f"changes by {change}" in page
        lost = int((some["end"] == share).sum())
        (row,) = pl.read_csv(RESULTS / "mating" / "shares.csv").filter(pl.col("share at the start") == start).to_dicts()
        only_foragers, only_trackers = list(row.values())[8:10]
        assert lost == (only_trackers if start < 0.5 else only_foragers)
    lines = {0.05: [], 0.95: []}
    for row in worlds.filter(pl.col("foragers").is_in(list(lines))).iter_rows(named=True):
        share = np.array([row["start"], row["end"]])
        time, count = np.arange(2), np.stack([share, 1 - share], axis=1)
        lines[row["foragers"]].append(
            Lines(row["seed"], time, count, time.astype(float), np.zeros(0), np.zeros(0), ended=row["died out"])
        )
    table = verdict_table("made_up", mating.invasion_tests(lines), named=mating.NAMED).rows
    assert table["answer"].to_list() == [OPEN, OPEN]
    for row in table.iter_rows(named=True):
        assert re.search(rf"open: \+{row['effect']:.3f}[^|]*\(p {row['p (Holm)']:.2f}\)", page)
    rare = worlds.filter(pl.col("foragers").is_in([0.05, 0.95]))
    assert f"in {rare['end'].is_in([0.0, 1.0]).sum()} of {rare.height}" in page
    slope, crossing = pl.read_csv(RESULTS / "mating" / "frequency.csv").iter_rows(named=True)
    assert f"is +{slope['value']:.3f} per generation ({number(slope['low'])} … {number(slope['high'])})" in page
    assert crossing["value"] is None
    line = pl.read_csv(RESULTS / "mating" / "line.csv")
    above = line.filter(pl.col("low") > 0)["share"]
    assert f"between {100 * above[0]:.0f} and {100 * above[-1]:.0f} % foragers" in page
    (half,) = line.filter((pl.col("share") - 0.5).abs() < 1e-9).to_dicts()
    assert f"(+{half['line']:.3f} per generation at a half, {half['low']:.3f} … {half['high']:.3f})" in page
    overall = worlds.group_by("seed").agg((pl.col("end") - pl.col("start")).mean())["end"]
    bounds = interval(overall.to_list())
    assert f"increase by {bounds.mean:.3f} ({bounds.low:.3f} … {bounds.high:.3f})" in page
    for row in pl.read_csv(RESULTS / "mating" / "shares.csv").iter_rows(named=True):
        some = worlds.filter(pl.col("foragers") == row["share at the start"])
        assert row["share at the end"] == pytest.approx(some["end"].mean())
        selection = f"{'+' if row['s'] > 0 else ''}{number(row['s'])} ({number(row['low'])} … {number(row['high'])})"
        only_foragers, only_trackers = list(row.values())[8:10]
        cells = f"{100 * row['share at the end']:.1f} % | {selection} | {only_foragers} | {only_trackers}"
        assert f"| {100 * row['share at the start']:.0f} % | {cells} |" in page
    types = pl.read_csv(RESULTS / "mating" / "types.csv")
    foragers, trackers = (types.filter(type=name) for name in ("foragers", "trackers"))
    living = [100 * part["living above the threshold"] for part in (foragers, trackers)]
    ranges = [f"{part.min():.0f} to {part.max():.0f} % of" for part in living]
    assert f"At the end, {ranges[0]} foragers and {ranges[1]} trackers" in page
    assert (trackers["children per 1,000,000 steps"] > foragers["children per 1,000,000 steps"]).all()
    assert (trackers["food per 1,000 steps"] < foragers["food per 1,000 steps"]).all()
    assert (trackers["deaths per 1,000,000 steps"] > foragers["deaths per 1,000,000 steps"]).all()
