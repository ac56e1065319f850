"""A sweep behind a URL, on a real S3 server of this machine.

The server is s3s-fs: `cargo install s3s-fs --version 0.11.1 --features binary --locked`.
"""

import os
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
from sweep_case import assert_goes_on_elsewhere

from hedon.sweep.store import PASSING, open_store

SERVER = shutil.which("s3s-fs") or shutil.which("s3s-fs", path=str(Path.home() / ".cargo" / "bin"))
KEY = "hedon-test-key"
STEPS = 5_120
WRITER = """
import sys
from hedon.sweep.store import open_store
store = open_store(sys.argv[1])
for i in range(10_000):
    store.write(f"results/{i:05d}", str(i % 10).encode() * 3_000_000)
    print(i, flush=True)
"""
"""Writes contents of 3 MB that are one digit over and over."""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(find_spec("s3fs") is None, reason='needs the optional packages: pip install "hedon[remote]"'),
    pytest.mark.skipif(
        SERVER is None, reason="needs an S3 server: cargo install s3s-fs --version 0.11.1 --features binary --locked"
    ),
]


@pytest.fixture
def bucket(tmp_path, monkeypatch) -> Iterator[str]:
    """The URL of a bucket on a server that runs for one test."""
    assert SERVER is not None
    root = tmp_path / "server"
    (root / "lab").mkdir(parents=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    words = ["--host", "127.0.0.1", "--port", str(port), "--access-key", KEY, "--secret-key", KEY, str(root)]
    server = subprocess.Popen([SERVER, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    for name, value in {
        "AWS_ENDPOINT_URL": f"http://127.0.0.1:{port}",
        "AWS_ACCESS_KEY_ID": KEY,
        "AWS_SECRET_ACCESS_KEY": KEY,
        "AWS_DEFAULT_REGION": "us-east-1",
        "FSSPEC_S3_ENDPOINT_URL": f"http://127.0.0.1:{port}",
    }.items():
        monkeypatch.setenv(name, value)
    try:
        until = time.monotonic() + 30
        while True:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    break
            assert time.monotonic() < until
            time.sleep(0.05)
        yield "s3://lab/sweep"
    finally:
        server.kill()
        server.wait()


def test_a_writer_that_is_killed_leaves_nothing_that_reads_as_whole(bucket):
    """Killed in its second, third and fifth content; whatever has a name then has all of its content."""
    for written in (1, 2, 4):
        writer = subprocess.Popen([sys.executable, "-c", WRITER, bucket], stdout=subprocess.PIPE)
        assert writer.stdout is not None
        for _ in range(written):
            assert writer.stdout.readline()
        time.sleep(0.004 * written)  # within the next content
        os.kill(writer.pid, signal.SIGKILL)
        writer.wait()
        store = open_store(bucket)
        names = store.names("results")
        for name in names:
            assert store.read(f"results/{name}") == str(int(name) % 10).encode() * 3_000_000, name
        assert not [name for name in names if PASSING in name]
        assert len(names) >= written


def test_a_sweep_on_s3_goes_on_elsewhere_and_gives_the_table_of_a_folder(bucket, tmp_path):
    assert_goes_on_elsewhere(bucket, tmp_path, STEPS)
