"""Compiles the CUDA code and compares the compiler's report on each kernel, and the cost of its machine code, with the
committed tables.

Usage: `python tests/cuda.py [--write]`, with the compiler from the package `nvidia-cuda-nvcc`. `--variants` checks all
kernel variants instead of the one in the library. No device is needed or used. Compiling takes two minutes per variant,
so the library's kernels are compiled only if their sources, the compiler or the tables are not those from which the
tables were last written, and any kernels only if they are not in `build/cuda`.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "engine" / "cuda"))

import build  # noqa: E402
from cuda_cost import count_costs, read_code  # noqa: E402

BUILT = ROOT / "build" / "cuda"
TABLE = ROOT / "tests" / "data" / "cuda_kernels.json"
COSTS = ROOT / "tests" / "data" / "cuda_cost.json"
VARIANTS = ROOT / "tests" / "data" / "cuda_variants.json"
DIGESTS = ROOT / "tests" / "data" / "cuda_tables.sha256"
"""Digests of the library's two tables and of all that they were made from."""
SOURCE = ROOT / "engine" / "cuda" / "device.cu"
COST_SLACK = 0.15
# Limits of one multiprocessor of compute capability 9.0. Source: CUDA C++ Programming Guide, technical specifications.
REGISTERS, RESIDENT_THREADS, SHARED_BYTES, SHARED_RESERVED = 65536, 2048, 228 * 1024, 1024
SLACK = 8  # registers: another version of the compiler may use a few more or fewer
LAUNCH = """
#include "cuda/block.h"
#include "cuda/learning_layout.h"
#include <cstdio>
int main() {
  using namespace hedon;
  const int step = static_cast<int>(STAGE_FIRST + stage_floats(VARIANT.staged));
  printf("%d %d %d", BLOCK_THREADS, step * 4, learning_layout(params_of(95)).total * 4);
}
"""
"""Prints the threads per block and the bytes of shared memory that each launch requests: for `StepWorlds::FLOATS`, and
for an update with 95 inputs."""
Launch = tuple[int, dict[str, int]]


def launch_sizes(variant: str, folder: Path) -> Launch:
    """Threads per block, and bytes of shared memory by kernel."""
    program = folder / "launch"
    compiler = os.environ.get("CXX") or "c++"
    options = ["-std=c++20", build.variant_option(variant), f"-I{ROOT / 'engine'}", "-x", "c++", "-", "-o"]
    subprocess.run([compiler, *options, str(program)], input=LAUNCH, text=True, check=True)
    answer = subprocess.run([str(program)], capture_output=True, text=True, check=True).stdout
    threads, step, learn = map(int, answer.split())
    return threads, {"StepWorlds": step, "LearnWorlds": learn}


def resident_blocks(registers: int, shared: int, threads: int) -> int:
    """Blocks of a kernel resident on one multiprocessor; registers are allocated in multiples of 8 per thread."""
    by_registers = REGISTERS // (-(-registers // 8) * 8 * threads)
    return min(by_registers, RESIDENT_THREADS // threads, SHARED_BYTES // (shared + SHARED_RESERVED))


def read_kernels(report: str, launch: Launch) -> dict[str, dict[str, int]]:
    """The figures that `ptxas -v` reports for each kernel, by the name of its functor."""
    threads, shared_bytes = launch
    kernels = {}
    pattern = (
        r"Compiling entry function '\w*run_kernelINS_\d+(\w+?)EEEvT_'.*?(\d+) bytes stack frame, (\d+) bytes spill "
        r"stores, (\d+) bytes spill loads\n.*?Used (\d+) registers"
    )
    for name, stack, stores, loads, registers in re.findall(pattern, report, re.DOTALL):
        shared = shared_bytes.get(name, 0)
        kernels[name] = {
            "registers": int(registers),
            "stack": int(stack),
            "spills": int(stores) + int(loads),
            "shared": shared,
            "blocks": resident_blocks(int(registers), shared, threads),
        }
    return kernels


def problems(found: dict[str, dict[str, int]], kept: dict[str, dict[str, int]]) -> list[str]:
    """Differences between the kernels and the table."""
    out = [f"{name}: it is in the table alone, or in the source alone" for name in sorted(found.keys() ^ kept.keys())]
    for name in sorted(found.keys() & kept.keys()):
        now, then = found[name], kept[name]
        if now["spills"] > then["spills"]:
            out.append(f"{name}: {now['spills']} bytes of registers are spilled, and the table has {then['spills']}")
        if abs(now["registers"] - then["registers"]) > SLACK or now["blocks"] != then["blocks"]:
            out.append(f"{name}: {now}, and the table has {then}: call `python tests/cuda.py --write` if that is right")
    return out


def costs_of(nvcc: Path, binary: Path) -> dict[str, dict[str, float]]:
    """Costs of the phases of an update, counted in the machine code."""
    disassembler = nvcc.with_name("nvdisasm")
    listing = subprocess.run(
        [str(disassembler), "--print-line-info-inline", str(binary)], capture_output=True, text=True, check=True
    ).stdout
    return count_costs(read_code(listing, "LearnWorlds", ROOT / "engine" / "cuda" / "learning.h"))


def dearer(found: dict[str, dict[str, float]], kept: dict[str, dict[str, float]]) -> list[str]:
    """Phases of an update that only the code or only the table has, or whose costs differ."""
    out = [f"{name}: it is in one of code and table alone" for name in sorted(found.keys() ^ kept.keys())]
    for name in sorted(found.keys() & kept.keys()):
        now, then = found[name]["clocks"], kept[name]["clocks"]
        if abs(now - then) > COST_SLACK * then:
            out.append(
                f"{name}: {now:.0f} clocks, and the table has {then:.0f}: call `python tests/cuda.py --write` if "
                "that is right"
            )
    return out


def included(source: Path) -> set[Path]:
    """A source of the engine and all of the engine's files that it includes, directly or not."""
    found, unread = {source}, [source]
    while unread:
        names = re.findall(r'^ *# *include "(.+)"', unread.pop().read_text(), re.MULTILINE)
        new = {build.ENGINE / name for name in names} - found
        found |= new
        unread += new
    return found


def options_of(variant: str) -> list[str]:
    """The compiler's options for a variant, besides `build.OPTIONS`."""
    return ["-cubin", "-lineinfo", "-Xptxas=-v", "-Werror=all-warnings", build.variant_option(variant)]


def inputs(nvcc: Path, variant: str) -> str:
    """A digest of all that the machine code of a variant depends on."""
    version = subprocess.run([str(nvcc), "--version"], capture_output=True, text=True, check=True).stdout
    digest = hashlib.sha256(repr((build.OPTIONS, options_of(variant), version)).encode())
    for path in sorted(included(SOURCE)):
        digest.update(repr((path.relative_to(ROOT).as_posix(), path.read_bytes())).encode())
    return digest.hexdigest()


def digests(nvcc: Path) -> str:
    """The content of `DIGESTS` as it should be: a line for the inputs, and one for each table of the library."""
    scripts = [Path(__file__), Path(count_costs.__code__.co_filename)]
    kernels = inputs(nvcc, build.variants()[0]).encode()
    contents = {"inputs": kernels + b"".join(path.read_bytes() for path in scripts)}
    contents |= {path.name: path.read_bytes() for path in (TABLE, COSTS)}
    return "".join(f"{hashlib.sha256(content).hexdigest()}  {name}\n" for name, content in contents.items())


def compile_kernels(nvcc: Path, variant: str) -> Path:
    """A folder with the machine code of all kernels, `device.cubin`, and the compiler's output, `report.txt`.

    Raises:
        build.BuildError: The compiler fails or gives a warning.
    """
    kept = BUILT / variant / inputs(nvcc, variant)[:16]
    binary, report = kept / "device.cubin", kept / "report.txt"
    if not report.exists():
        shutil.rmtree(BUILT / variant, ignore_errors=True)
        kept.mkdir(parents=True)
        call = build.command(nvcc, *options_of(variant), "-o", str(binary), str(SOURCE))
        done = subprocess.run(call, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise build.BuildError(done.stderr)
        report.write_text(done.stderr)  # written last: marks the folder as complete
    return kept


def check_default(nvcc: Path, write: bool) -> list[str]:
    """Compiles the library's kernels, unless nothing has changed since their tables were written, and returns how they
    differ from the tables, after updating these if asked to.
    """
    if not write and DIGESTS.read_text() == digests(nvcc):
        print("cuda: the tables were written from these sources by this compiler")
        return []
    default = build.variants()[0]
    folder = compile_kernels(nvcc, default)
    found = read_kernels((folder / "report.txt").read_text(), launch_sizes(default, folder))
    costs = costs_of(nvcc, folder / "device.cubin")
    if write:
        TABLE.write_text(json.dumps(found, indent=2) + "\n")
        COSTS.write_text(json.dumps(costs, indent=2) + "\n")
        DIGESTS.write_text(digests(nvcc))
    clocks = sum(cost["clocks"] for cost in costs.values())
    size = (folder / "device.cubin").stat().st_size / 1e6
    print(f"cuda: {len(found)} kernels for sm_90, {size:.1f} MB; {clocks:,.0f} clocks for 64 samples of an update")
    return problems(found, json.loads(TABLE.read_text())) + dearer(costs, json.loads(COSTS.read_text()))


def check_variants(nvcc: Path, write: bool) -> list[str]:
    """The same for every variant of the kernels."""
    found = {}
    for variant in build.variants():
        folder = compile_kernels(nvcc, build.same_kernels(variant))
        kernels = read_kernels((folder / "report.txt").read_text(), launch_sizes(variant, folder))
        found[variant] = {name: kernels[name] for name in ("StepWorlds", "LearnWorlds", "CloseWindows")}
        for name, kernel in found[variant].items():
            print(f"cuda: {variant}, {name}: " + ", ".join(f"{number} {what}" for what, number in kernel.items()))
    if write:
        VARIANTS.write_text(json.dumps(found, indent=2) + "\n")
    kept = json.loads(VARIANTS.read_text())
    wrong = [f"{name}: it is only in the source or only in the table" for name in sorted(found.keys() ^ kept.keys())]
    for variant in sorted(found.keys() & kept.keys()):
        wrong += [f"{variant}: {line}" for line in problems(found[variant], kept[variant])]
    return wrong


def main() -> int:
    nvcc = build.find_nvcc()
    if nvcc is None:
        print("cuda: no nvcc in this environment, nothing compiled: uv sync --group cuda")
        return 0
    check = check_variants if "--variants" in sys.argv else check_default
    try:
        wrong = check(nvcc, "--write" in sys.argv)
    except build.BuildError as error:
        print(error, file=sys.stderr)
        return 1
    for line in wrong:
        print(f"cuda: {line}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
