"""A sweep at a URL, on a real S3 server on this machine.

The server is s3s-fs: `cargo install s3s-fs --version 0.11.1 --features binary --locked`.
"""

import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from s3_place import KEY, use_server
from sweep_case import (
    assert_goes_on_elsewhere,
    assert_kept_whole,
    assert_same_table,
    assert_two_make_one,
    planned,
    sweep_file,
    table_of,
)

from hedon.ensemble.batch import batch_job
from hedon.ensemble.store import PASSING, Store

SERVER = shutil.which("s3s-fs") or shutil.which("s3s-fs", path=str(Path.home() / ".cargo" / "bin"))
STEPS = 5_120
SMALL, LARGE = 3_000_000, 105_000_000
"""Sizes of contents that are sent in one request and in parts [byte]."""
DYING = """
import os, signal, socket, sys
import s3fs

place, sent = sys.argv[1], 0
call, send = s3fs.S3FileSystem._call_s3, socket.socket.send

def die(here):
    if here == place:
        os.kill(os.getpid(), signal.SIGKILL)

async def called(self, method, *words, **named):
    die(f"before {method}")
    answer = await call(self, method, *words, **named)
    die(f"after {method}")
    return answer

def send_some(self, data, *flags):
    global sent
    count = send(self, memoryview(data)[:65536], *flags)
    sent += count
    if sent > int(sys.argv[2]):
        die("within a content")
    return count

s3fs.S3FileSystem._call_s3 = called
socket.socket.send = send_some
socket.socket.sendmsg = lambda self, parts, *rest: send_some(self, next(filter(len, parts), b""))
"""
"""Ends this process by SIGKILL at a given point of its exchange with the server."""
WRITER = """
from hedon.ensemble.store import Store

Store(sys.argv[3]).write("results/one", b"new" * (int(sys.argv[2]) * 2 // 3))
"""
MAKER = """
from pathlib import Path
from hedon.ensemble.plan import load_plan
from hedon.ensemble.store import Store
from hedon.ensemble.batch import batch_job

url, folder = sys.argv[3:]
write = Store.write

def told_write(self, name, content):
    die(f"before {name.partition('/')[0]}")
    write(self, name, content)
    die(f"after {name.partition('/')[0]}")

Store.write = told_write
plan = load_plan(Store(url))
batch_job(url, plan, next(plan.batches()), Path(folder), 0.0).make(1, None)
"""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(find_spec("s3fs") is None, reason='needs the optional packages: pip install "hedon[remote]"'),
    pytest.mark.skipif(
        SERVER is None, reason="needs an S3 server: cargo install s3s-fs --version 0.11.1 --features binary --locked"
    ),
]


@pytest.fixture(scope="module")
def server(tmp_path_factory) -> Iterator[Path]:
    """The folder of a server with a bucket "lab", which every process with this environment can find."""
    assert SERVER is not None
    root = tmp_path_factory.mktemp("server")
    (root / "lab").mkdir()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = ["--host", "127.0.0.1", "--port", str(port), "--access-key", KEY, "--secret-key", KEY, str(root)]
    process = subprocess.Popen([SERVER, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    with pytest.MonkeyPatch.context() as monkeypatch:
        use_server(port, monkeypatch)
        try:
            until = time.monotonic() + 30
            while True:
                with socket.socket() as probe:
                    if probe.connect_ex(("127.0.0.1", port)) == 0:
                        break
                assert time.monotonic() < until
                time.sleep(0.05)
            yield root
        finally:
            process.kill()
            process.wait()


@pytest.fixture
def bucket(server, tmp_path) -> str:
    """The URL of a place on the server, different for each test."""
    return f"s3://lab/{tmp_path.name}"


def run_dying(program: str, *words: str | Path) -> None:
    """Runs a program that ends itself by SIGKILL at its given point."""
    done = subprocess.run([sys.executable, "-c", DYING + program, *map(str, words)], timeout=300)
    assert done.returncode == -signal.SIGKILL, "it should have reached the point where it is killed"


@pytest.mark.parametrize(
    ("place", "size", "named", "left"),
    [
        ("within a content", SMALL, False, 0),
        ("after put_object", SMALL, False, 1),
        ("after copy_object", SMALL, True, 1),
        ("within a content", LARGE, False, 0),
        ("after upload_part", LARGE, False, 0),
        ("before complete_multipart_upload", LARGE, False, 0),
        ("after complete_multipart_upload", LARGE, False, 1),
    ],
)
def test_a_killed_writer_leaves_nothing_that_reads_as_complete(server, bucket, place, size, named, left):
    """At each point of its exchange with the server, a name has either the whole old or the whole new content."""
    store = Store(bucket)
    store.write("results/one", b"old")
    run_dying(WRITER, place, str(size // 2), bucket)
    content = b"new" * (size // 2 * 2 // 3)
    assert store.read("results/one") == (content if named else b"old")
    assert store.names("results") == ["one"]
    passing = list((server / bucket.removeprefix("s3://")).rglob(f"{PASSING}*-one"))
    assert len(passing) == left, "it should have been killed at another point"


@pytest.mark.parametrize(
    ("place", "kept"),
    [
        ("before state", (0, 0, 0)),
        ("after state", (1, 0, 0)),
        ("before tables", (1, 0, 0)),
        ("before runs", (1, 1, 0)),
        ("before results", (1, 1, 0)),
        ("after results", (1, 1, 1)),
    ],
)
def test_a_batch_killed_at_any_point_is_made_by_another_process(bucket, tmp_path, place, kept):
    file = sweep_file(tmp_path, STEPS, seeds=1)
    file.write_text('keep = ["agents", "run"]\n' + file.read_text())
    plan, store = planned(file, str(tmp_path / "folder"))
    for batch in plan.batches():
        batch_job(store.location, plan, batch, tmp_path / batch.name, 1e9).make(1, None)
    remote, far = planned(file, bucket)
    first, second = remote.batches()
    batch_job(bucket, remote, second, tmp_path / "second", 1e9).make(1, None)
    run_dying(MAKER, place, "0", bucket, tmp_path / "one machine")
    tables = [name for name in far.names("tables/agents") if first.name in name]
    assert (len(far.names("state")), len(tables), len(far.names("results")) - 1) == kept
    assert batch_job(bucket, remote, first, tmp_path / "another", 1e9).make(1, None) == "finished"
    assert_same_table(table_of(bucket), table_of(store.location))
    assert_kept_whole(far, remote)


def test_two_processes_that_make_one_sweep_harm_no_row(bucket, tmp_path):
    assert_two_make_one(bucket, tmp_path)


def test_a_sweep_on_s3_continues_elsewhere_and_gives_the_same_table_as_in_a_folder(bucket, tmp_path):
    assert_goes_on_elsewhere(bucket, tmp_path, STEPS)
