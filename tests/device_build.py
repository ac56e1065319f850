"""Builds the native program of `tests/device.py` for a device or its emulation, with each kernel variant."""

import hashlib
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "engine" / "cuda"))

import build

ROOT = Path(__file__).parents[1]
PLACE = ROOT / "build" / "device"
CPU_OPTIONS = ("-std=c++20", "-O2", "-ffp-contract=off", "-fno-math-errno", "-fvisibility=hidden", "-pthread")
FOR_FILE = {
    "avx2.cpp": ("-mavx2", "-mfma"),
    "avx512.cpp": ("-mavx512f", "-mavx512dq", "-mavx512bw", "-mavx512vl", "-mfma", "-mprefer-vector-width=512"),
}
EMULATION_OPTIONS = (*CPU_OPTIONS, "-mavx2", "-mfma", "-DHEDON_BLOCK_THREADS=64")


def build_programs(emulated: bool, variants: list[str]) -> dict[str, Path]:
    """The native program of each variant, rebuilt only if a source has changed.

    Raises:
        BuildError: A compiler is missing or fails.
    """
    engine, place = ROOT / "engine", PLACE / ("emulated" if emulated else "cuda")
    digest = source_digest()
    programs = {variant: place / variant / "device_trial" for variant in variants}
    marks = {variant: program.with_name("sources") for variant, program in programs.items()}
    stale = [variant for variant, mark in marks.items() if not mark.exists() or mark.read_text() != digest]
    if not stale:
        return programs
    compiler = os.environ.get("CXX") or next(filter(None, map(shutil.which, ("c++", "g++", "clang++"))), "c++")
    libraries: list[str] = []
    sources = [path for part in ("base", "kernel", "simulation") for path in sorted((engine / part).glob("*.cpp"))]
    sources += [engine / "web" / "input.cpp", ROOT / "tests" / "native" / "device_trial.cpp"]
    if emulated:
        sources += [engine / "cuda" / "emulator.cpp"]
        kernels = [compiler, *EMULATION_OPTIONS, f"-I{engine}", "-c", str(engine / "cuda" / "emulation.cpp")]
    else:
        nvcc = build.find_nvcc()
        if nvcc is None:
            raise build.BuildError("no nvcc in CUDA_HOME, PATH or this environment")
        kernels = build.command(nvcc, "-c", build.HOST, str(engine / "cuda" / "device.cu"))
        libraries = [*build.runtime_options(nvcc), "-lcudart_static", "-ldl", "-lrt"]
    commands, links = [], []
    objects = [str(place / f"{source.parent.name}-{source.stem}.o") for source in sources]
    for variant in stale:
        shutil.rmtree(place / variant, ignore_errors=True)
        (place / variant).mkdir(parents=True)
        made = str(place / variant / "kernels.o")
        commands.append([*kernels, build.variant_option(variant), "-o", made])
        links.append([compiler, "-pthread", *objects, made, *libraries, "-o", str(programs[variant])])
    for source, made in zip(sources, objects, strict=True):
        options = [*CPU_OPTIONS, *FOR_FILE.get(source.name, ()), f"-I{engine}"]
        commands.append([compiler, *options, "-c", str(source), "-o", made])
    compile_all(commands)
    compile_all(links)
    for variant in stale:
        marks[variant].write_text(digest)
    return programs


def source_digest() -> str:
    """A digest of all sources of the programs."""
    content = hashlib.sha256()
    for folder in (ROOT / "engine", ROOT / "tests" / "native"):
        for path in sorted(folder.rglob("*")):
            if path.suffix in {".h", ".cpp", ".cu"}:
                content.update(path.read_bytes())
    return content.hexdigest()


def compile_all(commands: list[list[str]]) -> None:
    """Runs compilers, as many at a time as there are processors.

    Raises:
        BuildError: One of them fails.
    """
    running: list[subprocess.Popen[str]] = []
    for command in commands:
        while sum(process.poll() is None for process in running) >= (os.cpu_count() or 1):
            time.sleep(0.05)
        running.append(subprocess.Popen(command, stderr=subprocess.PIPE, text=True))
    for process in running:
        said = process.communicate()[1]
        if process.returncode != 0:
            raise build.BuildError(f"a compiler fails:\n{said[-2000:]}")
