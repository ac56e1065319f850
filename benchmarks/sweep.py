"""How long it takes to plan a large sweep, and how much memory: `python -m benchmarks.sweep [CONDITIONS]`.

It reads the file of a sweep over three factors, checks every condition, and makes the text of its plan.
"""

import sys
import time
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from tempfile import TemporaryDirectory

FILE = """
steps = 102_400
seeds = 4
[factor]
"energy.basic_cost" = {{ log = [1e-4, 1e-2], count = {count} }}
"energy.action_cost" = {{ log = [1e-5, 1e-3], count = 10 }}
"birth.kappa" = {{ range = [0.001, 0.01], count = 10 }}
"""


def main() -> None:
    """Measures, and prints one line."""
    conditions = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    begun = time.process_time()
    from hedon.sweep.read import read_sweep

    with TemporaryDirectory() as folder:
        file = Path(folder) / "large.toml"
        file.write_text(FILE.format(count=conditions // 100), encoding="utf-8")
        plan = read_sweep(file).plan
    size = len(plan.text())
    seconds, memory = time.process_time() - begun, getrusage(RUSAGE_SELF).ru_maxrss / 1000
    print(
        f"{len(plan.conditions):,} conditions: {seconds:.1f} s of a processor, {memory:.0f} MB of memory, "
        f"a plan of {size / 1e6:.1f} MB"
    )


if __name__ == "__main__":
    main()
