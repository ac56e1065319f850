"""The WebAssembly engine and the native engine give the same bits from the same config."""

import json
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest
from project_files import ROOT

from hedon import Simulation, _engine, load_config
from hedon.view.engine_text import engine_text

STATIC = ROOT / "src" / "hedon" / "view" / "static"
FUSED = next((name for name in ("avx512", "avx2") if name in _engine.kernel.kernel_names()), "")
MODULES = [
    ("hedon.wasm", "portable"),
    pytest.param(
        "hedon-relaxed.wasm",
        FUSED,
        marks=pytest.mark.skipif(not FUSED, reason="this processor does not fuse a multiplication with an addition"),
    ),
]
LONG_PRESETS = ["baseline", "poison", "predator"]
STEPS = 1030  # a window with its learning, and the first steps afterwards

needs_node = pytest.mark.skipif(
    shutil.which("node") is None, reason="needs Node 20 or newer: apt-get install nodejs, or https://nodejs.org"
)


def run_in_node(module: str, text: str, folder: Path, steps: int, work_slice: int = 50, threads: int = 0) -> dict:
    """`threads=0` means one thread without shared memory."""
    return in_node("digest.mjs", module, text, folder, str(steps), str(work_slice), str(threads))


def in_node(program: str, module: str, text: str, folder: Path, *more: str) -> dict:
    (folder / "world.txt").write_text(text)
    version = subprocess.run(["node", "--version"], capture_output=True, text=True, check=True).stdout
    flags = ["--experimental-wasm-relaxed-simd"] if version.startswith(("v20.", "v21.")) else []
    command = ["node", *flags, str(ROOT / "web" / "test" / program), str(STATIC / module), str(folder / "world.txt")]
    done = subprocess.run([*command, *more], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@cache
def native_digest(preset: str, kernel: str, steps: int, *overrides: str) -> str:
    simulation = Simulation(load_config(preset, overrides=overrides), seeds=[1], backend=kernel)
    simulation.run(steps)
    return simulation.worlds[0].digest()


@needs_node
@pytest.mark.parametrize(("preset", "window"), [("poison", 1024), ("predator", 256)])
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_a_window_has_the_bits_of_the_native_engine(module, kernel, preset, window, tmp_path):
    shorter, steps = f"world.rollout_steps={window}", window + 6
    found = run_in_node(module, engine_text(load_config(preset, overrides=[shorter]), 1), tmp_path, steps)
    assert found["digest"] == native_digest(preset, kernel, steps, shorter)
    assert found["step"] == steps


@needs_node
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_learners_that_scale_and_normalize_have_the_bits_of_the_native_engine(module, kernel, tmp_path):
    settings = (
        "species.prey.learning.reward_scaling=window",
        "species.predator.learning.advantage_normalization=window",
    )
    settings += ("world.rollout_steps=256",)
    found = run_in_node(module, engine_text(load_config("predator", overrides=settings), 1), tmp_path, 518)
    assert found["digest"] == native_digest("predator", kernel, 518, *settings)


@needs_node
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_queries_of_two_species_have_the_bits_of_the_native_engine(module, kernel, tmp_path):
    """Agents observe their nearest neighbor and are paid for nearby kin and meals, weighted by who is near."""
    settings = ("neighbor.foe={of=['predator'], range=90}", "neighbor.any={of=['normal', '*']}")
    settings += ("species.predator.neighbor.foe=false", "species.prey.reward.family=around")
    settings += ("species.prey.reward.gate=foe_count", "reward.pay.any_meals={}", "reward.pay.any_kin={}")
    settings += ("sensor.observes.any_bearing=3", "sensor.observes.any_distance=50", "world.rollout_steps=256")
    found = run_in_node(module, engine_text(load_config("predator", overrides=settings), 1), tmp_path, 262)
    assert found["digest"] == native_digest("predator", kernel, 262, *settings)


@needs_node
@pytest.mark.parametrize("threads", [1, 2, 3])
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_threads_change_no_bit(module, kernel, threads, tmp_path):
    found = run_in_node(module, engine_text(load_config("small"), 1), tmp_path, STEPS, threads=threads)
    assert found["digest"] == native_digest("small", kernel, STEPS)


@needs_node
def test_a_world_that_lacks_memory_or_threads_says_so(tmp_path):
    told = in_node("thread.mjs", "hedon.wasm", engine_text(load_config("small"), 1), tmp_path)
    assert told["memory"].startswith(
        "the world needs 0.1 GB of memory, and a page has at most 0.0 GB: lower population"
    )
    assert told["start"] == (
        "thread 2 of the engine cannot start (its program cannot be loaded): put threads=1 into the page's link"
    )
    assert told["many"] == "there is no room for another thread: ask for fewer"
    assert re.fullmatch(r"the engine stopped in its thread 3 \(.+\): begin the world again", told["stopped"])
    assert told["again"] == 10


@needs_node
def test_a_world_too_large_for_any_page_is_refused_before_it_is_made(tmp_path):
    text = engine_text(load_config("small", overrides=["population.capacity=15000"]), 1)
    words = r"the world needs 5\.\d GB of memory, and a page has at most 4\.0 GB: lower population\.capacity"
    with pytest.raises(AssertionError, match=words):
        in_node("digest.mjs", "hedon.wasm", text, tmp_path, "1", "50", "0")


@needs_node
@pytest.mark.long
def test_a_world_above_2_gigabytes_runs_and_says_when_memory_is_full(tmp_path):
    """Addresses above 2 GB are negative as signed numbers, and the allocator cannot give out such a block at once."""
    config = load_config("small", overrides=["population.capacity=7800"])
    told = in_node("large.mjs", "hedon.wasm", engine_text(config, 1), tmp_path, "10")
    simulation = Simulation(config, seeds=[1], backend="portable")
    simulation.run(10)
    assert told["needed"] > 2.5e9
    assert told["digest"] == simulation.worlds[0].digest()
    assert told["first"] == simulation.worlds[0].view("life.agent_id")[0]
    assert told["kept"] == "there is no memory left to keep the world"
    assert told["going"] == 1


@needs_node
@pytest.mark.long
@pytest.mark.parametrize("threads", [0, 2])
@pytest.mark.parametrize("preset", LONG_PRESETS)
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_twenty_windows_have_the_bits_of_the_native_engine(module, kernel, preset, threads, tmp_path):
    found = run_in_node(module, engine_text(load_config(preset), 1), tmp_path, 20 * 1024, threads=threads)
    assert found["digest"] == native_digest(preset, kernel, 20 * 1024)


@needs_node
def test_the_size_of_the_slices_of_learning_changes_no_bit(tmp_path):
    text = engine_text(load_config("small"), 3)
    assert (
        run_in_node("hedon.wasm", text, tmp_path, 1024, 1)["digest"]
        == (run_in_node("hedon.wasm", text, tmp_path, 1024, 1000)["digest"])
    )


@needs_node
@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("species[0].energy.initial=10.0", r"energy\.initial: is there twice"),
        ("no.such=1", "no.such: is unknown"),
        ("wall=1,2,3", "'1,2,3' is not four numbers"),
    ],
)
def test_the_module_says_what_is_wrong_with_its_input(line, words, tmp_path):
    with pytest.raises(AssertionError, match=words):
        run_in_node("hedon.wasm", engine_text(load_config("small"), 1) + line + "\n", tmp_path, 1)


@needs_node
def test_the_module_refuses_what_the_engine_refuses(tmp_path):
    text = engine_text(load_config("small"), 1)
    wrong = text.replace("population.initial_count=", "population.initial_count=9")
    with pytest.raises(AssertionError, match=r"population\.initial_count"):
        run_in_node("hedon.wasm", wrong, tmp_path, 1)
    with pytest.raises(AssertionError, match=r"energy\.initial: is missing"):
        run_in_node("hedon.wasm", "\n".join(x for x in text.split("\n") if "energy.initial=" not in x), tmp_path, 1)


SHORT = ["world.rollout_steps=256", "population.capacity=90"]


@pytest.fixture(scope="module")
def handled(tmp_path_factory):
    """The results of edit.mjs on a world with short windows."""
    if shutil.which("node") is None:
        pytest.skip("needs Node 20 or newer")
    text = engine_text(load_config("small", overrides=SHORT), 1)
    return in_node("edit.mjs", "hedon.wasm", text, tmp_path_factory.mktemp("edit"))


def test_a_world_can_be_changed_by_hand_where_there_is_room(handled):
    first, more, again = handled["alive"]
    assert (more - first, again - first) == (1, 0)
    assert handled["death"] == [300, 300]
    assert [count - handled["foods"][0] for count in handled["foods"]] == [0, 1, 0]
    assert (handled["untouched"], handled["edited"]) == (False, True)
    for refusal in (handled["overlap"], handled["wall"]):
        assert refusal.startswith("there is no room: something is in the way")
    assert handled["full"] == "there is no room: population.capacity is 90"
    assert handled["unknown"] == "there is no such species or food"
    assert handled["nothing"] == "there is nothing to remove"
    # The audit at the end of the next window found nothing, and agents can be added after the last death.
    assert (handled["step"], handled["extinct"], handled["still"], handled["again"]) == (600, 600, 0, 5)
    must_learn, *refusals = handled["learning"]
    assert must_learn
    assert all(refusal.startswith("the agents are learning") for refusal in refusals)


def test_a_kept_world_continues_with_the_same_bits(handled):
    simulation = Simulation(load_config("small", overrides=SHORT), seeds=[1], backend="portable")
    simulation.run(300)
    assert handled["back"] == 100
    assert handled["first"] == handled["second"] == simulation.worlds[0].digest()


@needs_node
def test_no_agent_can_be_added_if_children_inherit_late(tmp_path):
    text = engine_text(load_config("small", "released"), 1)
    with pytest.raises(AssertionError, match="inherit at the end of a window"):
        in_node("edit.mjs", "hedon.wasm", text, tmp_path, "add")
