"""Builds the library of CUDA devices next to the engine: `python engine/cuda/build.py [FILE]`, or `make cuda`.

It takes nvcc and a C++ compiler, no device and no other part of CUDA: nvcc from PATH or CUDA_HOME, or from the package
`nvidia-cuda-nvcc` (`uv sync --group cuda`). Only the standard library is used, so that it runs on bare machines.
"""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

ENGINE = Path(__file__).parents[1]
ARCHITECTURE = "sm_90"
"""The oldest devices whose blocks have enough shared memory; code for newer ones is made from it when it is loaded."""
OPTIONS = (
    "-std=c++20",
    f"-arch={ARCHITECTURE}",
    "--fmad=false",  # a product and a sum stay two roundings, as on the CPU
    "--expt-relaxed-constexpr",
    "--extended-lambda",
    "--diag-suppress=1675",  # pragmas of other compilers
)
HOST = "-Xcompiler=-fPIC,-fvisibility=hidden,-ffp-contract=off"


class BuildError(Exception):
    """Why the library cannot be built, in one sentence."""


def find_nvcc() -> Path | None:
    """The compiler: of CUDA_HOME, of PATH, or of the packages of this Python; or None."""
    home = os.environ.get("CUDA_HOME", "")
    packages = Path(sysconfig.get_path("purelib")) / "nvidia"
    places = [Path(home) / "bin" / "nvcc"] if home else []
    places += [Path(found)] if (found := shutil.which("nvcc")) else []
    places += [*sorted(packages.glob("*/bin/nvcc")), Path("/usr/local/cuda/bin/nvcc")]
    return next((place for place in places if place.is_file()), None)


def runtime_options(nvcc: Path) -> list[str]:
    """Options with the location of CUDA's runtime, which the packages keep in another folder than nvcc expects."""
    folders = [nvcc.resolve().parents[1] / name for name in ("lib", "lib64")]
    return [f"-L{folder}" for folder in folders if folder.is_dir()]


def variants() -> list[str]:
    """Names of the variants of the kernels (`variant.h`); the default is the first."""
    text = (ENGINE / "cuda" / "variant.h").read_text()
    default = re.findall(r"^#define HEDON_VARIANT (\w+)$", text, re.MULTILINE)
    names = re.findall(r"^inline constexpr Variant (\w+)\{", text, re.MULTILINE)
    return [*default, *(name for name in names if name not in default)]


def same_kernels(variant: str) -> str:
    """The first variant with the same kernels: variants may differ only in their last field, which the host uses."""
    text = (ENGINE / "cuda" / "variant.h").read_text()
    fields = dict(re.findall(r"^inline constexpr Variant (\w+)\{\"\w+\", (.+), \w+\};", text, re.MULTILINE))
    return next(name for name in variants() if fields[name] == fields[variant])


def variant_option(variant: str) -> str:
    """The compiler's option that chooses a variant."""
    return f"-DHEDON_VARIANT={variant}"


def command(nvcc: Path, *arguments: str) -> list[str]:
    """A call of nvcc with the options of the engine."""
    return [str(nvcc), *OPTIONS, f"-I{ENGINE}", *arguments]


def build(out: Path) -> None:
    """Writes the library.

    Raises:
        BuildError: There is no compiler, or it fails.
    """
    nvcc = find_nvcc()
    if nvcc is None:
        raise BuildError("no nvcc in CUDA_HOME, PATH or this environment: install it by `uv sync --group cuda`")
    part = out.with_suffix(f".{os.getpid()}")
    source = str(ENGINE / "cuda" / "device.cu")
    done = subprocess.run(
        command(nvcc, "-shared", HOST, *runtime_options(nvcc), "-o", str(part), source),
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise BuildError(f"nvcc fails:\n{done.stderr}")
    part.replace(out)


def beside_engine() -> Path:
    """Where hedon looks for the library."""
    from hedon.experiment.device import library_path

    return library_path()


def main(arguments: list[str]) -> int:
    """Builds into the file that is named, or where hedon looks for it."""
    out = Path(arguments[0]) if arguments else beside_engine()
    try:
        build(out)
    except BuildError as error:
        print(f"cuda: {error}", file=sys.stderr)
        return 2
    print(f"cuda: {out}, {out.stat().st_size / 1e6:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
