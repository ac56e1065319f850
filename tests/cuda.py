"""Compiles the step path for CUDA, with the compiler of the package `nvidia-cuda-nvcc`: `python tests/cuda.py`.

No device is needed, and none is used: this keeps the sources fit for one.
"""

import importlib.util
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
OPTIONS = (
    "-std=c++20",
    "-arch=sm_90",
    "-cubin",
    "-Xptxas=-O1",  # a quarter of a minute less; nothing is run
    "--fmad=false",  # a product and a sum stay two roundings, as on the CPU
    "--expt-relaxed-constexpr",
    "--extended-lambda",
    "-Werror=all-warnings",
    "--diag-suppress=1675",  # pragmas of other compilers
)


def find_nvcc() -> Path | None:
    """The compiler in this environment, or None: there is no package for every machine."""
    spec = importlib.util.find_spec("nvidia")
    places = list(spec.submodule_search_locations or ()) if spec else []
    return next((path for place in places for path in sorted(Path(place).glob("*/bin/nvcc"))), None)


def main() -> int:
    nvcc = find_nvcc()
    if nvcc is None:
        print("cuda: no nvcc in this environment, nothing compiled")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        binary = Path(folder) / "window.cubin"
        source = ROOT / "engine" / "cuda" / "window.cu"
        code = subprocess.run(
            [str(nvcc), *OPTIONS, f"-I{ROOT / 'engine'}", "-o", str(binary), str(source)], check=False
        ).returncode
        if code == 0:
            print(f"cuda: the step path compiles for sm_90, {binary.stat().st_size / 1e6:.1f} MB")
        return code


if __name__ == "__main__":
    sys.exit(main())
