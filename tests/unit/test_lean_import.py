"""An in-memory world imports numpy and what numpy itself imports, and nothing else."""

import json
import subprocess
import sys

PROGRAM = """
import json, sys
before = set(sys.modules)
import hedon
alone = sorted({name.partition(".")[0] for name in set(sys.modules) - before})
config = hedon.load_config("predator", overrides=["world.rollout_steps=64", "learning.minibatch_size=32"])
simulation = hedon.Simulation(config, seeds=[1])
simulation.run(64)
world = simulation.worlds[0]
world.agents(), world.foods(), world.digest(), simulation.engine.restore(0, simulation.engine.save(0))
print(json.dumps([alone, sorted({name.partition(".")[0] for name in set(sys.modules) - before})]))
"""


def test_an_in_memory_world_imports_only_numpy() -> None:
    said = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True).stdout
    alone, all_of_it = (
        {name for name in names if name not in sys.stdlib_module_names and not name.startswith("_")}
        for names in json.loads(said)
    )
    assert alone == {"hedon", "lazy_loader"}
    assert all_of_it == {"hedon", "lazy_loader", "numpy"}


def test_listing_studies_imports_no_heavy_library() -> None:
    heavy = ("matplotlib", "scipy.special._ufuncs", "scipy.sparse._base", "scipy.stats._stats_py")
    program = (
        f"import sys; from hedon.study.catalogue import installed; installed(); print({set(heavy)} & set(sys.modules))"
    )
    said = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert said == "set()\n"
