"""A run that stops at a fault records it and can reproduce it."""

import pytest
from memory import overwrite
from resumed_run import WINDOW, small_run
from typer.testing import CliRunner

from hedon.check.run import check_run
from hedon.cli.main import app
from hedon.error import EngineError
from hedon.experiment.fault import replay_fault
from hedon.experiment.resume import resume
from hedon.experiment.simulation import Simulation
from hedon.record.checkpoint import load_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import FAULT, checkpoint_paths
from hedon.record.manifest import load_manifest
from hedon.record.reader import open_run

# Learning so fast that its numbers overflow.
WILD = (
    *(
        "learning.learning_rate=1",
        "learning.value_coef=1000",
        "learning.adam_epsilon=1e-30",
        "learning.update_epochs=50",
    ),
    *("reward.action_coef=1000", "genome.weight_limit=1000", "genome.action.initial_mean=1000"),
)


@pytest.fixture
def failed(tmp_path):
    """A run of two worlds that stopped at a fault caused by its settings."""
    with pytest.raises(EngineError) as fault:
        small_run(tmp_path / "run", 100 * WINDOW, overrides=WILD, checkpoint_seconds=0)
    return tmp_path / "run", str(fault.value)


def test_the_fault_and_the_worlds_are_kept(failed):
    folder, said = failed
    manifest = load_manifest(folder)
    assert (manifest.status, manifest.fault) == ("failed", said)
    assert checkpoint_paths(folder)
    kept = load_checkpoint(checkpoint_paths(folder, FAULT)[0])
    assert kept.head.step == max(manifest.steps_done)
    assert {"0/params", "1/params"} <= set(kept.arrays)
    verdict = check_run(folder)
    assert verdict.findings == ()
    assert any(said in note for note in verdict.notes)
    agents = open_run(folder).agents()
    assert agents.height == agents.select("world", "agent_id").n_unique()


def test_the_same_fault_recurs(failed):
    folder, said = failed
    again = replay_fault(folder)
    assert again.recurred == again.recorded == said
    answer = CliRunner().invoke(app, ["check", str(folder), "--fault"])
    assert (answer.exit_code, said in answer.output) == (0, True)
    before = load_manifest(folder)
    with pytest.raises(EngineError, match=said.split(":")[0]):
        resume(folder)
    assert len(checkpoint_paths(folder, FAULT)) == 1
    assert load_manifest(folder).fault == before.fault


def break_at(monkeypatch, step, path, value):
    """Corrupts the memory of world 1 at a step, once."""
    run = Simulation.run

    def broken(self, steps):
        run(self, steps)
        if self.worlds[1].step >= step:
            monkeypatch.undo()
            overwrite(self, 1, path, 0, value)

    monkeypatch.setattr(Simulation, "run", broken)


def test_a_memory_fault_stops_the_run_and_does_not_recur(tmp_path, monkeypatch):
    break_at(monkeypatch, 2 * WINDOW, "counters.energy_eaten", -7.0)
    with pytest.raises(EngineError, match=r"ledger_open.*World 1, step 192"):
        small_run(tmp_path / "run", 1000)
    answer = CliRunner().invoke(app, ["check", str(tmp_path / "run"), "--fault"])
    assert answer.exit_code == 1
    assert "did not happen again" in answer.output
    assert resume(tmp_path / "run").status == "finished"
    assert load_manifest(tmp_path / "run").fault is None
    assert not checkpoint_paths(tmp_path / "run", FAULT)
    assert check_run(tmp_path / "run").findings == ()


def test_worlds_with_unreliable_slots_are_not_read(tmp_path, monkeypatch):
    break_at(monkeypatch, 2 * WINDOW, "alive", 0)
    deathless = ("hazard.kappa=0", "hazard.alpha_age=0")
    with pytest.raises(EngineError, match=r"slots_inconsistent.*World 1"):
        small_run(tmp_path / "run", 1000, overrides=deathless)
    kept = load_checkpoint(checkpoint_paths(tmp_path / "run", FAULT)[0])
    assert "0/params" in kept.arrays
    assert "1/params" not in kept.arrays


def test_a_run_without_a_fault_has_none_to_replay(tmp_path):
    small_run(tmp_path / "run", WINDOW)
    with pytest.raises(RecordError, match="recorded no fault: its status is finished"):
        replay_fault(tmp_path / "run")
