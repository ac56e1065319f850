"""Whole runs through the emulated device: records, checkpoints, resuming on either side, the check of the folder."""

import platform
from pathlib import Path

import pytest
from cuda_emulation import emulated as emulated

from hedon.check.run import check_run
from hedon.config.load import load_config
from hedon.experiment.plan import RunPlan
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.experiment.simulation import KERNEL_VARIABLE

SETTINGS = (
    "learning.rollout_steps=32",
    "learning.minibatch_size=16",
    "learning.update_epochs=1",
    "population.capacity=8",
    "population.initial_count=4",
    "hazard.alpha_age=0.005",
)


@pytest.mark.skipif(platform.machine() != "x86_64", reason="compares with AVX2")
def test_a_run_goes_on_from_device_to_processor_with_the_same_bits(
    emulated: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    config = load_config("baseline", overrides=SETTINGS)

    def plan(name: str, steps: int, kernel: str) -> RunPlan:
        return RunPlan(config, (1, 2), steps, tmp_path / name, 1, kernel=kernel)

    run(plan("mixed", 40, emulated))
    with monkeypatch.context() as asked:
        asked.setenv(KERNEL_VARIABLE, emulated)
        resume(tmp_path / "mixed", 75, 1)
    mixed = resume(tmp_path / "mixed", 100, 1)
    whole = run(plan("whole", 100, "avx2"))
    assert mixed.world_digests == whole.world_digests
    assert mixed.records_digest == whole.records_digest
    assert check_run(tmp_path / "mixed").findings == ()
    kernels = [session.kernel for session in mixed.sessions]
    assert kernels[:2] == [emulated, emulated]
    assert kernels[2] in ("avx2", "avx512")
