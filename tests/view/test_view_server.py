"""The local server gives the page and the run's tables to anyone with the link, and nothing else to anyone."""

import gzip
import http.client
import os
import re
import socket
import struct
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from command import hedon
from typer.testing import CliRunner
from view_page import record, run_server, serving

from hedon import branch
from hedon.cli.main import app
from hedon.config.load import load_config
from hedon.record.error import RecordError
from hedon.record.reader import open_run
from hedon.view import compressed
from hedon.view.export import export
from hedon.view.index import RunIndex
from hedon.view.live import live_world
from hedon.view.moment import fragment
from hedon.view.page import ViewError, page_files
from hedon.view.server import Server
from hedon.view.token import kept_token, token_path


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return record(tmp_path_factory.mktemp("served") / "run", 128)


@pytest.fixture
def server(folder):
    with serving(run_server(folder)) as running:
        yield running


def ask(server, path, method="GET", host=None, encoding="identity"):
    connection = http.client.HTTPConnection("127.0.0.1", server.server_port, timeout=10)
    headers = {"Host": host or f"127.0.0.1:{server.server_port}", "Accept-Encoding": encoding}
    connection.request(method, path, headers=headers)
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


def test_only_the_curves_of_further_runs_are_served(folder, tmp_path):
    other = record(tmp_path / "run", 64)
    index = RunIndex(folder, [other])
    assert [(each["run"], each["seeds"]) for each in index.describe()["others"]] == [(str(other), [1])]
    names = {name for name in index.files() if name.startswith("others/")}
    assert names == {f"others/0/{path.name}" for path in (other / "population").iterdir()}
    with pytest.raises(ViewError, match="given 2 times"):
        RunIndex(folder, [other, other])
    with pytest.raises(ViewError, match="5 runs: the page tells at most 4 apart"):
        RunIndex(folder, [other] * 4)
    with pytest.raises(RecordError, match="nowhere"):
        RunIndex(folder, [tmp_path / "nowhere"])


def test_another_host_name_is_refused(server):
    assert ask(server, f"/{server.token}/", host="evil.example")[0].status == 403


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS"])
def test_nothing_can_be_written(server, method):
    assert ask(server, f"/{server.token}/data/run.json", method=method)[0].status == 501


def test_a_head_request_gets_the_headers_without_the_content(server):
    whole, head = (ask(server, f"/{server.token}/index.html", method=method) for method in ("GET", "HEAD"))
    assert (head[0].status, head[1]) == (200, b"")
    assert head[0].getheader("Content-Length") == whole[0].getheader("Content-Length") == str(len(whole[1]))


def test_it_listens_only_on_this_machine_and_forbids_what_a_page_does_not_need(server):
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
    """It hangs up with a reset: at once, in the middle of its request, and in the middle of a large answer."""
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
    """A browser cannot compute it, and the page would reveal the path of the rule's file."""
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


def test_the_command_needs_a_run_or_a_live_world():
    assert "--live" in str(CliRunner().invoke(app, ["view"]).exception)


def test_a_branch_has_no_moments_before_its_start(folder, tmp_path):
    steps = open_run(folder).manifest.steps_done[0]
    branch(folder, tmp_path / "branch", steps=steps + 64)
    run = open_run(tmp_path / "branch")
    assert fragment(run, steps, None, None) == f"#world=0&step={steps}"
    with pytest.raises(ViewError, match=f"--step 0: the world of seed 1 starts at step {steps}"):
        fragment(run, 0, None, None)


def test_the_link_leads_to_a_moment(folder):
    run = open_run(folder)
    assert fragment(run, None, None, None) == ""
    assert fragment(run, 64, None, 3) == "#world=0&step=64&agent=3"
    with pytest.raises(ViewError, match=r"--step 129: the world of seed 1 ends at step 128"):
        fragment(run, 129, None, None)
    with pytest.raises(ViewError, match="--seed 2: the run has the seeds 1"):
        fragment(run, None, 2, None)
    several = replace(run, manifest=replace(run.manifest, seeds=(1, 5), steps_done=(128, 64)))
    assert fragment(several, 64, 5, None) == "#world=1&step=64"
    done = CliRunner().invoke(app, ["view", "--live", "--step", "3"])
    assert "--step, --seed and --agent" in str(done.exception)


def test_an_invalid_address_is_answered(server):
    with socket.create_connection(("127.0.0.1", server.server_port)) as connection:
        connection.sendall(f"GET http://[bad/ HTTP/1.0\r\nHost: 127.0.0.1:{server.server_port}\r\n\r\n".encode())
        assert b" 400 " in connection.recv(100)


START = (sys.executable, "-c", "from hedon.cli.start import main; main()")


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_a_chosen_port_has_the_same_address_after_a_restart(cache):
    """With the command itself, in separate processes."""
    port, links = free_port(), []
    for _ in range(2):
        command = [*START, "view", "--live", "small", "--port", str(port), "--no-open"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as running:
            assert running.stdout is not None
            links.append(running.stdout.readline().split()[-1])
            connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
            connection.request("GET", links[0].split(str(port))[1])
            assert connection.getresponse().status == 200
            connection.close()
            running.terminate()
    assert links[0] == links[1]
    assert links[0].startswith(f"http://127.0.0.1:{port}/")


def test_any_free_port_has_a_new_token_and_keeps_none(cache):
    tokens = set()
    for _ in range(2):
        server = Server({}, dict)
        server.server_close()
        tokens.add(server.token)
    assert len(tokens) == 2
    assert not cache.exists()


def test_without_the_kept_token_there_is_nothing_either(cache):
    with serving(Server({}, dict, free_port())) as server:
        assert server.token == kept_token()
        assert ask(server, f"/{server.token}/")[0].status == 200
        for path in ("/", "/index.html", f"/{server.token[:-1]}/", f"/{server.token.swapcase()}/"):
            assert ask(server, path)[0].status == 404


MODES = pytest.mark.skipif(os.name == "nt", reason="files have no mode bits, and the user's folder protects them")


@MODES
def test_only_its_owner_can_read_the_token(cache):
    before = os.umask(0)
    try:
        token = kept_token()
    finally:
        os.umask(before)
    assert token_path() == cache / "hedon" / "view-token"
    assert token_path().stat().st_mode & 0o777 == 0o600
    assert token_path().parent.stat().st_mode & 0o777 == 0o700
    assert re.fullmatch(r"[A-Za-z0-9_-]{32}", token)
    assert [path.name for path in token_path().parent.iterdir()] == ["view-token"]
    assert kept_token() == token


@pytest.mark.parametrize(
    "spoil", ["short", "folder", *(pytest.param(spoil, marks=MODES) for spoil in ("readable", "written", "link"))]
)
def test_a_token_that_others_may_know_is_replaced(spoil, cache):
    token, path = kept_token(), token_path()
    if spoil == "readable":
        path.chmod(0o640)
    elif spoil == "written":
        path.chmod(0o602)
    elif spoil == "short":
        path.write_text("a")
    else:
        path.unlink()
        if spoil == "link":
            other = cache / "other"
            other.write_text(token)
            other.chmod(0o600)
            path.symlink_to(other)
        else:
            path.mkdir()
    fresh = kept_token()
    assert fresh != token
    assert len(fresh) == 32
    if spoil != "folder":  # a folder is left as it is, so each start has a new token
        assert kept_token() == fresh
        assert not path.is_symlink()
        assert os.name == "nt" or path.stat().st_mode & 0o777 == 0o600


def test_without_a_cache_folder_each_token_is_new(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert kept_token() != kept_token()


def test_a_browser_that_takes_gzip_gets_each_file_compressed(server):
    for name in ("", "assets/index.js", "assets/index.css", "hedon.wasm", "data/run.json", "story.html"):
        plain, content = ask(server, f"/{server.token}/{name}")
        packed, body = ask(server, f"/{server.token}/{name}", encoding="gzip, deflate, br, zstd")
        assert (plain.getheader("Content-Encoding"), packed.getheader("Content-Encoding")) == (None, "gzip")
        assert gzip.decompress(body) == content
        assert len(body) < 0.7 * len(content)
        assert packed.getheader("Content-Length") == str(len(body))
        assert packed.getheader("Content-Type") == plain.getheader("Content-Type")
        assert plain.getheader("Vary") == packed.getheader("Vary") == "Accept-Encoding"
        head, nothing = ask(server, f"/{server.token}/{name}", method="HEAD", encoding="gzip")
        assert (head.getheader("Content-Length"), nothing) == (str(len(body)), b"")


@pytest.mark.parametrize("name", ["data/run/frames/part-000000.parquet", "hero.gz", "hero.jpg"])
def test_files_that_are_already_compressed_are_sent_as_they_are(server, name):
    answer, body = ask(server, f"/{server.token}/{name}", encoding="gzip")
    assert (answer.status, answer.getheader("Content-Encoding")) == (200, None)
    assert body == ask(server, f"/{server.token}/{name}")[1]


@pytest.mark.parametrize(
    ("accepted", "takes"),
    [
        ("gzip", True),
        ("br, GZIP;q=0.5", True),
        ("*", True),
        ("", False),
        ("identity", False),
        ("gzip;q=0", False),
        ("gzip; q=0.0, *", False),
        ("*;q=0, gzip", True),
        ("xgzip", False),
    ],
)
def test_a_browser_says_whether_it_takes_gzip(accepted, takes):
    assert compressed.takes_gzip(accepted) is takes


def test_each_file_is_compressed_once(server, monkeypatch):
    calls = []
    pack = gzip.compress
    monkeypatch.setattr(gzip, "compress", lambda *given, **how: calls.append(1) or pack(*given, **how))
    bodies = {ask(server, f"/{server.token}/assets/index.js", encoding="gzip")[1] for _ in range(3)}
    assert (len(calls), len(bodies)) == (1, 1)
    path = Path(page_files()["assets/index.js"])
    assert gzip.decompress(bodies.pop()) == path.read_bytes()


def test_data_that_changes_is_compressed_again():
    numbers = iter(([1] * 500, [2] * 500, [2] * 500))
    with serving(Server({"page": lambda: next(numbers)}, dict)) as server:
        bodies = [ask(server, f"/{server.token}/data/page.json", encoding="gzip")[1] for _ in range(3)]
    assert [gzip.decompress(body)[:3] for body in bodies] == [b"[1,", b"[2,", b"[2,"]
