"""A run that does not fit in memory is refused before it starts."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner
from worlds import make_simulation

from hedon import _engine
from hedon.cli.main import app
from hedon.config.load import load_config
from hedon.error import HedonError
from hedon.experiment import memory
from hedon.experiment.memory import memory_needed, memory_present, require_memory
from hedon.experiment.simulation import SCRATCH_VARIABLE

WORLD = ("networks", "moments and observations", "the rest of rollouts", "physics", "rest of the worlds")


def test_the_estimate_matches_the_reserved_memory():
    config, simulation = load_config("poison"), make_simulation(preset="poison", threads=2)
    need = memory_needed(config, 1, 2)
    assert sum(need[name] for name in WORLD) >= simulation.engine.bytes_per_world
    alone, five = (sum(memory_needed(config, worlds, 2)[name] for name in WORLD) for worlds in (1, 5))
    assert five - alone == pytest.approx(4 * simulation.engine.bytes_per_world)


def test_each_part_has_the_size_of_its_arrays():
    simulation, need = make_simulation(), memory_needed(load_config("baseline"), 1, 1)
    view = simulation.worlds[0].view
    acting = ("params", "folded_bias", "packed_weights")
    cold = ("first_moment", "second_moment", "observation")
    rollouts = ("action", "log_prob", "value", "reward")
    for what, names in zip(WORLD[:3], (acting, cold, rollouts), strict=True):
        assert need[what] == pytest.approx(sum(view(name).nbytes for name in names), rel=5e-3)


def test_the_refusal_of_a_run_that_does_not_fit_lists_its_parts(tmp_path, monkeypatch):
    monkeypatch.delenv(SCRATCH_VARIABLE, raising=False)
    monkeypatch.setattr(memory, "memory_present", lambda: 10**8)
    words = r"\d GB.*networks \d.*moments and observations .*rollouts .*physics .*records"
    with pytest.raises(HedonError, match=words):
        require_memory(load_config("baseline"), 3)
    folder = tmp_path / "run"
    answer = CliRunner().invoke(app, ["run", "baseline", "--seeds", "1-3", "--out", str(folder)])
    assert isinstance(answer.exception, HedonError)
    assert not folder.exists()


def test_the_command_exits_with_code_2(tmp_path):
    huge = ("--seeds", "1-10000", "--set", "population.capacity=10000", "--out", tmp_path / "run")
    answer = subprocess.run(["hedon", "run", "baseline", *map(str, huge)], capture_output=True, text=True, check=False)
    assert answer.returncode == 2
    assert "population.capacity (10,000)" in answer.stderr
    assert "Traceback" not in answer.stderr
    assert not (tmp_path / "run").exists()


def test_the_engine_knows_the_memory_of_the_machine():
    assert _engine.physical_memory() == os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def test_the_memory_limit_of_a_container_is_respected(tmp_path: Path):
    for name, text in (("two", "123456\n"), ("none", "max\n"), ("other", "")):
        (tmp_path / name).write_text(text)
    files = [str(tmp_path / name) for name in ("none", "other", "missing", "two")]
    assert memory_present(files) == 123456
    assert memory_present(files[:3]) > 123456


@pytest.mark.parametrize("in_files", [False, True])
def test_memory_that_the_system_refuses_is_an_error_not_a_crash(in_files: bool, tmp_path: Path):
    """Arrays in files need no memory, but they do need address space."""
    code = """
import resource
from hedon.config.load import load_config
from hedon.error import EngineError
from hedon.experiment.simulation import Simulation
resource.setrlimit(resource.RLIMIT_AS, (3_000_000_000, 3_000_000_000))
try:
    Simulation(load_config("baseline"), range(60), 1)
except EngineError as error:
    print(error)
"""
    given = os.environ | {SCRATCH_VARIABLE: str(tmp_path) if in_files else ""}
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=given)
    assert "refuses memory for the worlds" in answer.stdout, answer.stderr
