"""Where a sweep is stored: contents are complete or absent, and URLs work like folders."""

import sys
from types import SimpleNamespace

import pytest
from sweep_case import assert_goes_on_elsewhere, assert_two_make_one, planned, sweep_file

from hedon.ensemble.batch import STATE, batch_job
from hedon.ensemble.store import PASSING, TRIES, Store
from hedon.error import HedonError


@pytest.fixture(params=["folder", "file", "memory"])
def store(request, tmp_path):
    place = {"folder": str(tmp_path), "file": f"file://{tmp_path}", "memory": f"memory://{tmp_path}"}
    return Store(place[request.param] + "/sweep")


def test_contents_are_kept_by_name(store):
    assert store.read("a/b") is None
    assert store.names("a") == []
    store.write("a/b", b"one")
    store.write("a/c", b"")
    store.write("a/b", b"two")
    assert store.read("a/b") == b"two"
    assert store.read("a/c") == b""
    assert store.names("a") == ["b", "c"]
    store.remove("a/b")
    store.remove("a/b")
    assert store.names("a") == ["c"]


def test_a_content_that_is_being_written_has_no_name(tmp_path, monkeypatch):
    """A writer that dies between writing and naming leaves only what no reader sees."""
    store = Store(f"file://{tmp_path}")
    store.write("a/b", b"old")

    def die(*_arguments: object, **_options: object) -> None:
        raise KeyboardInterrupt

    assert isinstance(store, Store)
    monkeypatch.setattr(type(store._system), "mv", die)
    with pytest.raises(KeyboardInterrupt):
        store.write("a/b", b"new")
    assert [path.name for path in (tmp_path / "a").iterdir() if PASSING in path.name]
    assert store.names("a") == ["b"]
    assert store.read("a/b") == b"old"


@pytest.mark.parametrize(
    ("fault", "breaks", "tries"),
    [("cut off", TRIES - 1, TRIES), ("cut off", TRIES, TRIES), ("of two", TRIES - 1, TRIES), ("no server", 1, 1)],
)
def test_an_incomplete_content_is_read_again(fault, breaks, tries, tmp_path, monkeypatch):
    """So is a mixture of two contents. Other errors are not retried, since libraries already retry for seconds."""
    store = Store(f"memory://{tmp_path}")
    store.write("a", b"whole")
    cat_file, asked = store._system.cat_file, []

    def cut_off(path: str) -> bytes:
        asked.append(path)
        if len(asked) <= breaks:
            raise DriverError("received 3919872 of 6854895 bytes")
        return cat_file(path)

    monkeypatch.setattr(store._system, "cat_file", cut_off)
    monkeypatch.setattr("hedon.ensemble.store.PAUSE", 0.0)
    payload, checksum = (DriverError if fault == each else ZeroDivisionError for each in ("cut off", "of two"))
    monkeypatch.setitem(sys.modules, "aiohttp", SimpleNamespace(ClientPayloadError=payload))
    monkeypatch.setitem(sys.modules, "botocore.exceptions", SimpleNamespace(FlexibleChecksumError=checksum))
    if fault != "no server" and breaks < TRIES:
        assert store.read("a") == b"whole"
    else:
        with pytest.raises(HedonError, match=r"cannot read a of memory.*: DriverError: received 3919872 of"):
            store.read("a")
    assert len(asked) == tries


class DriverError(Exception):
    """What an object-store library raises if its server or its keys are missing; it is not an OSError."""


def test_any_error_of_a_place_becomes_one_message(tmp_path, monkeypatch):
    store = Store(f"file://{tmp_path}")
    assert isinstance(store, Store)

    def fail(*_arguments: object, **_options: object) -> None:
        raise DriverError("no keys")

    for name in ("pipe_file", "cat_file", "ls", "rm_file"):
        monkeypatch.setattr(type(store._system), name, fail)
    asked = {
        "cannot write a/b to": lambda: store.write("a/b", b""),
        "cannot read a/b of": lambda: store.read("a/b"),
        "cannot list a of": lambda: store.names("a"),
        "cannot remove a/b of": lambda: store.remove("a/b"),
    }
    for message, ask in asked.items():
        with pytest.raises(HedonError, match=f"{message} file://.*: DriverError: no keys"):
            ask()


def test_a_damaged_state_is_ignored(tmp_path):
    url = f"file://{tmp_path}/far"
    plan, store = planned(sweep_file(tmp_path, 128, seeds=1), url)
    (batch, *_) = plan.batches()
    store.write(f"{STATE}/{batch.name}.zip", b"PK but no archive")
    assert batch_job(url, plan, batch, tmp_path / "run", 1e9).make(1, None) == "finished"
    assert store.names(STATE) == []


def test_a_sweep_at_a_url_continues_elsewhere(tmp_path):
    assert_goes_on_elsewhere(f"file://{tmp_path}/far", tmp_path, 5_120)


@pytest.mark.long
def test_two_processes_that_make_one_sweep_harm_no_row(tmp_path):
    one_batch = '[factor]\n"energy.basic_cost" = [0.001]\n'
    assert_two_make_one(f"file://{tmp_path}/far", tmp_path, one_batch)


def test_a_url_of_an_unknown_kind_is_refused():
    with pytest.raises(HedonError, match="nosuch://x"):
        Store("nosuch://x/y")
