"""The WebAssembly of the engine against the native one: the same bits, from the same config."""

import json
import shutil
import subprocess
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
STEPS = 1030  # a window with its learning, and the first steps with what was learned

needs_node = pytest.mark.skipif(
    shutil.which("node") is None, reason="needs Node 20 or newer: apt-get install nodejs, or https://nodejs.org"
)


def run_in_node(module: str, text: str, folder: Path, steps: int, portion: int = 50) -> dict:
    (folder / "world.txt").write_text(text)
    version = subprocess.run(["node", "--version"], capture_output=True, text=True, check=True).stdout
    flags = ["--experimental-wasm-relaxed-simd"] if version.startswith(("v20.", "v21.")) else []
    program = ROOT / "web" / "test" / "digest.mjs"
    arguments = [str(STATIC / module), str(folder / "world.txt"), str(steps), str(portion)]
    done = subprocess.run(["node", *flags, str(program), *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def native_digest(preset: str, kernel: str, steps: int) -> str:
    simulation = Simulation(load_config(preset), seeds=[1], kernel=kernel)
    simulation.run(steps)
    return simulation.worlds[0].digest()


@needs_node
@pytest.mark.parametrize("preset", ["poison", "predator"])
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_a_window_has_the_bits_of_the_native_engine(module, kernel, preset, tmp_path):
    found = run_in_node(module, engine_text(load_config(preset), 1), tmp_path, STEPS)
    assert found["digest"] == native_digest(preset, kernel, STEPS)
    assert found["step"] == STEPS


@needs_node
@pytest.mark.long
@pytest.mark.parametrize("preset", ["baseline", "small", "poison"])
@pytest.mark.parametrize(("module", "kernel"), MODULES)
def test_twenty_windows_have_the_bits_of_the_native_engine(module, kernel, preset, tmp_path):
    found = run_in_node(module, engine_text(load_config(preset), 1), tmp_path, 20 * 1024)
    assert found["digest"] == native_digest(preset, kernel, 20 * 1024)


@needs_node
def test_the_size_of_the_portions_of_learning_changes_no_bit(tmp_path):
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
