"""The preface of `hedon compare` (step, settings, design), and where it writes."""

import json
import shutil
from pathlib import Path

import polars as pl
import pytest
from typer.testing import CliRunner
from worlds import QUICK

from hedon import RunPlan, load_config, run
from hedon.cli.main import app
from hedon.compare.contrast import compare_answer
from hedon.compare.error import CompareError
from hedon.compare.length import MOST_NAMED, RunLength, step_sentence
from hedon.compare.preface import MOST_SHOWN
from hedon.compare.source import WorldTable, read_both

STEPS = 256
RUNS = {
    "base": ((1, 2, 3), STEPS, ()),
    "costly": ((1, 2, 3), STEPS, ("energy.basic_cost=0.004",)),
    "long": ((1, 2, 3), 2 * STEPS, ("energy.basic_cost=0.004",)),
    "others": ((7, 8, 9), STEPS, ()),
    "partly": ((3, 4, 5, 6), STEPS, ("energy.basic_cost=0.004",)),
}
"""Seeds, steps and changed settings of each run."""
ELEVEN = (
    *("energy.initial=20", "energy.basic_cost=0.002", "energy.action_cost=3e-5", "hazard.kappa=0.02"),
    *("birth.kappa=0.0002", "hazard.alpha_age=1e-6", "hazard.beta_age=5e-6", "learning.gamma=0.99"),
    *("learning.gae_lambda=0.9", "learning.learning_rate=0.0001", "learning.clip_coef=0.3"),
)
"""Changes to so many settings that their list is truncated."""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("compare") / "runs"
    for name, (seeds, steps, changes) in RUNS.items():
        run(RunPlan(load_config("baseline", overrides=[*QUICK, *changes]), seeds=seeds, steps=steps, out=folder / name))
    return folder


@pytest.fixture(autouse=True)
def in_their_folder(runs: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(runs.parent)


def said(*words: str, out: Path | None = None) -> str:
    place = () if out is None else ("--out", str(out))
    done = CliRunner().invoke(app, ["compare", *words, *place])
    assert done.exit_code == 0, done.output + repr(done.exception)
    return done.output


def refused(*words: str) -> str:
    error = CliRunner().invoke(app, ["compare", *words]).exception
    assert isinstance(error, CompareError)
    return str(error)


def test_the_first_line_gives_the_step_and_the_reason(tmp_path: Path) -> None:
    assert said("runs/base", "runs/costly", out=tmp_path / "a").startswith(f"Compared at step {STEPS}.\n")
    longer = f"Compared at step {STEPS}, the length of the shortest: runs/long has {2 * STEPS}."
    assert said("runs/base", "runs/long", out=tmp_path / "b").startswith(f"{longer}\n")
    pages = [(tmp_path / "b" / f"compare.{kind}").read_text() for kind in ("md", "html")]
    assert all(longer in page for page in pages)
    assert json.loads((tmp_path / "b" / "compare.json").read_text())["compared_at"] == longer


def test_a_run_in_progress_is_named(tmp_path: Path) -> None:
    shutil.copytree("runs/base", tmp_path / "half")
    manifest = tmp_path / "half" / "manifest.json"
    manifest.write_text(manifest.read_text().replace('"finished"', '"running"'))
    half = f"{tmp_path / 'half'} is still running or was killed"
    first, *_ = said(str(tmp_path / "half"), "runs/long", out=tmp_path / "a").splitlines()
    assert first == f"Compared at step {STEPS}, the length of the shortest: {half}; runs/long has {2 * STEPS}."
    first, *_ = said(str(tmp_path / "half"), "runs/costly", out=tmp_path / "b").splitlines()
    assert first == f"Compared at step {STEPS}: {half}."


def test_of_many_runs_only_some_are_named() -> None:
    many = [RunLength(f"r{i}", 5120 if i else 1024, "interrupted" if i == 1 else "finished") for i in range(7)]
    assert step_sentence(1024, many) == (
        "Compared at step 1,024, the length of the shortest: r1 was interrupted and has 5,120; r2 has 5,120; "
        f"r3 has 5,120; and {6 - MOST_NAMED + 1} other runs are longer or unfinished."
    )
    assert step_sentence(None, []) == ""


def test_differing_settings_are_listed_as_in_check(tmp_path: Path) -> None:
    text = said("runs/base", "runs/costly", out=tmp_path)
    line = "energy.basic_cost: 0.001 -> 0.004"
    assert f"Settings that differ, runs/base -> runs/costly:\n  {line}\n" in text
    assert f"  {line}\n" in CliRunner().invoke(app, ["check", "runs/base", "--against", "runs/costly"]).output
    assert "runs/costly is baseline (corrected): energy.basic_cost 0.004." in text, "the same name as in `hedon report`"
    assert "differ: the comparison" not in text
    content = json.loads((tmp_path / "compare.json").read_text())
    assert content["settings"] == [{"setting": "energy.basic_cost", "values": [0.001, 0.004]}]
    assert "<li>energy.basic_cost: 0.001 -&gt; 0.004</li>" in (tmp_path / "compare.html").read_text()
    assert "- energy.basic_cost: 0.001 -\\> 0.004\n" in (tmp_path / "compare.md").read_text()


def test_settings_are_also_listed_for_conditions_in_one_folder(tmp_path: Path) -> None:
    for name in ("base", "costly"):
        shutil.copytree(f"runs/{name}", tmp_path / "runs" / name)
    assert "\n  energy.basic_cost: 0.001 -> 0.004\n" in said(str(tmp_path / "runs"))


def test_equal_settings_give_a_caution(tmp_path: Path) -> None:
    caution = "No setting differs: these are two samples of the same condition."
    text = said("runs/base", "runs/others", out=tmp_path)
    assert f"{caution}\n" in text
    assert "Both are baseline (corrected), modified.\n" in text
    assert "Settings that differ" not in text
    assert f"**{caution}**" in (tmp_path / "compare.md").read_text()
    assert f"<strong>{caution}</strong>" in (tmp_path / "compare.html").read_text()


def test_many_differing_settings_give_a_caution_and_are_truncated(tmp_path: Path) -> None:
    changes = load_config("baseline", overrides=[*QUICK, *ELEVEN])
    run(RunPlan(changes, seeds=(1, 2), steps=STEPS, out=tmp_path / "many"))
    text = said("runs/base", str(tmp_path / "many"), out=tmp_path / "answer")
    content = json.loads((tmp_path / "answer" / "compare.json").read_text())
    assert len(content["settings"]) == len(ELEVEN) == MOST_SHOWN + 1
    assert text.count(" -> ") == 1 + MOST_SHOWN, "the heading, and the settings"
    assert "\n  and 1 other setting\n" in text
    assert f"{len(ELEVEN)} settings differ: the comparison cannot tell which of them matters." in text


@pytest.mark.parametrize(
    ("other", "words", "sentence", "worlds", "paired"),
    [
        ("costly", (), "Compared in pairs of equal seeds: 3 pairs.", 3, "yes"),
        ("costly", ("--unpaired",), "Compared as independent samples, as requested.", 6, "no"),
        (
            "others",
            (),
            "No seed in common: compared as independent samples, which needs more worlds.",
            6,
            "no",
        ),
        (
            "partly",
            (),
            "Only 1 of the 3 worlds of runs/base has a counterpart of the same seed: compared as independent samples, "
            "which needs more worlds.",
            7,
            "no",
        ),
    ],
)
def test_one_design_holds_for_all_rows(
    tmp_path: Path, other: str, words: tuple[str, ...], sentence: str, worlds: int, paired: str
) -> None:
    assert f"\n{sentence}\n" in said("runs/base", f"runs/{other}", *words, out=tmp_path)
    content = json.loads((tmp_path / "compare.json").read_text())
    assert (content["design"], content["paired"]) == (sentence, paired == "yes")
    rows = content["tables"]["contrast"]["rows"]
    assert {row["paired"] for row in rows} == {paired}
    each = 2 if paired == "yes" else 1
    assert all(row["left out"] == each * (worlds - row["worlds"]) for row in rows)


def test_a_row_with_missing_values_keeps_the_design_and_counts_them() -> None:
    """Of eight pairs, one has lifetimes; on their own, they would be compared as independent samples."""
    rows = [
        {"arm": arm, "seed": seed, "alive_mean": 10.0 * seed, "mean_lifetime": 5.0 if (seed, arm) in known else None}
        for known in [{(1, "a"), (1, "b"), (2, "a"), (3, "b"), (4, "b")}]
        for arm in ("a", "b")
        for seed in range(1, 9)
    ]
    answer = compare_answer(WorldTable("mine", pl.DataFrame(rows), ("arm",)))
    assert answer.lines[-1] == "Compared in pairs of equal seeds: 8 pairs."
    shown = {row["measure"]: row for row in answer.tables[0].rows.to_dicts()}
    full, sparse = shown["agents alive, last tenth"], shown["lifetime of the dead [step]"]
    assert (full["worlds"], full["paired"], full["left out"]) == (8, "yes", 0)
    assert (sparse["worlds"], sparse["paired"], sparse["left out"]) == (1, "yes", 14)
    apart = compare_answer(WorldTable("mine", pl.DataFrame(rows), ("arm",)), paired=False).tables[0].rows.to_dicts()
    assert {row["measure"]: (row["worlds"], row["left out"]) for row in apart}["lifetime of the dead [step]"] == (5, 11)


def test_worlds_without_a_counterpart_are_counted_once_for_all_rows() -> None:
    rows = [
        {"arm": arm, "seed": seed, "alive_mean": float(seed)} for arm, n in (("a", 6), ("b", 8)) for seed in range(n)
    ]
    answer = compare_answer(WorldTable("mine", pl.DataFrame(rows), ("arm",)))
    assert answer.lines[-1] == "Compared in pairs of equal seeds: 6 pairs; 2 worlds without a counterpart are left out."


def test_one_measure_needs_no_correction(tmp_path: Path) -> None:
    def note(*words: str) -> str:
        return " ".join(said("runs/base", "runs/costly", *words, out=tmp_path).split())

    assert "p Holm: the same as p, since there is one measure." in note("--only", "alive_mean")
    assert "p Holm: corrected for these 2 measures." in note("--only", "alive_mean,w_action")


def test_a_weight_stands_for_its_mean(tmp_path: Path) -> None:
    def measures(*words: str) -> list[str]:
        said("runs/base", "runs/costly", *words, out=tmp_path)
        rows = json.loads((tmp_path / "compare.json").read_text())["tables"]["contrast"]["rows"]
        return [row["measure"] for row in rows]

    assert measures("--only", "w_normal") == measures("--only", "w_normal_mean") == ["mean of w_normal"]
    assert "did you mean w_normal_mean?" in refused("runs/base", "runs/costly", "--only", "w_norma")
    both = pl.DataFrame(
        {"arm": [1, 2], "seed": [1, 1], "prey.w_food_mean": [1.0, 2.0], "hunter.w_food_mean": [0.0, 1.0]}
    )
    with pytest.raises(CompareError, match="'w_food' is not a column of numbers"):
        compare_answer(WorldTable("mine", both, ("arm",)), only=["w_food"])
    (row,) = compare_answer(WorldTable("mine", both, ("arm",)), only=["prey.w_food"]).tables[0].rows.to_dicts()
    assert row["measure"] == "mean of w_food: prey"


def test_a_missing_folder_is_distinguished_from_one_without_worlds(tmp_path: Path) -> None:
    assert refused("runs/base", "runs/costy") == "runs/costy does not exist; did you mean runs/costly?"
    assert refused("nowhere/at/all", "runs/base") == "nowhere/at/all does not exist"
    assert refused(str(tmp_path)).startswith(f"{tmp_path}: holds no worlds to compare: give runs")


def test_each_pair_of_sources_has_its_own_folder_and_overwrites_no_other(tmp_path: Path) -> None:
    assert "wrote compare/base-costly/compare.json" in said("runs/base", "runs/costly/")
    assert "wrote compare/base-others/compare.json" in said("runs/base", "runs/others")
    assert said("runs/base/", "runs/costly"), "the same sources are compared again"
    place = tmp_path / "answer"
    said("runs/base", "runs/costly", out=place)
    before = (place / "compare.md").read_bytes()
    message = f"{place} already holds a comparison of runs/base and runs/costly: choose another folder with --out"
    assert message in refused("runs/base", "runs/others", "--out", str(place))
    assert (place / "compare.md").read_bytes() == before
    shutil.rmtree("compare")


def test_runs_of_two_sources_keep_their_names() -> None:
    table = read_both(("runs/base", "runs/costly"))
    assert table.labels["runs/costly"] == "baseline (corrected): energy.basic_cost 0.004"
    assert [each.name for each in table.lengths] == ["runs/base", "runs/costly"]
