"""How a rule's file is found, and that a run continues with the text it keeps: moved, elsewhere, without the file."""

import json
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner
from worlds import QUICK

from hedon import RunPlan, Simulation, branch, load_config, open_run, resume, run
from hedon.check.run import check_run
from hedon.cli.main import app
from hedon.config.dump import digest, dump_toml
from hedon.config.load import parse_config
from hedon.experiment.fault import replay_fault
from hedon.experiment.replay import replay_run
from hedon.experiment.resume import lock
from hedon.experiment.rule import RuleError

pytest.importorskip("numba", reason='needs the optional package: pip install "hedon[rules]"')

TEXT = "def pay(agent):\n    return agent.linear + 0.5\n\n\ndef die(agent):\n    return min(1.0, 2.0 * agent.chance)\n"
OTHER = TEXT.replace("0.5", "0.25")
LIVELY = (*QUICK, "population.capacity=12", "population.initial_count=8", "birth.kappa=0.05", "hazard.alpha_age=0.01")


@pytest.fixture
def study(tmp_path, monkeypatch):
    """A folder with a config and its rules in a subfolder, while the current folder is another one."""
    folder = tmp_path / "study"
    (folder / "rules").mkdir(parents=True)
    (folder / "rules" / "own.py").write_text(TEXT)
    lines = ['preset = "baseline"', '[reward]\nrule = "rules/own.py:pay"', '[hazard]\nrule = "rules/own.py:die"']
    (folder / "my.toml").write_text("\n".join(lines) + "\n")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    return folder


def plan(study: Path, name: str, steps: int = 96) -> RunPlan:
    config = load_config(study / "my.toml", overrides=LIVELY)
    return RunPlan(config, seeds=(1, 2), steps=steps, out=study / name, threads=1)


def test_a_file_of_settings_names_rules_relative_to_itself(study, monkeypatch):
    config = load_config(study / "my.toml")
    assert config.species["agent"].reward.rule == f"{study}/rules/own.py:pay"
    monkeypatch.chdir(study.parent)
    near = load_config("study/my.toml")
    assert near == config
    monkeypatch.chdir("/")
    assert len(Simulation(near, [1], 1).rules) == 2


def test_an_override_is_relative_to_the_current_folder(study, monkeypatch):
    monkeypatch.chdir(study / "rules")
    config = load_config(study / "my.toml", overrides=['reward.rule="own.py:pay"', 'hazard.rule="own.py:die"'])
    own = config.species["agent"]
    assert (own.reward.rule, own.hazard.rule) == (f"{study}/rules/own.py:pay", f"{study}/rules/own.py:die")
    two = load_config("baseline", overrides=['species.a.reward.rule="own.py:pay"', "species.b.body.radius=10"])
    assert [each.reward.rule for each in two.species.values()] == [f"{study}/rules/own.py:pay", ""]


def test_a_config_with_rules_is_read_back_from_anywhere(study):
    for config in (load_config(study / "my.toml", overrides=LIVELY), plan(study, "run").config):
        text = dump_toml(config)
        file = study / "rules" / "again.toml"
        file.write_text(text)
        assert load_config(file) == parse_config(text, "text") == config


def test_a_run_is_the_same_wherever_its_rule_is(study, tmp_path):
    shutil.copytree(study, tmp_path / "copy")
    one, other = (plan(folder, "run").config for folder in (study, tmp_path / "copy"))
    assert digest(one) == digest(other)
    assert str(tmp_path) not in dump_toml(one)


def test_a_moved_run_continues_without_the_file(study, tmp_path, monkeypatch):
    whole = run(plan(study, "whole", 160))
    run(plan(study, "run"))
    source = open_run(study / "run").manifest.rules[0]
    assert (source.file, source.path, source.text) == ("own.py", f"{study}/rules/own.py", TEXT)
    moved = tmp_path / "moved"
    (study / "run").rename(moved)
    shutil.rmtree(study / "rules")
    monkeypatch.chdir("/")
    with lock(moved, 160) as found:
        assert not any("own.py" in note for note in found.notes)
    done = resume(moved, 160, 1)
    assert done.world_digests == whole.world_digests
    assert done.rules == whole.rules
    assert check_run(moved).findings == ()
    findings, said = replay_run(moved, 1)
    assert findings == ()
    assert "and compared" in said
    child = branch(moved, tmp_path / "branch", steps=200, threads=1)
    assert child.rules == done.rules
    assert resume(tmp_path / "branch", 220, 1).world_digests == resume(moved, 220, 1).world_digests


def test_a_changed_file_is_named_and_its_new_text_is_not_used(study):
    whole = run(plan(study, "whole", 160))
    run(plan(study, "run"))
    (study / "rules" / "own.py").write_text(OTHER)
    with lock(study / "run", 160) as found:
        (note,) = (note for note in found.notes if "own.py" in note)  # one for both rules
    assert note.startswith(f"{study}/rules/own.py has changed since: continuing with the text that the manifest keeps")
    assert resume(study / "run", 160, 1).world_digests == whole.world_digests
    new = ['reward.rule="%s:pay"' % (study / "rules" / "own.py")]
    child = branch(study / "run", study / "branch", new, steps=200, threads=1)
    assert [rule.text for rule in child.rules] == [OTHER, TEXT]
    assert resume(study / "branch", 220, 1).rules == child.rules


def test_a_text_in_the_manifest_that_changed_is_refused(study):
    run(plan(study, "run"))
    path = study / "run" / "manifest.json"
    manifest = json.loads(path.read_text())
    manifest["rules"][0]["text"] = OTHER
    path.write_text(json.dumps(manifest))
    with pytest.raises(RuleError, match=r"rule own\.py:pay@\w{16}: the text that the manifest keeps is another one"):
        resume(study / "run", 160)


def test_a_fault_is_replayed_with_the_text_that_the_run_keeps(study, monkeypatch):
    (study / "rules" / "own.py").write_text(TEXT.replace("+ 0.5", "/ (agent.age - 20.0) / (agent.age - 20.0) * 0.0"))
    failing = plan(study, "run")
    with pytest.raises(Exception, match="rule_not_finite"):
        run(failing)
    shutil.rmtree(study / "rules")
    monkeypatch.chdir("/")
    again = replay_fault(study / "run", 1)
    assert again.recurred == again.recorded


def test_the_config_of_a_run_can_start_another_one(study):
    """The command line finds the texts next to it; a program passes them."""
    first = run(plan(study, "run"))
    shutil.rmtree(study / "rules")
    config = load_config(study / "run" / "config.toml")
    with pytest.raises(RuleError, match=r"cannot read own\.py .*keeps its text: give its rules"):
        RunPlan(config, seeds=(1, 2), steps=96, out=study / "lost")
    told = RunPlan(config, (1, 2), 96, study / "told", 1, rules=first.rules)
    assert run(told).world_digests == first.world_digests
    simulation = Simulation(told.config, (1, 2), 1, rules=told.rules)
    simulation.run(96)
    assert tuple(world.digest() for world in simulation.worlds) == first.world_digests
    source, out = str(study / "run" / "config.toml"), str(study / "typed")
    words = ["run", source, "--seeds", "1-2", "--steps", "96", "--out", out, "--threads", "1", "--no-report"]
    assert CliRunner().invoke(app, words).exit_code == 0
    assert open_run(study / "typed").manifest.world_digests == first.world_digests


def test_a_rule_of_a_program_is_relative_to_the_current_folder(study, monkeypatch):
    config = load_config("baseline", overrides=LIVELY)
    config = config.with_("reward.rule", "own.py:pay")
    with pytest.raises(RuleError, match=rf"cannot read own\.py in {Path.cwd()}: No such file"):
        Simulation(config, [1])
    monkeypatch.chdir(study / "rules")
    assert Simulation(config, [1]).rules[0].source.path == f"{study}/rules/own.py"
