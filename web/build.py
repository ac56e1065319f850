"""Builds what `hedon view` shows: the page, then the engine's two WebAssembly modules, if their sources have changed.

`make viewer` runs it. It needs Node with npm for the page, and the dependency group `viewer` for the modules.
"""

import hashlib
import os
import subprocess
import sys
import tomllib
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
DIGESTS = ROOT / "web" / "modules.sha256"
"""Digests of the modules in the package and of what they were built from, so that they are built only when needed."""


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


def digests() -> str:
    """The content of `DIGESTS` as it should be: a line for the sources, and one for each module in the package."""
    inputs = hashlib.sha256(Path(__file__).read_bytes())
    inputs.update(repr(tomllib.loads((ROOT / "pyproject.toml").read_text())["dependency-groups"]["viewer"]).encode())
    headers = {path.relative_to(ROOT).as_posix() for path in (ROOT / "engine").rglob("*.h")}
    for path in sorted({*headers, *(source for source, _ in sources())}):
        if not path.startswith(("engine/binding/", "engine/cuda/")):  # no module includes them
            inputs.update(path.encode() + (ROOT / path).read_bytes())
    modules = [STATIC / name for name in MODULES if (STATIC / name).exists()]
    lines = [("sources", inputs), *((path.name, hashlib.sha256(path.read_bytes())) for path in modules)]
    return "".join(f"{content.hexdigest()}  {name}\n" for name, content in lines)


def build_page(folder: Path) -> None:
    """Builds the page into a folder."""
    web = ROOT / "web"
    subprocess.run(["npm", "install", "--no-save", "--no-audit", "--no-fund", "--silent"], cwd=web, check=True)
    subprocess.run(["npm", "run", "--silent", "build", "--", "--outDir", str(folder)], cwd=web, check=True)


def main() -> None:
    """Builds the page into the package, and the modules if their sources or they themselves have changed."""
    build_page(STATIC)
    if DIGESTS.read_text() == digests():
        return
    for name in MODULES:
        build_module(name, STATIC)
    DIGESTS.write_text(digests())


if __name__ == "__main__":
    main()
