"""The numbers on pages about contests match the tables next to them."""

import re
from typing import Any

import pytest
from result_page import coefficient, p_of, p_text, page, shares, small, span, text
from scipy import stats

from hedon.statistic import holm

CONTESTS = (1, 2, 3, 5, 8)
ARMS = {
    "ten times the rate": "rate-10",
    "ten times the bonus": "entropy-10",
    "no bonus": "entropy-0",
    "gamma 0.99": "gamma-99",
}
"""Ways of learning, as the page names them, and the folder of each."""
SCALES = {"rewards of unit variance": "scaled", "advantages normalized": "normalized"}
"""The same for ways in which the size of a reward matters less."""


def test_contests_of_24_worlds():
    each = [shares(f"food-{food}-24") for food in CONTESTS]
    p = [p_of(values) for values in each]
    shown = page("start.md")
    for food, values, own, corrected in zip(CONTESTS, each, p, holm(p), strict=True):
        s, bounds = coefficient(f"food-{food}-24")
        row = re.search(rf"^\| food {food} .*$", shown, re.MULTILINE)
        assert row is not None
        assert f"| {text(s, 3)} {bounds} | {span(values, 3, sign=False)} | {(values > 0).sum()}" in row[0]
        number = re.findall(r"[\d.]+", row[0].split("|")[-3] + row[0].split("|")[-2])
        assert [float(each) for each in number] == [
            pytest.approx(value, abs=0.0051 if value > 0.01 else 0.0005) for value in (own, corrected)
        ]


@pytest.mark.parametrize("arms", [ARMS, SCALES], ids=["learning", "scale"])
def test_rows_of_contests_by_other_ways_of_learning(arms):
    """Each row of the page: the share itself, then its difference from the baseline's learning, paired by seed."""
    each = {arm: shares(f"food-5-{name}") for arm, name in arms.items()}
    pairs = {arm: values - shares("food-5-24") for arm, values in each.items()}
    alone, paired = ([p_of(values) for values in found.values()] for found in (each, pairs))
    shown = page("start.md")
    for arm, p, corrected, q, q_corrected in zip(arms, alone, holm(alone), paired, holm(paired), strict=True):
        s, bounds = coefficient(f"food-5-{arms[arm]}")
        above = (each[arm] > 0).sum()
        row = re.search(rf"^\| \[{re.escape(arm)}\].*$", shown, re.MULTILINE)
        assert row is not None
        assert f"| {text(s, 3)} {bounds} | {span(each[arm])} | {above} | {p_text(p)} | {p_text(corrected)} |" in row[0]
        assert row[0].endswith(f"| {span(pairs[arm])} | {p_text(q)} | {p_text(q_corrected)} |")


def test_the_arm_in_which_the_large_reward_wins():
    each = {arm: shares(f"food-5-{name}") for arm, name in ARMS.items()}
    alone, rate = [p_of(values) for values in each.values()], each["ten times the rate"]
    shown = " ".join(page("start.md").split())
    above = (rate - shares("food-5-24") > 0).sum()
    assert (
        f"in {(rate > 0).sum()} of 24 worlds, and its share is larger than at the baseline's rate in {above}." in shown
    )
    own, corrected = p_text(alone[0]), p_text(holm(alone)[0])
    assert f"(24 worlds; t test, p {own}, Holm-corrected {corrected})" in " ".join(page("README.md").split())
    mean, bounds = span(rate, sign=False).split(" ", 1)
    told = f"{mean} above one half {bounds[:-1].replace(' …', ' to')}, p {own}, {corrected} with Holm's correction"
    article = page("../paper/paper.md").replace("\n", " ")
    assert f"{told} over the four)" in article
    scaled, normalized = (
        span(shares(f"food-5-{name}")).replace(" (", ", ").replace(" …", " to") for name in SCALES.values()
    )
    assert f"({scaled[:-1]}, and {normalized}" in article


def test_contests_of_eight_worlds_are_tested_across_worlds():
    shown = page("start.md")
    for name in ("food", "paper"):
        values = shares(name)
        signed_rank: Any = stats.wilcoxon(values)
        assert f"{p_of(values):.3f} by t, {signed_rank.pvalue:.3f} by Wilcoxon" in shown


def test_the_contest_of_64_worlds_on_a_device():
    """Each number in the section, the scoreboard and the paper comes from the table of worlds."""
    values = shares("food-5-rate-10-64")
    s, bounds = coefficient("food-5-rate-10-64")
    assert len(values) == 64
    end = f"the share at the end {span(values)} above one half, in {(values > 0).sum()} of 64 worlds"
    told = f"s is {text(s, 3)} {bounds}, {end}; p {small(p_of(values))} by t"
    assert told in " ".join(page("start.md").split())
    shown = " ".join(page("README.md").split())
    assert "[in 64 new worlds](start.md#again-with-64-worlds-made-by-a-device)" in shown
    assert f"(s {text(s, 3)} {bounds}, p {small(p_of(values))})" in shown
    told = f"in 64 new worlds its share is {span(values)[:-1].replace(' …', ' to')}, p {small(p_of(values))})"
    assert told in page("../paper/paper.md").replace("\n", " ")
