"""A sweep on a real Ray cluster of two nodes gives the table of one machine, also where a node is killed.

HEDON_NODES sets how many times a node is killed.
"""

import os
import threading
import time
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from sweep_case import assert_same_table, planned, sweep_file, table_of

from hedon.sweep.cluster import run_on_ray
from hedon.sweep.conduct import Silent
from hedon.sweep.work import RESULTS, WORK, Task, make_batch

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(find_spec("ray") is None, reason='needs the optional packages: pip install "hedon[ray]"'),
]
KILLS = int(os.environ.get("HEDON_NODES", "3"))
STEPS = 20_480
"""Of each world: some seconds."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The table of the sweep, made in this process."""
    folder = tmp_path_factory.mktemp("alone")
    plan, store = planned(sweep_file(folder, STEPS), str(folder / "whole"))
    for batch in plan.batches():
        make_batch(Task(store.location, plan, batch, folder / batch.name, 1e9), 1, None)
    return table_of(store.location)


def begun(place: Path) -> int:
    """How many batches are under way, with a checkpoint after their first."""
    return len({path.parents[1] for path in (place / WORK).glob("*/checkpoints/step-*[1-9]*.npz")})


@pytest.mark.parametrize("kill", range(KILLS))
def test_a_node_that_dies_costs_no_result(kill, tmp_path, whole, monkeypatch):
    monkeypatch.setenv("RAY_raylet_start_wait_time_s", "300")  # a busy machine needs more than the usual 30 s
    Cluster: Any = import_module("ray.cluster_utils").Cluster
    plan, store = planned(sweep_file(tmp_path, STEPS), str(tmp_path / "ray"))
    place = tmp_path / "ray"
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False})
    seen: list[int] = []
    try:
        node = cluster.add_node(num_cpus=1)
        cluster.wait_for_nodes()

        def kill_in_the_middle() -> None:
            deadline = time.monotonic() + 300
            while begun(place) < 2 and time.monotonic() < deadline:
                time.sleep(0.02)
            seen.extend([begun(place), len(list((place / RESULTS).glob("*")))])
            cluster.remove_node(node, allow_graceful=False)

        killer = threading.Thread(target=kill_in_the_middle)
        killer.start()
        outcomes = run_on_ray(plan, store, str(cluster.address), Silent(), 0.0)
        killer.join()
    finally:
        cluster.shutdown()
    assert seen == [2, 0], "a node was to be killed while each had a batch, and none was done"
    assert {name: outcome.status for name, outcome in outcomes.items()} == {
        batch.name: "finished" for batch in plan.batches()
    }
    assert_same_table(table_of(store.location), whole)
