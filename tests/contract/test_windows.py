"""What is different on Windows, with its calls emulated on this system, so that no Python for Windows is needed.

The script below makes `hedon.record.lock` behave as on Windows: `msvcrt` locks bytes of a file, by means of `fcntl`,
and a folder cannot be opened.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from hedon.record import atomic

PLAYED = """
import errno, fcntl, importlib, os, sys, types
from pathlib import Path
import hedon.record.lock as lock
from hedon.record.error import InUseError

def locking(descriptor, mode, count):
    try:
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB, count, 0, os.SEEK_CUR)
    except OSError:
        raise OSError(errno.EACCES, "Permission denied") from None

def refuse_folders(path, *given, real=os.open):
    if os.path.isdir(path):
        raise PermissionError(errno.EACCES, "Permission denied")
    return real(path, *given)

sys.modules["msvcrt"] = types.SimpleNamespace(locking=locking, LK_NBLCK=2)
sys.modules["fcntl"] = None
sys.platform, os.open = "win32", refuse_folders
importlib.reload(lock)
folder = Path(sys.argv[1])
"""
HOLD = "with lock.FolderLock(folder):\n    print(os.getpid(), flush=True)\n    sys.stdin.readline()\n"
TRY = "try:\n    with lock.FolderLock(folder): print('taken')\nexcept InUseError as error: print(error.owner)\n"
WRITE = "with lock.one_writer(folder, 'it'):\n    print('in', flush=True)\n    sys.stdin.readline()\n"


def begin(code: str, folder: Path) -> subprocess.Popen[str]:
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-c", PLAYED + code, str(folder)], text=True, stdin=pipe, stdout=pipe)


def first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def release(process: subprocess.Popen[str]) -> None:
    process.communicate("\n", timeout=60)
    assert process.returncode == 0


def test_a_second_process_is_refused_and_learns_who_has_the_folder(tmp_path: Path):
    holder = begin(HOLD, tmp_path)
    owner = first_line(holder)
    second = begin(TRY, tmp_path)
    assert first_line(second).startswith(f"(process {owner} on ")
    release(second)
    release(holder)
    assert json.loads((tmp_path / ".lock").read_text())["process"] == int(owner)
    third = begin(TRY, tmp_path)
    assert first_line(third) == "taken"
    release(third)


def test_a_second_writer_waits_and_leaves_no_file(tmp_path: Path):
    writer = begin(WRITE, tmp_path)
    assert first_line(writer) == "in"
    second = begin(WRITE, tmp_path)
    with pytest.raises(subprocess.TimeoutExpired):
        second.wait(2.0)
    release(writer)
    assert first_line(second) == "in"
    release(second)
    assert list(tmp_path.iterdir()) == []


def test_an_open_file_is_replaced_once_its_reader_has_closed_it(tmp_path: Path, monkeypatch):
    path, refused = tmp_path / "file", []
    path.write_text("old")

    def replace(self: Path, target: Path, real=Path.replace) -> Path:
        if len(refused) < 3:
            refused.append(self)
            raise PermissionError(13, "the process cannot access the file", str(target))
        return real(self, target)

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(PermissionError):
        atomic.write_atomically(path, lambda file: file.write(b"new"))
    assert path.read_text() == "old"
    monkeypatch.setattr(atomic, "_BUSY_SECONDS", 30.0)
    atomic.write_atomically(path, lambda file: file.write(b"new"))
    assert (path.read_text(), len(refused)) == ("new", 3)
    assert list(tmp_path.iterdir()) == [path]
