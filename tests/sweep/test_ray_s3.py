"""A sweep on Ray, stored on an S3 server: a node is killed, and the table is the same as from one machine.

Only the server is shared: the batch of a killed node continues elsewhere from the state that the node sent.
"""

import json
import os
import secrets
import shutil
import signal
import socket
import threading
from collections.abc import Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from tempfile import gettempdir

import pytest
from s3_place import use_server
from sweep_case import assert_kept_whole, assert_same_table, planned, run_sweep, sweep_file, table_of
from test_ray import KILLS, STEPS, parent, two_nodes

from hedon.ensemble.batch import STATE
from hedon.ensemble.store import Store

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(
        any(find_spec(name) is None for name in ("ray", "s3fs", "moto")),
        reason="needs further packages: uv sync --extra ray --extra remote --group store",
    ),
]


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    """The port of an S3 server on this machine."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        found = free.getsockname()[1]
    server = import_module("moto.server").ThreadedMotoServer(ip_address="127.0.0.1", port=found, verbose=False)
    server.start()
    yield found
    server.stop()


@pytest.fixture
def url(port: int, monkeypatch: pytest.MonkeyPatch) -> str:
    """A place on the server, which every process with this environment can find."""
    use_server(port, monkeypatch)
    lab = f"lab-{secrets.token_hex(8)}"
    import_module("s3fs").S3FileSystem(skip_instance_cache=True).mkdir(lab)
    return f"s3://{lab}/sweep"


def made_on(raylet: int) -> dict[Path, int]:
    """The process of each batch that a node makes, by the folder of its run, which is local to that machine."""
    found = {}
    for lock in Path(gettempdir()).glob("hedon-sweep-*/*/.lock"):
        try:
            process = json.loads(lock.read_text())["process"]
        except (OSError, ValueError):  # it has just started or ended
            continue
        if parent(process) == raylet:
            found[lock.parent] = process
    return found


@pytest.mark.parametrize("kill", range(KILLS))
def test_a_node_that_dies_costs_no_result_of_a_sweep_on_s3(kill, url, tmp_path, monkeypatch):
    file = sweep_file(tmp_path, STEPS, worlds=1)
    file.write_text('keep = ["agents", "run"]\n' + file.read_text())
    alone, here = planned(file, str(tmp_path / "alone"))
    assert {outcome.status for outcome in run_sweep(alone, here).values()} == {"finished"}
    plan, store = planned(file, url)
    killed, over = list[str](), threading.Event()
    with two_nodes(monkeypatch) as (cluster, node):
        (raylet,) = (info.process.pid for info in node.all_processes["raylet"])

        def kill_in_the_middle() -> None:
            watched = Store(url)
            while not killed and not over.wait(0.05):
                sent = {name.removesuffix(".zip") for name in watched.names(STATE)}
                for folder, process in made_on(raylet).items():
                    if folder.name in sent:
                        os.kill(process, signal.SIGSTOP)  # everything on a machine stops at once
                        killed.append(folder.name)
                        cluster.remove_node(node, allow_graceful=False)
                        os.kill(process, signal.SIGKILL)
                        shutil.rmtree(folder)  # its disk is lost too
                        break

        killer = threading.Thread(target=kill_in_the_middle, daemon=True)
        killer.start()
        try:
            outcomes = run_sweep(plan, store, 0.0, ray=str(cluster.address))
        finally:
            over.set()
            killer.join()
    assert killed, "the second node should have had a batch whose state was sent"
    assert {name: outcome.status for name, outcome in outcomes.items()} == {
        batch.name: "finished" for batch in plan.batches()
    }
    assert store.names(STATE) == []
    assert_same_table(table_of(url), table_of(here.location))
    assert_kept_whole(store, plan)
