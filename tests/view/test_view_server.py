"""The local server gives the page and the run's tables to who has the link, and nothing else to anyone."""

import http.client
import socket
import struct
import time

import pytest
from command import hedon
from typer.testing import CliRunner
from view_page import record, run_server, serving

from hedon.cli.main import app
from hedon.config.load import load_config
from hedon.record.error import RecordError
from hedon.view.export import export
from hedon.view.index import RunIndex
from hedon.view.live import live_world
from hedon.view.page import ViewError


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return record(tmp_path_factory.mktemp("served") / "run", 128)


@pytest.fixture
def server(folder):
    with serving(run_server(folder)) as running:
        yield running


def ask(server, path, method="GET", host=None):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    connection.request(method, path, headers={"Host": host or f"127.0.0.1:{server.server_port}"})
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer, body


def test_the_link_gives_page_data_and_records(server, folder):
    for name, start in (("", b"<!doctype html>"), ("data/run.json", b"{"), ("hedon.wasm", b"\0asm")):
        answer, body = ask(server, f"/{server.token}/{name}")
        assert (answer.status, body[: len(start)]) == (200, start)
    answer, body = ask(server, f"/{server.token}/data/run/frames/part-000000.parquet")
    assert body == (folder / "frames" / "part-000000.parquet").read_bytes()


def test_without_the_token_there_is_nothing(server):
    for path in ("/", "/index.html", "/data/run.json", f"/{server.token[:-1]}/", f"/{server.token}", "//"):
        assert ask(server, path)[0].status == 404


@pytest.mark.parametrize(
    "name",
    [
        "data/run/manifest.json",
        "data/run/config.toml",
        "data/run/../manifest.json",
        "data/run/frames/../config.toml",
        "data/run/%2e%2e/manifest.json",
        "data/run//etc/passwd",
        "../../../../etc/passwd",
        "data/run/frames/part-999999.parquet",
        "data/other.json",
    ],
)
def test_only_the_tables_of_the_run_are_served(server, name):
    assert ask(server, f"/{server.token}/{name}")[0].status == 404


def test_another_host_name_is_refused(server):
    assert ask(server, f"/{server.token}/", host="evil.example")[0].status == 403


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
def test_nothing_can_be_written(server, method):
    assert ask(server, f"/{server.token}/data/run.json", method=method)[0].status == 501


def test_a_head_is_that_of_the_answer_without_its_content(server):
    whole, head = (ask(server, f"/{server.token}/index.html", method=method) for method in ("GET", "HEAD"))
    assert (head[0].status, head[1]) == (200, b"")
    assert head[0].getheader("Content-Length") == whole[0].getheader("Content-Length") == str(len(whole[1]))


def test_it_listens_on_this_machine_alone_and_forbids_what_a_page_does_not_need(server):
    assert server.server_address[0] == "127.0.0.1"
    policy = ask(server, f"/{server.token}/")[0].headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self' 'wasm-unsafe-eval';" in policy
    assert "unsafe-inline" not in policy


def test_a_run_with_a_link_inside_is_refused(server, folder, tmp_path):
    trap = folder / "frames" / "part-000009.parquet"
    (tmp_path / "secret").write_text("secret")
    trap.symlink_to(tmp_path / "secret")
    try:
        answer, body = ask(server, f"/{server.token}/data/run/frames/part-000009.parquet")
        assert answer.status == 409
        assert b"symbolic link" in body
        with pytest.raises(RecordError, match="symbolic link"):
            RunIndex(folder)
    finally:
        trap.unlink()


def test_a_page_that_hangs_up_leaves_the_server_quiet(server, capfd):
    """At once, in the midst of its request, and in the midst of a large answer, with a reset."""
    for request in (
        b"",
        b"GET /",
        f"GET /{server.token}/hedon.wasm HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n".encode(),
    ):
        for _ in range(3):
            caller = socket.create_connection(("127.0.0.1", server.server_port))
            caller.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
            caller.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # closing resets
            caller.sendall(request)
            time.sleep(0.05)
            caller.close()
    time.sleep(0.3)
    assert ask(server, f"/{server.token}/")[0].status == 200
    assert capfd.readouterr().err == ""


def test_a_site_is_not_written_over_something_else(tmp_path):
    (tmp_path / "mine").write_text("mine")
    with pytest.raises(ViewError, match="is not empty"):
        export(tmp_path, {}, {})


def test_the_command_exports_a_live_page(tmp_path):
    done = CliRunner().invoke(app, ["view", "--live", "small", "--export", str(tmp_path / "site")])
    assert done.exit_code == 0
    assert (tmp_path / "site" / "hedon.wasm").is_file()
    assert (tmp_path / "site" / "data" / "page.json").is_file()


def test_a_live_world_with_a_rule_in_python_is_refused(tmp_path):
    """A browser cannot compute it, and the page would tell where the file of the rule is."""
    (tmp_path / "ruled.toml").write_text('preset = "small"\n[reward]\nrule = "kin.py:kind"\n')
    (tmp_path / "kin.py").write_text("def kind(agent):\n    return agent.linear\n")
    done = hedon("view", "--live", "ruled.toml", "--export", "site", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith(
        "hedon: ruled.toml: has the rule kin.py:kind in Python, which a browser cannot compute"
    )
    assert not (tmp_path / "site").exists()
    with pytest.raises(ViewError, match="in Python"):
        live_world(load_config(tmp_path / "ruled.toml"), "ruled.toml")


def test_the_command_wants_a_run_or_a_live_world():
    assert "--live" in str(CliRunner().invoke(app, ["view"]).exception)


def test_an_address_that_is_none_is_answered(server):
    with socket.create_connection(("127.0.0.1", server.server_port)) as connection:
        connection.sendall(f"GET http://[bad/ HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n".encode())
        assert b" 400 " in connection.recv(100)
