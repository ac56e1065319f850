"""The policy `fixed`: agents act with networks that never learn, either new ones or the networks of a run."""

import numpy as np
import pytest
from worlds import QUICK, make_simulation

import hedon
from hedon import RunPlan, load_config
from hedon.check.run import check_run
from hedon.config.problem import ConfigError
from hedon.experiment.branch import branch
from hedon.experiment.network import networks_from
from hedon.experiment.resume import resume
from hedon.experiment.run import run
from hedon.experiment.simulation import Simulation
from hedon.record.checkpoint import load_checkpoint
from hedon.record.folder import checkpoint_paths
from hedon.record.network import NETWORKS, NetworkError, Networks, read_networks

LIVELY = (*QUICK, "birth.kappa=0.02", "hazard.kappa=0.2")
FROZEN = ('learning.policy="fixed"', 'birth.network="initial"')
EXACT = (*FROZEN, "birth.network_noise=0")
BOTH = (
    *LIVELY,
    "population.capacity=60",
    "population.initial_count=30",
    "species.wise.body.radius=10",
    *(f"species.fixed.{setting}" for setting in EXACT),
)


@pytest.fixture(scope="module")
def learned(tmp_path_factory):
    """A finished run of two learning species."""
    folder = tmp_path_factory.mktemp("learned") / "run"
    settings = [each for each in BOTH if not each.startswith("species.fixed")] + ["species.fixed.body.radius=10"]
    run(RunPlan(load_config("baseline", overrides=settings), (1, 2), 256, folder, 1))
    return folder


def test_networks_never_change_and_children_inherit_them():
    simulation = make_simulation(*LIVELY, *EXACT)
    world = simulation.worlds[0]
    founders = world.view("params")[world.living].copy()
    simulation.run(300)
    assert world.counters["learners"] == 0 < world.counters["births"]
    assert world.view("observation").shape[1] == 2  # no rollout is kept
    saved = simulation.engine.save(0)
    assert "params" in saved
    assert not {"updates", "first_moment", "observation"} & set(saved)
    assert {row.tobytes() for row in saved["params"]} <= {row.tobytes() for row in founders}
    assert len(np.unique(world.view("action")[world.living, 0])) > 10  # they act, each with its own network


def test_with_noise_networks_evolve_without_learning():
    simulation = make_simulation(*LIVELY, *FROZEN, "birth.network_noise=0.1")
    world = simulation.worlds[0]
    simulation.run(300)
    agents, params = world.agents(), world.view("params")[world.living]
    row = {agent: i for i, agent in enumerate(agents["agent_id"])}
    pairs = [(row[parent], i) for i, parent in enumerate(agents["parent_id"]) if parent in row]
    assert len(pairs) > 5
    size = params.shape[1] - 11  # the last row is padded
    steps = np.array([params[child, :size] - params[parent, :size] for parent, child in pairs])
    assert abs(steps.std() - 0.1) < 0.002
    assert abs(steps.mean()) < 0.002


@pytest.mark.parametrize("settings", [BOTH, (*LIVELY, *FROZEN)])
@pytest.mark.parametrize("saved_at", [64, 90])
def test_threads_and_checkpoints_change_nothing(settings, saved_at):
    once = make_simulation(*settings, seeds=(3,))
    once.run(200)
    first, second = (make_simulation(*settings, seeds=(3,), threads=threads) for threads in (2, 1))
    first.run(saved_at)
    second.run(5)  # restoring replaces this state
    second.engine.restore(0, first.engine.save(0))
    assert first.worlds[0].digest() == second.worlds[0].digest()
    second.run(200 - saved_at)
    assert second.worlds[0].digest() == once.worlds[0].digest()


def test_founders_act_with_the_networks_of_a_run(learned, tmp_path):
    config = load_config("baseline", overrides=BOTH)
    networks = networks_from(str(learned), config)
    assert list(networks.params) == ["fixed"]
    checkpoint = load_checkpoint(checkpoint_paths(learned)[-1])
    there = [checkpoint.world(world) for world in range(2)]
    expected = [world["params"][(world["species"] == 1) & (world["updates"] > 0)] for world in there]
    assert np.array_equal(networks.params["fixed"], np.concatenate(expected))
    simulation = Simulation(config, [5])
    simulation.set_networks(networks)
    world = simulation.worlds[0]
    mine = world.living[world.agents()["species"] == 1]
    given = {row.tobytes() for row in networks.params["fixed"]}
    assert {row.tobytes() for row in world.view("params")[mine]} <= given
    others = world.living[world.agents()["species"] == 0]
    assert not {row.tobytes() for row in world.view("params")[others]} & given


def test_a_run_keeps_its_networks_and_continues_with_the_same_bits(learned, tmp_path):
    config = load_config("baseline", overrides=BOTH)
    networks = networks_from(str(learned), config)

    def plan(name, steps, **given):
        return RunPlan(config, (1,), steps, tmp_path / name, 1, **{"networks": networks, **given})

    whole = run(plan("whole", 192))
    run(plan("half", 96))
    assert resume(tmp_path / "half", 192, 1).records_digest == whole.records_digest
    again = run(plan("again", 192, networks=networks_from(str(tmp_path / "whole" / NETWORKS), config)))
    assert again.records_digest == whole.records_digest
    assert run(plan("new", 192, networks=None)).records_digest != whole.records_digest
    branched = branch(tmp_path / "half", tmp_path / "branch", ["species.wise.energy.basic_cost=0.01"], steps=256)
    assert branched.status == "finished"
    for name in ("whole", "half", "branch"):
        assert not check_run(tmp_path / name).findings
    (tmp_path / "half" / NETWORKS).write_bytes(b"PK")
    found = check_run(tmp_path / "half").findings
    assert [finding.where for finding in found] == [NETWORKS]
    with pytest.raises(NetworkError, match=r"networks\.npz: is not a file of networks"):
        resume(tmp_path / "half", 256, 1)
    with pytest.raises(hedon.ArgumentError, match="the config names a file of networks"):
        RunPlan(load_config(tmp_path / "whole" / "config.toml"), (1,), 64, tmp_path / "none", 1)


def refused(learned, *settings):
    config = load_config("baseline", overrides=settings)
    with pytest.raises(NetworkError) as error:
        networks_from(str(learned), config)
    return str(error.value)


def test_networks_that_do_not_fit_are_refused_by_name(learned, tmp_path):
    assert "no species has learning.policy" in refused(learned, *LIVELY)
    assert "has no networks of the species agent, only of: wise, fixed" in refused(learned, *LIVELY, *EXACT)
    fewer = refused(learned, *BOTH, "species.fixed.sensor.ray_count=8")
    assert "do not fit what it observes: their input 9 is ray_wise_8, and its is ray_fixed_0" in fewer
    assert "there is no such file or folder" in refused(tmp_path / "gone", *BOTH)
    (tmp_path / "text.npz").write_text("no")
    assert "is not a file of networks" in refused(tmp_path / "text.npz", *BOTH)
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    assert "has other arrays" in refused(tmp_path / "other.npz", *BOTH)
    with pytest.raises(NetworkError, match="cannot be read: No such file"):
        read_networks(tmp_path / "gone.npz")


def test_a_new_network_for_each_child_is_refused():
    with pytest.raises(ConfigError, match=r'birth.network = "none": must be "initial" with learning.policy = "fixed"'):
        load_config("baseline", overrides=['learning.policy="fixed"'])


@pytest.mark.parametrize("name", ["file", "allow_pickle", "args"])
def test_a_species_may_have_a_name_that_a_library_uses(tmp_path, name):
    made = Networks({name: np.ones((2, 3), np.float32)}, {name: ("food",)})
    (tmp_path / "networks.npz").write_bytes(made.content)
    found = read_networks(tmp_path / "networks.npz")
    assert found.digest == made.digest
    np.testing.assert_array_equal(found.params[name], made.params[name])
