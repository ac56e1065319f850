"""Run callbacks: what they receive, that TensorBoard can read the log, and what a notebook shows."""

import re
from pathlib import Path
from typing import Any

import polars as pl
import pytest

import hedon
from hedon import Moment
from hedon.callback import Metrics, ProgressBar, TensorBoard

BRIEF = ["world.rollout_steps=64", "learning.minibatch_size=32", "population.capacity=60"]
PAIR = ["world.rollout_steps=64", "learning.minibatch_size=32"]


def plan(folder: Path, preset: str = "baseline", overrides: Any = BRIEF) -> hedon.RunPlan:
    return hedon.RunPlan(hedon.load_config(preset, overrides=overrides), (1, 2), 330, folder, threads=1)


@pytest.mark.parametrize(("preset", "overrides"), [("baseline", BRIEF), ("predator", PAIR)])
def test_metrics_are_the_rows_of_the_table(tmp_path: Path, preset: str, overrides: Any) -> None:
    metrics, found, calls = Metrics(), dict[tuple[int, str], float](), list[int]()

    def log(moment: Moment) -> None:
        calls.append(moment.step)
        for step, values in metrics(moment):
            for name, value in values.items():
                assert (step, name) not in found, "each number is reported once"
                found[step, name] = value

    hedon.run(plan(tmp_path / "run", preset, overrides), callbacks=[log, lambda moment: None])
    rows = hedon.open_run(tmp_path / "run").population()
    assert calls[-1] == 330
    assert {step for step, _ in found} == set(rows["step"])
    several = "species" in rows.columns
    for row in rows.iter_rows(named=True):
        place = f"seed_{row['seed']}/" + (f"{row['species']}." if several else "")
        for column in ("alive", "births", "energy_mean", "neutral_1_mean"):
            assert found.get((row["step"], f"{place}{column}")) == pytest.approx(row[column])


def test_tensorboard_can_read_the_log(tmp_path: Path) -> None:
    pytest.importorskip("tensorboard")
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    hedon.run(plan(tmp_path / "run"), callbacks=[TensorBoard(tmp_path / "log")])
    read = EventAccumulator(str(tmp_path / "log"), size_guidance={"scalars": 0})
    read.Reload()
    rows = hedon.open_run(tmp_path / "run").population().filter(pl.col("seed") == 2)
    for column in ("alive", "births", "w_normal_mean"):
        events = read.Scalars(f"seed_2/{column}")
        assert [event.step for event in events] == rows["step"].to_list()
        assert [event.value for event in events] == pytest.approx(rows[column].to_list(), rel=1e-6)


def test_callbacks_follow_resumed_runs_and_branches(tmp_path: Path) -> None:
    heard: list[Moment] = []
    hedon.run(plan(tmp_path / "run"))
    hedon.resume(tmp_path / "run", steps=400, callbacks=[heard.append])
    hedon.branch(tmp_path / "run", tmp_path / "branch", steps=470, callbacks=[heard.append])
    assert {(moment.first, moment.steps) for moment in heard} == {(330, 400), (400, 470)}


def test_a_non_callback_is_refused_and_a_failing_callback_keeps_the_records(tmp_path: Path) -> None:
    wrong: Any = [3]
    with pytest.raises(hedon.ArgumentError, match="callbacks: must be functions of a moment, not 3"):
        hedon.run(plan(tmp_path / "run"), callbacks=wrong)
    wrong = print
    with pytest.raises(hedon.ArgumentError, match="callbacks: must be a list of functions of a moment, not <"):
        hedon.run(plan(tmp_path / "run"), callbacks=wrong)
    assert not (tmp_path / "run").exists()

    def fail(moment: Moment) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        hedon.run(plan(tmp_path / "run"), callbacks=[fail])
    assert hedon.open_run(tmp_path / "run").manifest.status == "failed"
    assert hedon.resume(tmp_path / "run").status == "finished"


def test_a_notebook_shows_one_bar(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    display: Any = pytest.importorskip("IPython.display")
    shown: list[str] = []

    class Handle:
        def update(self, html: Any) -> None:
            shown.append(html.data)

    def show(html: Any, display_id: bool) -> Handle:
        assert display_id
        shown.append(html.data)
        return Handle()

    monkeypatch.setattr(display, "display", show)
    hedon.run(plan(tmp_path / "run"), callbacks=[ProgressBar()])
    assert len(shown) > 1
    assert all(text.startswith("<progress value=") for text in shown)
    assert "step 330 of 330; alive: " in shown[-1]


@pytest.mark.long
@pytest.mark.parametrize("tracker", ["wandb", "mlflow"])
def test_the_guides_examples_log_to_trackers_offline(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tracker: str
) -> None:
    """Run the code from the guide with the real library, without a network."""
    library: Any = pytest.importorskip(tracker)
    monkeypatch.setenv("WANDB_DIR", str(tmp_path))
    monkeypatch.setenv("MLFLOW_TRACKING_URI", f"sqlite:///{tmp_path / 'mlflow.db'}")
    page = (Path(__file__).parents[2] / "docs/guide/callback.md").read_text(encoding="utf-8")
    (block,) = (each for each in re.findall(r"^```py\n(.*?)^```$", page, re.M | re.S) if f"import {tracker}" in each)
    names: dict[str, Any] = {"hedon": hedon}
    exec(block, names)
    hedon.run(plan(tmp_path / "run"), callbacks=[names[f"to_{tracker}"]])
    rows = hedon.open_run(tmp_path / "run").population().filter(pl.col("seed") == 2)
    if tracker == "wandb":
        names["log"].log({"over": 1}, step=1000)  # a step is written when the next one starts
        assert names["log"].summary["seed_2/alive"] == rows["alive"][-1]
        library.finish()
        assert list(tmp_path.glob("wandb/offline-run-*/*.wandb"))
    else:
        run = library.last_active_run().info.run_id
        kept = library.tracking.MlflowClient().get_metric_history(run, "seed_2/alive")
        assert [(each.step, each.value) for each in kept] == list(zip(rows["step"], rows["alive"], strict=True))
        library.end_run()
