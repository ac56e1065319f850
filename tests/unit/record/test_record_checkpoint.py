"""Checkpoint files: they read back unchanged, and no other file passes for one."""

import io
import os
import pickle
import zipfile
from pathlib import Path

import numpy as np
import psutil
import pytest
from resumed_run import filler

from hedon.record.array_file import ArrayWriter, digest
from hedon.record.checkpoint import Checkpoint, CheckpointHead, Sampled, load_checkpoint, save_checkpoint
from hedon.record.error import RecordError
from hedon.record.folder import checkpoint_path, checkpoint_paths

ARRAYS = {
    "0/params": np.arange(12, dtype=np.float32).reshape(3, 4),
    "0/head.step": np.array([7]),
    "1/touch": np.zeros(0, np.uint64),
    "1/observation": np.zeros((0, 192), np.uint8),
}


def head(step: int = 7) -> CheckpointHead:
    sampled = Sampled(5, {"births": 3, "energy_eaten": 0.1 + 0.2}, (4, 5))
    return CheckpointHead(
        step, "x = 1\n", (1, 2), "avx2", "0.1.0", 0, 1.5, (sampled,) * 2, ("a", "b"), {"agents": ("c",)}
    )


def saved(folder: Path) -> Path:
    save_checkpoint(folder, head(), filler(ARRAYS))
    return checkpoint_path(folder, 7)


def test_a_checkpoint_reads_back_unchanged(tmp_path: Path) -> None:
    found = load_checkpoint(saved(tmp_path))
    assert found.head == head()
    assert isinstance(found.head.sampled[0].counters["births"], int)
    assert found.arrays.keys() == ARRAYS.keys()
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(found.arrays[name], array, strict=True)
    assert set(found.world(0)) == {"params", "head.step"}


def test_arrays_are_mapped_from_the_file(tmp_path: Path) -> None:
    """A checkpoint may be larger than memory. It is read whole only on Windows, which cannot remove a mapped file."""
    found = load_checkpoint(saved(tmp_path))
    mapped = [each.path for each in psutil.Process().memory_maps() if each.path.startswith(str(tmp_path))]
    assert bool(mapped) == (os.name != "nt")
    for array in found.arrays.values():
        assert not array.flags.owndata
        assert array.flags.aligned
        assert not array.flags.writeable


def test_pieces_make_the_same_file_as_a_whole_array(tmp_path: Path) -> None:
    array = np.arange(4000, dtype=np.float64).reshape(-1, 5)
    data = array.tobytes()
    with (tmp_path / "pieces").open("wb") as file, ArrayWriter(file) as out:
        out.begin("some", "f8", array.shape)
        for first in range(0, len(data), 777):
            out.piece(data[first : first + 777])
        assert out.digest() == digest({"some": array}) != digest({"some": array + 1})
    with (tmp_path / "whole").open("wb") as file, ArrayWriter(file) as out:
        out.add("some", array)
    assert (tmp_path / "pieces").read_bytes() == (tmp_path / "whole").read_bytes()
    with (tmp_path / "whole").open("rb") as file:
        np.testing.assert_array_equal(np.load(file)["some"], array, strict=True)


def test_numpy_can_read_a_checkpoint_too(tmp_path: Path) -> None:
    with np.load(saved(tmp_path), allow_pickle=False) as file:
        np.testing.assert_array_equal(file["0/params"], ARRAYS["0/params"])


def test_the_newest_two_are_kept(tmp_path: Path) -> None:
    for step in (5, 6, 70, 71, 72):
        save_checkpoint(tmp_path, head(step), filler(ARRAYS))
    assert checkpoint_paths(tmp_path) == [checkpoint_path(tmp_path, 71), checkpoint_path(tmp_path, 72)]


def test_truncated_and_changed_files_are_detected(tmp_path: Path) -> None:
    path = saved(tmp_path)
    data = path.read_bytes()
    for length in range(0, len(data), 97):
        path.write_bytes(data[:length])
        with pytest.raises(RecordError, match="damaged checkpoint"):
            load_checkpoint(path)
    arrays, passed = load_checkpoint_of(path, data).arrays, 0
    for at in range(0, len(data), 13):
        path.write_bytes(data[:at] + bytes([data[at] ^ 16]) + data[at + 1 :])
        try:
            found = load_checkpoint(path)
        except RecordError:
            continue
        passed += 1  # for example, a time stamp in the archive: only the content counts
        assert found.head == head()
        assert all(np.array_equal(found.arrays[name], arrays[name]) for name in arrays)
    assert passed < len(data) / 13 / 4


def load_checkpoint_of(path: Path, data: bytes) -> Checkpoint:
    path.write_bytes(data)
    return load_checkpoint(path)


def npy(array: np.ndarray, **options) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, array, **options)
    return file.getvalue()


class Bomb:
    """Fails the test if it is unpickled."""

    def __reduce__(self):
        return (pytest.fail, ("a checkpoint was executed",))


@pytest.mark.parametrize(
    ("member", "compression", "words"),
    [
        (npy(np.array([Bomb()]), allow_pickle=True), zipfile.ZIP_STORED, "only plain numbers are allowed"),
        (pickle.dumps(Bomb()), zipfile.ZIP_STORED, "damaged"),
        (npy(np.zeros(3, "datetime64[s]")), zipfile.ZIP_STORED, "only plain numbers are allowed"),
        (npy(np.zeros(3, ">f4")), zipfile.ZIP_STORED, "only plain numbers are allowed"),
        (npy(np.zeros(3))[:-8], zipfile.ZIP_STORED, "does not match its shape"),
        (npy(np.zeros(1)).replace(b"(1,)", b"(9223372036854775807,)"), zipfile.ZIP_STORED, "damaged"),
        (npy(np.zeros(1)).replace(b"(1,)", b"(-1,-1)"), zipfile.ZIP_STORED, "damaged"),
        (npy(np.zeros(10_000_000)), zipfile.ZIP_DEFLATED, "shorter than the sizes that it declares"),
        (npy(np.zeros(10)), zipfile.ZIP_DEFLATED, "shorter than the sizes that it declares|not written by hedon"),
        (npy(np.zeros(3)), zipfile.ZIP_STORED, "digest"),
    ],
)
def test_a_file_with_foreign_content_is_refused(tmp_path: Path, member: bytes, compression: int, words: str) -> None:
    path = saved(tmp_path)
    with zipfile.ZipFile(path, "a", compression) as archive:
        archive.writestr("more.npy", member)
    with pytest.raises(RecordError, match=words):
        load_checkpoint(path)


def test_a_head_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = checkpoint_path(tmp_path, 7)
    path.parent.mkdir()
    with path.open("wb") as file:
        np.savez(file, head=np.frombuffer(b'{"step": 7}', np.uint8))
    with pytest.raises(RecordError, match="damaged checkpoint"):
        load_checkpoint(path)
    saved(tmp_path).rename(checkpoint_path(tmp_path, 8))
    with pytest.raises(RecordError, match="it is of step 7"):
        load_checkpoint(checkpoint_path(tmp_path, 8))
    with pytest.raises(RecordError, match="No such file"):
        load_checkpoint(path)
