"""The example that trains a shared policy with Stable-Baselines3."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from hedon.check import check_run
from hedon.view.index import RunIndex

pytestmark = pytest.mark.long


def test_a_shared_policy_of_a_library_forages_better_than_chance_and_can_be_viewed(tmp_path):
    reason = "needs 5 GB that the project does not install: pip install stable-baselines3"
    pytest.importorskip("stable_baselines3", reason=reason)
    spec = spec_from_file_location("ppo", Path(__file__).parents[2] / "examples" / "ppo.py")
    assert spec is not None
    assert spec.loader is not None
    ppo = module_from_spec(spec)
    spec.loader.exec_module(ppo)
    model = ppo.train(1, 120_000)
    (trained,), random = ppo.compare([model])
    assert trained > 1.4 * random > 0
    ppo.record(model, tmp_path / "run")
    assert not check_run(tmp_path / "run").findings
    assert RunIndex(tmp_path / "run").describe()["steps"] == [ppo.STEPS]
