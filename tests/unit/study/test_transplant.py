"""Parts C and D of the study of another learner: evolved genomes compete, and live with decoys."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import hedon
from hedon_studies.rule import NO, OPEN, YES
from hedon_studies.same_genes_another_learner import behavior, decoy, evolution, swap
from hedon_studies.same_genes_another_learner.study import LEARNERS
from hedon_studies.same_genes_another_learner.transplant import Part

PAIR = 1101


@pytest.fixture(scope="module")
def evolved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The tables of part B for one pair of short worlds."""
    folder = tmp_path_factory.mktemp("evolved")
    for arm, condition in LEARNERS.items():
        hedon.run(hedon.RunPlan(condition.config("corrected"), [PAIR], 64, folder / arm))
    evolution.reduce_runs([folder / arm for arm in LEARNERS], folder / "tables")
    return folder / "tables"


@pytest.mark.parametrize("part", [swap.PART, decoy.PART], ids=["swap", "decoy"])
def test_worlds_of_evolved_genomes_are_run_and_reduced(
    part: Part, evolved: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = replace(part, steps=64)
    short.main("", ["run", str(evolved), str(tmp_path / "runs")])
    short.main("", ["run", str(evolved), str(tmp_path / "runs")])  # finds them all
    short.main("", ["worlds", str(evolved), str(tmp_path / "runs"), str(tmp_path)])
    worlds = pl.read_csv(tmp_path / "worlds.csv")
    assert worlds["treatment"].to_list() == list(part.treatments)
    assert set(worlds["pair"]) == {PAIR}
    assert set(worlds["steps"]) == {64}
    short.main("", ["tests", str(tmp_path)])
    printed = capsys.readouterr().out
    assert "primary: " in printed
    assert OPEN in printed
    with pytest.raises(ValueError, match="ends at step 64; `hedon resume` continues it"):
        replace(part, steps=128).main("", ["worlds", str(evolved), str(tmp_path / "runs"), str(tmp_path)])
    other = pl.read_parquet(evolved / evolution.LIVING).with_columns(w_normal=pl.lit(0.0, pl.Float32))
    other.write_parquet(evolved.parent / evolution.LIVING)
    (evolved.parent / evolution.WORLDS).write_bytes((evolved / evolution.WORLDS).read_bytes())
    with pytest.raises(ValueError, match=f"pair {PAIR} has other founders"):
        short.main("", ["worlds", str(evolved.parent), str(tmp_path / "runs"), str(tmp_path)])


@pytest.mark.parametrize("words", [["run", "no", "runs"], ["worlds", "no", "runs", "."], ["tests", "no"]], ids=" ".join)
def test_a_missing_table_is_named(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        swap.PART.main("", words)
    assert ended.value.code == 2
    assert re.search(r"error: no.(living\.parquet|worlds\.csv): there is no such file", capsys.readouterr().err)
    for main, arguments in ((evolution.main, ["tests", "no"]), (behavior.main, ["tests", "no.parquet"])):
        with pytest.raises(SystemExit):
            main(arguments)
        assert "there is no such file" in capsys.readouterr().err


def test_tests_of_a_part_without_one_of_its_groups_say_which(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    contests(0.6, 0.4).filter(pl.col("treatment") == "fast").write_csv(tmp_path / evolution.WORLDS)
    with pytest.raises(SystemExit):
        swap.PART.main("", ["tests", str(tmp_path)])
    assert "error: no worlds of slow; the tests need some of each" in capsys.readouterr().err
    pl.DataFrame({"learner": ["fast"]}).write_parquet(tmp_path / "fast.parquet")
    for name, message in (
        ("fast.parquet", "no worlds of baseline"),
        (evolution.WORLDS, "not a table that `run` wrote"),
    ):
        with pytest.raises(SystemExit):
            behavior.main(["tests", str(tmp_path / name)])
        assert message in capsys.readouterr().err


def test_both_sides_of_a_contest_start_with_half(evolved: Path) -> None:
    living = pl.read_parquet(evolved / evolution.LIVING)
    founders = swap.PART.treatments["slow"].founders(living, PAIR)
    assert founders.groups(1, 500).count("slow") == 250
    rates = living.group_by("learning_rate", maintain_order=True).agg(pl.col("w_normal").mean())
    means = {group: founders.values[np.array(founders.group) == group, 0].mean() for group in ("slow", "fast")}
    assert list(means.values()) == pytest.approx(rates["w_normal"].to_list(), abs=1e-5)


def test_a_pair_with_an_extinct_world_is_left_out(evolved: Path, tmp_path: Path) -> None:
    worlds = pl.read_csv(evolved / evolution.WORLDS)
    worlds = worlds.with_columns(extinct_step=pl.when(pl.col("arm") == "fast").then(5).otherwise(None))
    worlds.write_csv(tmp_path / evolution.WORLDS)
    (tmp_path / evolution.LIVING).write_bytes((evolved / evolution.LIVING).read_bytes())
    swap.PART.main("", ["run", str(tmp_path), str(tmp_path / "runs")])
    assert not (tmp_path / "runs").exists()


def contests(fast: float, slow: float, pairs: int = 60) -> pl.DataFrame:
    """Rows of contests in which the fast-evolved end with these mean shares under each learner."""
    rng = np.random.default_rng(1)
    return pl.concat(
        pl.DataFrame({"treatment": [name] * pairs, "pair": range(pairs), "share": mean + rng.normal(0, 0.1, pairs)})
        for name, mean in (("fast", fast), ("slow", slow))
    )


def test_winning_at_home_is_told_from_winning_everywhere() -> None:
    home = {row["test"]: row for row in swap.named_tests(contests(0.6, 0.4)).iter_rows(named=True)}
    assert home["primary: share of the fast-evolved, fast less slow learner"]["low"] > 0
    assert home["share of the fast-evolved less 1/2, fast learner"]["low"] > 0
    assert home["share of the fast-evolved less 1/2, slow learner"]["high"] < 0
    assert list(home) == list(swap.PART.expected)
    everywhere = swap.named_tests(contests(0.7, 0.7)).row(0, named=True)
    assert everywhere["low"] < 0 < everywhere["high"]


def test_an_answer_needs_all_contests() -> None:
    assert set(swap.PART.answers(contests(0.57, 0.43))["answer"]) == {YES}
    assert swap.PART.answers(contests(0.43, 0.57))["answer"].to_list() == [NO] * 3
    assert set(swap.PART.answers(contests(0.57, 0.43, pairs=59))["answer"]) == {OPEN}


def decoyed(loss: dict[tuple[str, str], float], pairs: int = 30) -> pl.DataFrame:
    """Rows of worlds in which decoys cost these shares of the intake, by genes and learner."""
    rng = np.random.default_rng(2)
    rows = []
    for name in decoy.PART.treatments:
        genes, learner, decoys = name.split("-")
        intake = 0.003 * (1 - loss[genes, learner] * (decoys == "decoy")) * rng.normal(1, 0.02, pairs)
        rows.append(pl.DataFrame({"treatment": [name] * pairs, "pair": range(pairs), "intake": intake}))
    return pl.concat(rows)


def test_a_loss_by_learners_is_told_from_a_loss_by_genes() -> None:
    loss = {("slow", "slow"): 0.1, ("slow", "fast"): 0.3, ("fast", "slow"): 0.1, ("fast", "fast"): 0.3}
    tests = decoy.named_tests(decoyed(loss))
    learner, *genes = tests.head(4).iter_rows(named=True)
    assert learner["effect"] == pytest.approx(0.2, abs=0.02)
    assert learner["low"] > 0
    assert all(each["low"] < 0 < each["high"] for each in genes)
    assert tests["test"].to_list() == list(decoy.PART.expected)


def test_genes_that_mislead_only_one_learner_are_found() -> None:
    loss = {("slow", "slow"): 0.1, ("slow", "fast"): 0.0, ("fast", "slow"): 0.2, ("fast", "fast"): 0.0}
    slow, fast, difference = decoy.named_tests(decoyed(loss)).slice(1, 3).iter_rows(named=True)
    assert slow["effect"] == pytest.approx(0.1, abs=0.02)
    assert fast["low"] < 0 < fast["high"]
    assert difference["effect"] == pytest.approx(-0.1, abs=0.02)
