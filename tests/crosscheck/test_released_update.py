"""One learner's window as the paper's program computed it: advantages and 40 updates.

`update.npz`, recorded from that program: observations `obs` (1024, 95; rays by ray and then type), actions before the
sigmoid `act`, rewards `rew`, values `val`, the bootstrap `nv`, advantages `adv`, targets `tgt`, log-probabilities `lp`,
the permutations of ten epochs `perm`, and the weights before (`o_*`) and after (`n_*`), with its critic.
"""

from pathlib import Path
from typing import Any

import numpy as np
import ppo_reference
import pytest
from learning_case import KERNELS, ONE_KIND_RAW, config

from hedon import _engine

RAYS, TYPES, TOUCHES, _ = ONE_KIND_RAW
INPUTS = RAYS * TYPES + TOUCHES + 5


@pytest.fixture(scope="module")
def window() -> dict[str, np.ndarray]:
    return dict(np.load(Path(__file__).parents[1] / "data" / "update.npz"))


def packed(obs: np.ndarray) -> np.ndarray:
    """The observations as the engine stores them."""
    rays = obs[:, : RAYS * TYPES].reshape(-1, RAYS, TYPES)
    nearest, kind = rays.max(axis=2), rays.argmax(axis=2)
    hit = nearest > -1
    bits = obs[:, RAYS * TYPES : RAYS * TYPES + TOUCHES].astype(np.uint64)
    touch = (bits << np.arange(TOUCHES, dtype=np.uint64)).sum(axis=1, dtype=np.uint64)
    dense = np.ascontiguousarray(obs[:, -5:], np.float32)
    reading = np.where(hit, nearest + 1, 0).astype(np.float32)
    return _engine.learning.pack(reading, np.where(hit, kind, 0).astype(np.uint8), touch, dense)


def flat(window: dict[str, np.ndarray], prefix: str) -> np.ndarray:
    """A network's weights in the engine's order: rays by type and then ray, inputs before units."""
    p: dict[str, Any] = {name[2:]: values for name, values in window.items() if name.startswith(prefix)}
    rays = p["w1"][:, : RAYS * TYPES].reshape(-1, RAYS, TYPES).transpose(0, 2, 1).reshape(-1, RAYS * TYPES)
    w1 = np.concatenate([rays, p["w1"][:, RAYS * TYPES :]], axis=1)
    parts = [w1.T, p["b1"], p["w2"].T, p["b2"], p["wm"], p["wv"], p["bm"], p["bv"], p["ls"]]
    params = np.concatenate([np.ravel(part) for part in parts]).astype(np.float32)
    return np.pad(params, (0, _engine.learning.param_count(ONE_KIND_RAW) - len(params)))


def test_observations_survive_the_packing(window):
    full = _engine.learning.unpack(ONE_KIND_RAW, packed(window["obs"]))
    rays = window["obs"][:, : RAYS * TYPES].reshape(-1, RAYS, TYPES).transpose(0, 2, 1).reshape(-1, RAYS * TYPES)
    np.testing.assert_allclose(full[:, : RAYS * TYPES], rays, atol=2e-7)
    np.testing.assert_array_equal(full[:, RAYS * TYPES :], window["obs"][:, RAYS * TYPES :])


def test_advantages_and_targets(window):
    found = _engine.learning.gae(config(), window["rew"], window["val"], float(window["nv"][0]))
    np.testing.assert_allclose(found[0], window["adv"], atol=1e-5)
    np.testing.assert_allclose(found[1], window["tgt"], atol=1e-5)


@pytest.mark.parametrize("kernel", KERNELS)
def test_values_match_the_network_before_the_updates(window, kernel):
    output = _engine.learning.forward(kernel, ONE_KIND_RAW, flat(window, "o_"), packed(window["obs"]))
    np.testing.assert_allclose(output[:, 2], window["val"], atol=1e-5)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize(("critic", "most"), [("batch_mean", 1e-5), ("per_state", None)])
def test_forty_updates(window, kernel, critic, most):
    """Within 1e-5 with the program's own critic; the correct one gives another network."""
    before = flat(window, "o_")
    still, obs, settings = np.zeros_like(before), packed(window["obs"]), config(critic_target=critic)
    act, lp, adv, tgt, perm = (window[name] for name in ("act", "lp", "adv", "tgt", "perm"))
    after = _engine.learning.update(
        kernel, ONE_KIND_RAW, settings, before, still, still, 0, obs, act, lp, adv, tgt, perm
    )[0]
    found, wanted = (ppo_reference.split(params, INPUTS) for params in (after, flat(window, "n_")))
    worst = max(np.abs(found[name] - wanted[name]).max() for name in wanted)
    assert worst <= most if most is not None else worst > 1e-2
