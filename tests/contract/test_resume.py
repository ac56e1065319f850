"""A stopped and resumed run has the same records as an uninterrupted one, bit for bit."""

import json
import shutil
from dataclasses import replace

import psutil
import pytest
from command import hedon
from polars.testing import assert_frame_equal
from resumed_run import WINDOW, assert_same_run, filler, small_run

from hedon import _engine
from hedon.config import load_config
from hedon.experiment.branch import branch, plan_branch, start_branch
from hedon.experiment.plan import RunPlan
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import continue_run, lock, resume
from hedon.experiment.run import run
from hedon.record.checkpoint import load_checkpoint, save_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import TABLE_FOLDERS, checkpoint_paths, part_path, part_paths
from hedon.record.manifest import Parent, load_manifest
from hedon.record.reader import open_run
from hedon.record.writer import Writer

STEPS = 500


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """An uninterrupted run of two worlds with frames."""
    folder = tmp_path_factory.mktemp("left alone") / "run"
    small_run(folder, STEPS, frames=37)
    return folder


@pytest.fixture
def half(tmp_path):
    """The same run, stopped in the middle of a window."""
    small_run(tmp_path / "run", 300, frames=37)
    return tmp_path / "run"


@pytest.mark.parametrize("seeds", [(1,), (1, 2, 3)])
@pytest.mark.parametrize("frames", [0, 37])
def test_a_resumed_run_is_the_run_left_alone(tmp_path, seeds, frames):
    small_run(tmp_path / "alone", STEPS, seeds=seeds, frames=frames)
    for stop in (1, WINDOW, 2 * WINDOW + 1, 6 * WINDOW - 1):
        small_run(tmp_path / f"{stop}", stop, seeds=seeds, frames=frames)
        resume(tmp_path / f"{stop}", steps=STEPS)
        assert_same_run(tmp_path / "alone", tmp_path / f"{stop}")


@pytest.mark.smoke
def test_a_run_may_be_resumed_often_and_on_other_threads(tmp_path, whole):
    small_run(tmp_path / "run", 10, frames=37)
    for steps, threads in ((74, 2), (75, 1), (129, 3), (400, 1), (STEPS, 2)):
        resume(tmp_path / "run", steps=steps, threads=threads, checkpoint_seconds=0)
    assert_same_run(tmp_path / "run", whole)
    sessions = load_manifest(tmp_path / "run").sessions
    assert [session.from_step for session in sessions] == [0, 10, 74, 75, 129, 400]
    assert [session.threads for session in sessions] == [1, 2, 1, 3, 1, 2]
    assert all(session.ended for session in sessions)
    assert len(checkpoint_paths(tmp_path / "run")) == 2


def test_time_adds_up_over_sessions(half):
    before = load_manifest(half)
    after = resume(half, steps=STEPS)
    assert before.run_seconds is not None
    assert after.run_seconds is not None
    assert after.run_seconds > before.run_seconds
    assert after.started == before.started


def test_worlds_die_out_independently(tmp_path):
    lethal = ("hazard.kappa=0.3", "energy.initial=0", "birth.kappa=0", "food.normal.growth_rate=0")
    small_run(tmp_path / "a", 3000, seeds=(1, 2, 3), overrides=lethal)
    extinct = load_manifest(tmp_path / "a").extinct_steps
    first, last = sorted(step for step in extinct if step)[:2]
    small_run(tmp_path / "b", (first + last) // 2, seeds=(1, 2, 3), overrides=lethal)
    resume(tmp_path / "b", steps=3000)
    assert_same_run(tmp_path / "a", tmp_path / "b")
    with pytest.raises(RecordError, match="every world has died out"):
        resume(tmp_path / "b", steps=4000)


def test_rows_after_the_checkpoint_are_removed(half, whole):
    first = checkpoint_paths(half)[0]
    checkpoint_paths(half)[1].unlink()  # as if the run had been killed between these rows and their checkpoint,
    for table in TABLE_FOLDERS:  # and had written them in many more parts
        shutil.copy(part_paths(half, table)[-1], part_path(half, table, 57))
    rows = open_run(half).population().height
    with lock(half, STEPS) as found:
        assert found.step == 0
        assert checkpoint_paths(half) == [first]
    assert open_run(half).population().height == rows, "locking the folder changed its rows"
    resume(half, steps=STEPS)
    assert_same_run(half, whole)


def test_a_finished_run_needs_more_steps(half):
    with pytest.raises(RecordError, match="has already done all its 300 steps: give a larger total with --steps"):
        resume(half)
    with pytest.raises(RecordError, match="has already done 300 steps"):
        resume(half, steps=200)


def test_a_damaged_checkpoint_is_skipped(half, whole):
    first, last = checkpoint_paths(half)
    last.write_bytes(last.read_bytes()[:-1000])
    with lock(half, STEPS) as found:
        assert found.step == 0
        assert found.notes[0].startswith(f"damaged checkpoint {last}: ")
        assert "continuing from the checkpoint before it" in found.notes[0]
    data = bytearray(first.read_bytes())
    data[len(data) // 2] ^= 1
    first.write_bytes(data)
    with pytest.raises(RecordError, match="has no undamaged checkpoint"):
        resume(half, steps=STEPS)
    first.write_bytes(data[: len(data) // 2] + bytes([data[len(data) // 2] ^ 1]) + data[len(data) // 2 + 1 :])
    resume(half, steps=STEPS)
    assert_same_run(half, whole)


def test_without_checkpoints_records_are_left_alone(half):
    for path in checkpoint_paths(half):
        path.unlink()
    before = part_paths(half, "population")
    with pytest.raises(RecordError, match="has records but no checkpoint"):
        resume(half, steps=STEPS)
    assert part_paths(half, "population") == before


@pytest.mark.parametrize("damage", ["truncated", "altered", "missing"])
def test_damaged_records_are_named_and_a_branch_still_works(half, damage):
    part = part_paths(half, "population")[0]
    data = part.read_bytes()
    if damage == "missing":
        part.unlink()
    else:
        part.write_bytes(data[:-10] if damage == "truncated" else data[:50] + bytes([data[50] ^ 1]) + data[51:])
    with pytest.raises(RecordError, match=rf"damaged records: .*{part.name}.*hedon branch"):
        resume(half, steps=STEPS)
    assert branch(half, half.with_name("saved"), steps=STEPS).status == "finished"


def spoil(folder, **changes):
    """Rewrites the newest checkpoint with a different head or different arrays, as another program might."""
    path = checkpoint_paths(folder)[-1]
    old = load_checkpoint(path)
    arrays = changes.pop("arrays", old.arrays)
    save_checkpoint(folder, replace(old.head, **changes), filler(arrays))


def test_a_checkpoint_of_another_version_config_or_shape_says_what_differs(half):
    head, arrays = (lambda found: (found.head, found.arrays))(load_checkpoint(checkpoint_paths(half)[-1]))
    cases = [
        ({"hedon_version": "0.0.9"}, r"made by hedon 0\.0\.9, and this is"),
        ({"seeds": (1, 3)}, r"has seeds \[1, 3\], and the run has \[1, 2\]"),
        ({"digests": ("0" * 16,) * 2}, "world 0 is not as it was saved"),
        ({"sampled": head.sampled[:1]}, "worlds or tables are missing"),
        ({"parts": {}}, "worlds or tables are missing"),
        ({"sampled": (replace(head.sampled[0], counters={"births": 1}), head.sampled[1])}, "not as it was saved"),
        (
            {"arrays": {name: array for name, array in arrays.items() if name != "1/params"}},
            "world 1: params is missing",
        ),
        ({"arrays": arrays | {"0/params": arrays["0/params"][:, :-16]}}, "world 0: params has shape"),
    ]
    for changes, words in cases:
        spoil(half, **changes)
        with pytest.raises(RecordError, match=words):
            resume(half, steps=STEPS)
        spoil(half, **{name: getattr(head, name) for name in changes if name != "arrays"}, arrays=arrays)
    text = (half / "config.toml").read_text()
    (half / "config.toml").write_text(text.replace("basic_cost = ", "basic_cost = 1"))
    with pytest.raises(RecordError, match=r"another config: energy\.basic_cost was .*, now 1"):
        resume(half, steps=STEPS)
    (half / "config.toml").write_text(text)
    resume(half, steps=STEPS)


def test_a_run_keeps_its_instruction_set(tmp_path, monkeypatch):
    monkeypatch.setenv("HEDON_BACKEND", "portable")
    small_run(tmp_path / "a", 200)
    small_run(tmp_path / "b", 100)
    monkeypatch.delenv("HEDON_BACKEND")
    resume(tmp_path / "b", steps=200)
    assert_same_run(tmp_path / "a", tmp_path / "b")
    assert load_manifest(tmp_path / "b").sessions[1].backend == "portable"


@pytest.mark.skipif(len(_engine.kernel.kernel_names()) < 2, reason="this processor has one instruction set")
def test_an_instruction_set_is_refused_only_if_its_bits_differ(tmp_path, monkeypatch):
    small_run(tmp_path / "run", 100)
    monkeypatch.setenv("HEDON_BACKEND", "portable")
    with pytest.raises(RecordError, match=r"instruction set .* HEDON_BACKEND is portable"):
        resume(tmp_path / "run", steps=200)
    monkeypatch.setenv("HEDON_BACKEND", "avx2")
    resume(tmp_path / "run", steps=200)
    monkeypatch.delenv("HEDON_BACKEND")
    small_run(tmp_path / "left alone", 200)
    assert_same_run(tmp_path / "run", tmp_path / "left alone")


def test_a_branch_without_changes_is_the_same_life(half, whole):
    manifest = branch(half, half.with_name("branch"), steps=STEPS)
    old = load_manifest(half)
    assert manifest.parent == Parent("run", str(old.config_digest), 300)
    assert load_manifest(half.with_name("branch")) == manifest
    assert manifest.world_digests == load_manifest(whole).world_digests
    rows, every = open_run(half.with_name("branch")).population(), open_run(whole).population()
    assert rows.equals(every.filter(every["step"] > 300))
    assert load_manifest(half) == old
    resumed = resume(half.with_name("branch"), steps=STEPS + 100)
    assert resumed.parent == manifest.parent


def test_a_branch_diverges_from_any_kept_checkpoint(half, whole):
    out = half.with_name("branch")
    with pytest.raises(RecordError, match="has no checkpoint of step 64; it has those of steps 0, 300"):
        branch(half, out, at=64)
    with pytest.raises(RecordError, match="is at step 300: a branch needs more total steps"):
        branch(half, out)
    manifest = branch(half, out, ["energy.basic_cost=0.05", "population.capacity=40"], at=0, steps=STEPS)
    assert manifest.parent is not None
    assert manifest.parent.step == 0
    assert manifest.modified
    assert manifest.world_digests != load_manifest(whole).world_digests
    with pytest.raises(RecordError, match="already holds a run"):
        branch(half, out, steps=STEPS)


@pytest.mark.parametrize(
    "setting",
    [
        "sensor.ray_count=5",
        'sensor.scaling="unit"',
        "genome.neutral_count=3",
        "arena.width=500",
        "world.rollout_steps=128",
        "food.normal.capacity=50",
    ],
)
def test_a_branch_cannot_change_the_shape_of_a_world(half, setting):
    path = setting.partition("=")[0]
    with pytest.raises(RecordError, match=rf"cannot change {path}: the saved worlds depend on it"):
        branch(half, half.with_name("branch"), [setting], steps=STEPS)
    assert not half.with_name("branch").exists()


def test_a_branch_with_fewer_slots_than_living_agents_is_refused(half):
    with pytest.raises(RecordError, match=r"does not fit: world 0: head\.living_count"):
        branch(half, half.with_name("branch"), ["population.capacity=4", "population.initial_count=4"], steps=STEPS)


def test_runs_that_were_killed_before_their_first_checkpoint_start_over(tmp_path, whole):
    small_run(tmp_path / "run", STEPS, frames=37)
    for path in (tmp_path / "run").rglob("*"):
        if path.suffix in (".parquet", ".npz"):
            path.unlink()
    resume(tmp_path / "run")
    assert_same_run(tmp_path / "run", whole)


def test_the_command_says_what_it_does(half, whole):
    refused = hedon("run", "baseline", "--out", half)
    assert refused.returncode == 2
    assert f"hedon resume {half}" in refused.stderr
    last = checkpoint_paths(half)[-1]
    last.write_bytes(b"nothing")
    resumed = hedon("resume", half, "--steps", STEPS, "--no-report")
    assert resumed.returncode == 0, resumed.stderr
    assert f"Write the report with: hedon report {half}" in resumed.stdout
    assert not (half / "report.html").exists()
    assert f"note: damaged checkpoint {last}" in resumed.stderr
    assert "500 steps from step 0, into" in resumed.stdout
    assert_same_run(half, whole)
    branched = hedon("branch", half, "--steps", "600", "--set", "energy.basic_cost=0.01")
    assert branched.returncode == 0, branched.stderr
    assert "600 steps from step 500, into" in branched.stdout
    found = load_manifest(half.with_name("run-branch500"))
    assert found.steps_done == (600, 600)
    world = json.loads((half.with_name("run-branch500") / "summary.json").read_text())["worlds"][0]
    assert world["ledger"]["residual"] < 1e-6, "the ledger of a branch must start at the checkpoint"
    assert world["steps_per_second"] * found.run_seconds == pytest.approx(100)
    for arguments, words in (
        (("resume", half), "give a larger total with --steps"),
        (("resume", half.with_name("rnu")), "did you mean"),
        (("branch", half, "--set", "arena.width=500"), "arena.width"),
    ):
        answer = hedon(*arguments)
        assert answer.returncode == 2
        assert words in answer.stderr
        assert "Traceback" not in answer.stderr


def test_a_world_that_dies_out_before_the_checkpoint_of_its_window_is_computed_again(tmp_path):
    short = ("hazard.form=constant", "hazard.kappa=0.04", "population.initial_count=4", "birth.kappa=0")
    config = load_config("baseline", overrides=["world.rollout_steps=64", "learning.minibatch_size=64", *short])
    first = run(RunPlan(config, list(range(1, 9)), 40, tmp_path / "run", 1))
    assert None in first.extinct_steps
    assert any(first.extinct_steps)
    resume(tmp_path / "run", 90, threads=1)
    found, note = replay_run(tmp_path / "run", 1)
    assert (found, note.split(" to ")[0]) == ((), "computed again from step 40")


def test_checkpoints_are_saved_at_the_ends_of_windows_and_once_at_the_end(tmp_path, monkeypatch):
    """A checkpoint within a window would hold its rollouts, which are larger than everything else."""
    saved, save = [], Writer.save_checkpoint
    monkeypatch.setattr(Writer, "save_checkpoint", lambda *given: [saved.append(given[1].step), save(*given)])
    small_run(tmp_path / "run", 40 * WINDOW, frames=10, checkpoint_seconds=0)
    assert saved == [step * WINDOW for step in range(41)], "0 s asks for a checkpoint at the end of every window"
    resume(tmp_path / "run", 40 * WINDOW + 5)
    assert saved[-2:] == [40 * WINDOW, 40 * WINDOW + 5], "the last checkpoint may be within a window"


def test_a_continued_run_releases_its_old_checkpoint(half, tmp_path):
    """A file takes up disk space while its arrays are in use, even after it is removed."""

    def held() -> list[str]:
        return [each.path for each in psutil.Process().memory_maps() if each.path.startswith(str(half))]

    with lock(half, steps=STEPS) as found:
        continue_run(found)
        assert held() == []
    plan = plan_branch(half, tmp_path / "branch", steps=STEPS + WINDOW)
    assert plan.checkpoint.arrays, "it has not been restored yet"
    start_branch(plan)
    assert held() == []


def test_records_match_the_checkpoint_as_soon_as_a_run_is_resumed(half, monkeypatch):
    """Otherwise, a second kill would leave living agents of a later moment among them."""
    before = open_run(half).agents()
    resume(half, steps=STEPS, checkpoint_seconds=1e9)
    for path in checkpoint_paths(half)[1:]:
        path.unlink()  # as after a kill: records up to the end, but no later checkpoint
    assert open_run(half).agents().height > before.height
    seen = []

    def stop(*_):
        seen.append(open_run(half).agents())
        return iter(())

    monkeypatch.setattr("hedon.experiment.run._steps", stop)
    resume(half, steps=STEPS)
    assert_frame_equal(seen[0], before)
