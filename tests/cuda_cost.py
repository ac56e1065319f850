"""The cost of an update on one multiprocessor, counted in its machine code; `python tests/cuda.py` keeps it in a table.

`nvdisasm` gives the chain of source lines behind each instruction, which assigns it to one phase of a block of 64
samples. Each phase is represented by one inner loop: the one with the most multiply-adds or, in the first layer, the
loop over rays, which reads their types. In this loop we count the instructions and the bytes of shared memory per
multiply-add. Both sides of a branch count, and so do each lane's bytes even if lanes read the same ones, so for these
loops the clocks are overestimated rather than underestimated. The number of multiply-adds in a phase follows from the
sizes of the network.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path

SAMPLES = HIDDEN = 64
RAYS, DENSE = 24, 6
"""Nonzero entries of an observation in the baseline; for each, one row of the first layer is read."""
LANES = 32
ISSUED_PER_CLOCK = 4
SHARED_BYTES_PER_CLOCK = 128
"""Rates of a multiprocessor of compute capability 9.0. Source: CUDA C++ Programming Guide, arithmetic instructions."""
MULTIPLY_ADDS = {
    "first_layer": SAMPLES * HIDDEN * (RAYS + DENSE),
    "second_layer": SAMPLES * HIDDEN * HIDDEN,
    "square_gradient": SAMPLES * HIDDEN * HIDDEN,
    "hidden_backward": SAMPLES * HIDDEN * HIDDEN,
    "first_layer_backward": SAMPLES * HIDDEN * (RAYS + DENSE),
}
"""Multiply-adds per block of 64 samples, by phase: functions in `engine/cuda/forward.h` and `backward.h`."""
READS_TYPES = ("first_layer", "first_layer_backward")
TYPE_READ = "LDG.E.U8"
LINE = re.compile(r'"([^"]+)", line (\d+)')
INSTRUCTION = re.compile(r"^\s*/\*([0-9a-f]+)\*/\s+(?:@!?U?P\d+ )?\s*([A-Z0-9_.]+)([^;]*);")
WIDTH = re.compile(r"\.(32|64|128)\b")


@dataclass
class Code:
    """One kernel: its instructions, in order.

    Attributes:
        name: Operation of each instruction, with its modifiers.
        phase: Phase of each instruction; empty outside all phases.
        loops: First and last instruction of each loop.
    """

    name: list[str] = field(default_factory=list)
    phase: list[str] = field(default_factory=list)
    loops: list[tuple[int, int]] = field(default_factory=list)


def phase_lines(source: Path) -> dict[int, str]:
    """The phase that each line of `learning.h` calls."""
    found = ((i, re.search(r"\b(\w+)_by_block\(", line)) for i, line in enumerate(source.read_text().splitlines(), 1))
    return {i: match[1] for i, match in found if match and match[1] in MULTIPLY_ADDS}


def read_code(listing: str, kernel: str, source: Path) -> Code:
    """Extracts a kernel from the output of `nvdisasm --print-line-info-inline`."""
    start = re.search(rf"^\.text\.\w*{kernel}EEEvT_:$", listing, re.MULTILINE)
    if start is None:
        raise ValueError(f"no kernel {kernel} in the listing")
    code, phases, labels, branches = Code(), phase_lines(source), {}, []
    chain: list[str] = []
    fresh = True
    for line in listing[start.end() :].splitlines()[1:]:
        if line.startswith("\t.section") or line.startswith("//-----"):
            break
        if line.startswith("\t//## File"):
            chain = [*([] if fresh else chain), line]
            fresh = False
        elif line.startswith(".L_x_"):
            labels[line.rstrip(":")] = len(code.name)
        elif found := INSTRUCTION.match(line):
            fresh = True
            if jump := re.search(r"`\((\.L_x_\d+)\)", found[3]):
                branches.append((len(code.name), jump[1]))
            places = [place for each in chain for place in LINE.findall(each)]
            inside = [phases.get(int(number), "") for file, number in places if file.endswith("/learning.h")]
            code.name.append(found[2])
            code.phase.append(next(filter(None, inside), ""))
    code.loops = [(labels[to], at) for at, to in branches if labels.get(to, at + 1) <= at]
    return code


def shared_bytes(name: str) -> int:
    """Bytes of shared memory that an instruction reads or writes for each lane."""
    if not name.startswith(("LDS", "STS")):
        return 0
    width = WIDTH.search(name)
    return int(width[1]) // 8 if width else 4


def count_costs(code: Code) -> dict[str, dict[str, float]]:
    """For each phase, instructions and bytes of shared memory per multiply-add in its inner loop, and the clocks that a
    multiprocessor needs for a block of samples without stalls."""
    costs = {}
    for phase, multiply_adds in MULTIPLY_ADDS.items():
        body = inner_loop(code, phase)
        instructions = len(body) / _multiply_adds(body)
        bytes_read = sum(map(shared_bytes, body)) / _multiply_adds(body)
        issue = multiply_adds / LANES * instructions / ISSUED_PER_CLOCK
        shared = multiply_adds * bytes_read / SHARED_BYTES_PER_CLOCK
        costs[phase] = {
            "instructions": round(instructions, 2),
            "shared_bytes": round(bytes_read, 2),
            "clocks": round(max(issue, shared)),
        }
    return costs


def inner_loop(code: Code, phase: str) -> list[str]:
    """The operations in the loop that dominates the time of a phase.

    Raises:
        ValueError: The phase has no such loop.
    """
    places = [i for i, each in enumerate(code.phase) if each == phase]
    inside = [loop for loop in code.loops if places and places[0] <= loop[0] and loop[1] <= places[-1] + 1]
    found = []
    for first, last in inside:
        body = code.name[first : last + 1]
        nested = any(first <= a and b <= last and (a, b) != (first, last) for a, b in inside)
        reads = any(name.startswith(TYPE_READ) for name in body)
        if _multiply_adds(body) and not nested and reads == (phase in READS_TYPES):
            found.append(body)
    if not found:
        raise ValueError(f"no inner loop with multiply-adds in the code of {phase}")
    return max(found, key=lambda body: (_multiply_adds(body), -len(body)))


def _multiply_adds(names: list[str]) -> int:
    return sum(name.startswith("FFMA") for name in names)
