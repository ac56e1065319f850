"""Builds what `hedon view` shows: the engine's two WebAssembly modules, then the page around them.

`make viewer` calls it. It needs Node with npm for the page, and the dependency group `viewer` for the modules.
"""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
STATIC = ROOT / "src" / "hedon" / "view" / "static"
# What a step and learning consist of, for speed; the rest runs once a world or a click, for size.
FAST = (
    "kernel/kernel.cpp",
    "kernel/portable.cpp",
    "simulation/drive.cpp",
    "simulation/simulation.cpp",
    "web/module.cpp",
)
SMALL = ("base/*.cpp", "simulation/*.cpp", "web/*.cpp")
FLAGS = (
    "--target=wasm32-wasi",
    "-std=c++20",
    "-fno-exceptions",
    "-fno-rtti",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-msimd128",
    "-Wall",
    "-Wextra",
    "-Werror",
    "-Iengine",
    # Threads: the page gives the memory, and says where each thread has its stack.
    "-matomics",
    "-mthread-model",
    "posix",
    "-mbulk-memory",
)
LINK = (
    "-O3",
    "-mexec-model=reactor",
    "-Wl,--strip-all",
    "-Wl,-z,stack-size=1048576",
    "-Wl,--import-memory",
    "-Wl,--shared-memory",
    "-Wl,--initial-memory=4194304",
    "-Wl,--max-memory=4294901760",
    "-Wl,--export=__stack_pointer",
    "-Wl,--export=__wasm_init_tls",
)
MODULES = {"hedon.wasm": (), "hedon-relaxed.wasm": ("-mrelaxed-simd",)}
"""Each module and the flags that it needs besides `FLAGS`: the second fuses multiply-adds where processors can."""


def sources() -> list[tuple[str, str]]:
    """The sources and how each is optimized: the fast ones first, whose inline functions the linker then takes."""
    small = {path for glob in SMALL for path in (ROOT / "engine").glob(glob)} - {
        ROOT / "engine" / name for name in FAST
    }
    return [(f"engine/{name}", "-O3") for name in FAST] + [
        (path.relative_to(ROOT).as_posix(), "-Oz") for path in sorted(small)
    ]


def build_module(name: str, folder: Path) -> Path:
    """Compiles one of `MODULES` into a folder, as many sources at a time as there are processors; returns its path."""
    compiler = [sys.executable, "-m", "ziglang", "c++"]
    out = folder / name
    with TemporaryDirectory() as objects, ThreadPoolExecutor(os.cpu_count()) as pool:

        def compiled(index: int, source: str, optimized: str) -> str:
            made = str(Path(objects) / f"{index}.o")
            command = [*compiler, *FLAGS, optimized, *MODULES[name], "-c", source, "-o", made]
            subprocess.run(command, cwd=ROOT, check=True)
            return made

        made = list(pool.map(compiled, *zip(*((i, *each) for i, each in enumerate(sources())), strict=True)))
        subprocess.run([*compiler, *FLAGS, *MODULES[name], *LINK, *made, "-o", str(out)], cwd=ROOT, check=True)
    out.chmod(0o644)
    return out


def build_page(folder: Path) -> None:
    """Builds the page into a folder."""
    web = ROOT / "web"
    subprocess.run(["npm", "install", "--no-save", "--no-audit", "--no-fund", "--silent"], cwd=web, check=True)
    subprocess.run(["npm", "run", "--silent", "build", "--", "--outDir", str(folder)], cwd=web, check=True)


def main() -> None:
    """Builds everything into the package; with an argument, into that folder."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else STATIC
    folder.mkdir(parents=True, exist_ok=True)
    build_page(folder)
    for name in MODULES:
        build_module(name, folder)


if __name__ == "__main__":
    main()
