"""A sweep on a real Ray cluster of two nodes gives the same table as one machine, even if a node is killed.

HEDON_NODES sets how many times a node is killed, each time at another step of its batch.
"""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from sweep_case import assert_same_table, planned, run_sweep, sweep_file, table_of, under_way

from hedon.ensemble.batch import RUNS, batch_job
from hedon.ensemble.cluster import LOCAL, TRIES, import_ray
from hedon.ensemble.plan import load_plan
from hedon.ensemble.store import Store

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(find_spec("ray") is None, reason='needs the optional packages: pip install "hedon[ray]"'),
]
KILLS = int(os.environ.get("HEDON_NODES", "1"))
STEPS = 10_240
"""Steps of each world, which take a few seconds."""
NODE = {"num_cpus": 1}
HEAD = {**NODE, "include_dashboard": False, "include_log_monitor": False, "no_monitor": True}


def file_of(folder: Path) -> Path:
    """Four batches of one world each, whose runs are kept."""
    file = sweep_file(folder, STEPS, worlds=1)
    file.write_text('keep = ["run"]\n' + file.read_text())
    return file


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The table of the sweep, made in this process."""
    folder = tmp_path_factory.mktemp("alone")
    plan, store = planned(file_of(folder), str(folder / "whole"))
    for batch in plan.batches():
        batch_job(store.location, plan, batch, folder / batch.name, 1e9).make(1, None)
    return table_of(store.location)


@contextmanager
def two_nodes(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Any, Any]]:
    """A cluster of two nodes with one processor each, and the second of them."""
    monkeypatch.setenv("RAY_raylet_start_wait_time_s", "300")  # a busy machine needs more than the usual 30 s
    import_ray()
    Cluster: Any = import_module("ray.cluster_utils").Cluster
    cluster = Cluster(initialize_head=True, head_node_args=HEAD)
    try:
        node = cluster.add_node(**NODE)
        cluster.wait_for_nodes()
        yield cluster, node
    finally:
        cluster.shutdown()


def parent(process: int) -> int:
    """The process that started a process; 0 if it has ended."""
    try:
        return int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
    except OSError:
        return 0


@pytest.mark.repeated
@pytest.mark.parametrize("kill", range(KILLS))
def test_a_node_that_dies_costs_no_result(kill, tmp_path, whole, monkeypatch):
    plan, store = planned(file_of(tmp_path), str(tmp_path / "ray"))
    place, killed, over = tmp_path / "ray", dict[str, int](), threading.Event()
    with two_nodes(monkeypatch) as (cluster, node):
        (raylet,) = (info.process.pid for info in node.all_processes["raylet"])

        def kill_in_the_middle() -> None:
            while not killed and not over.wait(0.01):
                for name, (process, step) in under_way(place).items():
                    if step < 1024 * (1 + kill % 6) or parent(process) != raylet:
                        continue
                    os.kill(process, signal.SIGSTOP)  # a machine that loses power stops everything at once
                    step = under_way(place).get(name, (0, STEPS))[1]  # it may just have ended
                    if step < STEPS:
                        killed[name] = step
                        cluster.remove_node(node, allow_graceful=False)
                    os.kill(process, signal.SIGKILL)
                    break

        killer = threading.Thread(target=kill_in_the_middle, daemon=True)
        killer.start()
        try:
            outcomes = run_sweep(plan, store, 0.0, ray=str(cluster.address))
        finally:
            over.set()
            killer.join()
    assert killed, "the second node should have had a batch"
    (name,) = killed
    assert {name: outcome.status for name, outcome in outcomes.items()} == {
        batch.name: "finished" for batch in plan.batches()
    }
    sessions = json.loads((place / RUNS / name / "manifest.json").read_text())["sessions"]
    assert [session["from_step"] >= killed[name] for session in sessions] == [False, True], "it continues where it was"
    assert_same_table(table_of(store.location), whole)


@pytest.mark.long
def test_a_world_that_takes_its_process_down_is_given_up(tmp_path, whole, monkeypatch):
    """As a world does that needs too much memory; the others finish, and it can be tried again."""
    monkeypatch.setenv("RAY_ADDRESS", "127.0.0.1:1")  # a local cluster is always a new one
    plan, store = planned(file_of(tmp_path), str(tmp_path / "ray"))
    doomed, killed, over = next(plan.batches()).name, set[int](), threading.Event()

    def kill_one() -> None:
        while not over.wait(0.005):
            process, _ = under_way(tmp_path / "ray").get(doomed, (0, 0))
            if process and process not in killed:
                killed.add(process)
                with suppress(ProcessLookupError):
                    os.kill(process, signal.SIGKILL)

    killer = threading.Thread(target=kill_one, daemon=True)
    killer.start()
    try:
        outcomes = run_sweep(plan, store, 1e9, 1, ray=LOCAL)
    finally:
        over.set()
        killer.join()
    assert TRIES <= len(killed) <= TRIES + 1, "once more if it left its first checkpoint"
    assert {outcome.status for name, outcome in outcomes.items() if name != doomed} == {"finished"}
    assert outcomes[doomed].status == "failed"
    assert f"lost {TRIES} times in a row" in outcomes[doomed].fault
    worlds = next(plan.batches())
    value = plan.conditions[worlds.condition].settings["energy.basic_cost"]
    assert f"energy.basic_cost = {value}, seed {worlds.seeds[0]}." in outcomes[doomed].fault
    assert {name: outcome.status for name, outcome in run_sweep(plan, store, 1e9, 1).items()} == {doomed: "finished"}
    assert_same_table(table_of(store.location), whole)


@pytest.mark.long
def test_ctrl_c_keeps_what_was_done_on_a_cluster(tmp_path):
    file, place = sweep_file(tmp_path, 4 * STEPS, seeds=1), tmp_path / "ray"
    file.write_text('keep = ["run"]\n' + file.read_text())
    start = "from hedon.cli.start import main; main()"
    words = ["sweep", "run", str(file), "--out", str(place), "--ray", LOCAL, "--workers", "1", "--checkpoint", "0"]
    sweep = subprocess.Popen([sys.executable, "-c", start, *words], stdout=subprocess.PIPE, text=True)
    try:
        while not any(step > 0 for _, step in under_way(place).values()):
            assert sweep.poll() is None
            time.sleep(0.01)
        sweep.send_signal(signal.SIGINT)
        said, _ = sweep.communicate(timeout=300)
    finally:
        sweep.kill()
    assert sweep.returncode == 0
    assert "Interrupted: 2 of 2 runs are not finished; all results so far are kept." in said
    plan, store = load_plan(Store(str(place))), Store(str(place))
    run_sweep(plan, store, 1e9, 2)
    sessions = [json.loads(path.read_text())["sessions"] for path in (place / RUNS).glob("*/manifest.json")]
    (_, second), (_,) = sorted(sessions, key=len, reverse=True)
    assert second["from_step"] > 0, "one was under way"
    alone, other = planned(file, str(tmp_path / "alone"))
    run_sweep(alone, other, 1e9, 2)
    assert_same_table(table_of(str(place)), table_of(other.location))
