"""Device failures and what remains of a run after one, on the emulated device, which can be made to fail."""

import ctypes
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command import hedon
from cuda_emulation import emulated as emulated
from resumed_run import WINDOW, small_run
from worlds import QUICK, make_simulation

from hedon import _engine
from hedon.check.run import check_run
from hedon.error import EngineError
from hedon.experiment import device
from hedon.experiment.device import EMULATION_VARIABLE, few_worlds
from hedon.experiment.resume import resume
from hedon.experiment.simulation import BACKEND_VARIABLE
from hedon.record.manifest import load_manifest

FEW = ("population.capacity=24", "population.initial_count=12")
NEVER = -1
Fails = Callable[[int, int], None]


@pytest.fixture
def fails(emulated: str) -> Iterator[Fails]:
    """fails(run, bytes): lose the devices in the N-th run from now, and allocate at most that many bytes at once."""
    set_failure = ctypes.CDLL(os.environ[EMULATION_VARIABLE]).hedon_emulation_fails
    set_failure.argtypes = (ctypes.c_int64, ctypes.c_int64)
    yield set_failure
    set_failure(NEVER, NEVER)


def test_too_little_memory_gives_one_sentence_and_leaves_the_device_usable(emulated: str, fails: Fails):
    fails(NEVER, 1_000_000)
    with pytest.raises(EngineError, match="device 'cuda-emulated': the device has too little memory for these"):
        make_simulation(*QUICK, *FEW, backend=emulated)
    fails(NEVER, NEVER)
    make_simulation(*QUICK, *FEW, backend=emulated).run(3)


@pytest.mark.parametrize("by", ["option", "variable"])
def test_a_run_of_few_worlds_says_that_the_processor_may_be_faster(
    emulated: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, by: str
):
    if by == "variable":
        monkeypatch.setenv(BACKEND_VARIABLE, emulated)
    chosen = ("--backend", emulated) if by == "option" else ()
    settings = [word for each in (*QUICK, *FEW) for word in ("--set", each)]
    done = hedon("run", "baseline", "--steps", "2", *settings, *chosen, "--no-report", "--out", str(tmp_path / "run"))
    assert "is probably faster than a device: leave --backend out." in done.stdout
    assert few_worlds(3, 1) == ""
    assert few_worlds(2, 1).startswith("With fewer than about 3 worlds, the processor (1 core) is")


def test_losing_a_device_loses_nothing_that_the_host_holds(emulated: str, fails: Fails):
    simulation = make_simulation(*QUICK, *FEW, seeds=(1, 2, 3), backend=emulated)
    simulation.run(5)
    alive = [world.alive for world in simulation.worlds]
    fails(1, NEVER)
    for _ in range(2):
        with pytest.raises(EngineError, match="device 'cuda-emulated': the emulated device is lost"):
            simulation.run(5)
    assert [(world.step, world.alive) for world in simulation.worlds] == [(5, count) for count in alive]
    for lost in (simulation.worlds[0].digest, lambda: simulation.worlds[0].view("params")):
        with pytest.raises(EngineError, match="is lost"):
            lost()


def test_a_run_resumes_from_its_last_checkpoint_after_losing_its_device(
    emulated: str, fails: Fails, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """It ends with the same bits as a run that lost nothing."""
    whole = small_run(tmp_path / "whole", 6 * WINDOW)
    assert small_run(tmp_path / "run", 2 * WINDOW, backend=emulated).status == "finished"
    with monkeypatch.context() as asked:
        asked.setenv(BACKEND_VARIABLE, emulated)
        fails(4, NEVER)
        with pytest.raises(EngineError, match="is lost"):
            resume(tmp_path / "run", 6 * WINDOW)
    failed = load_manifest(tmp_path / "run")
    assert failed.status == "failed"
    assert "is lost" in (failed.fault or "")
    fails(NEVER, NEVER)
    again = resume(tmp_path / "run", 6 * WINDOW)
    assert again.world_digests == whole.world_digests
    assert again.records_digest == whole.records_digest
    assert check_run(tmp_path / "run").findings == ()


def test_the_host_waits_for_a_device_only_at_the_ends_of_windows(
    emulated: str, fails: Fails, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """Except in the first, when the number of deaths is unknown: there are five calls, and a sixth would fail."""
    monkeypatch.setattr("hedon.experiment.run.PIECE_SECONDS", 1e-9)
    fails(6, NEVER)
    long = ("world.rollout_steps=128", "hazard.kappa=0.001")
    assert small_run(tmp_path / "run", 4 * 128, seeds=(1,), overrides=long, backend=emulated).status == "finished"


def test_a_library_that_is_older_than_the_engine_is_refused(
    emulated: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    library = tmp_path / "_cuda.so"
    shutil.copyfile(os.environ[EMULATION_VARIABLE], library)
    monkeypatch.setattr(device, "library_path", lambda: library)
    assert device.device_problem("cuda") == ""
    built = Path(_engine.__file__).stat().st_mtime
    os.utime(library, (built - 1, built - 1))
    assert "its library is older than the engine" in device.device_problem("cuda")


@pytest.mark.parametrize("worlds", [1, 2, 5])
def test_worlds_are_distributed_over_all_devices(emulated: str, worlds: int):
    simulation = make_simulation(*QUICK, *FEW, seeds=tuple(range(worlds)), backend=emulated)
    assert simulation.engine.device_count == min(worlds, 2)
    simulation.run(70)
    same = make_simulation(*QUICK, *FEW, seeds=tuple(range(worlds)), backend="avx2")
    same.run(70)
    assert [world.digest() for world in simulation.worlds] == [world.digest() for world in same.worlds]
    seconds = simulation.engine.device_seconds
    assert min(seconds.values()) > 0.0
    assert set(seconds) == {"step", "learn", "close", "copying"}
