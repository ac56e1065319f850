"""Files of plain NumPy arrays, written in pieces and memory-mapped for reading. Untrusted files are safe: no pickle."""

import hashlib
import io
import math
import os
import struct
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

_VERSION = (1, 0)
"""Version of NumPy's array format that can store any plain numbers."""
_ALIGNMENT = 64
"""Arrays start at multiples of this in the file, so that they can be used without a copy [byte]."""
_LOCAL_HEAD, _LENGTHS = 30, struct.Struct("<26xHH")
"""Bytes before the name of a member, and the position of the lengths of its name and extra field (zip, 4.3.7)."""
_LONGEST_HEAD = np.lib.format.MAGIC_LEN + 2 + (1 << 16)
"""Largest size of the description of an array before its numbers [byte]."""
_PIECE = 1 << 20
"""Size of the blocks in which an array is hashed [byte]."""


class ArrayWriter:
    """Writes an npz file like `numpy.savez`, one array after another, each in pieces. Use it as a context manager.

    Args:
        file: An empty file that is open for writing.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._archive = zipfile.ZipFile(file, "w", zipfile.ZIP_STORED)
        self._member: Any = None
        self._name = ""
        self._sums: dict[str, Any] = {}

    def __enter__(self) -> "ArrayWriter":
        return self

    def __exit__(self, *error: object) -> None:
        self._end()
        self._archive.close()

    def add(self, name: str, array: NDArray[Any]) -> None:
        """Writes a whole array.

        Args:
            name: Name of the array in the file.
            array: Plain numbers, any shape.
        """
        self.begin(name, array.dtype.str, array.shape)
        self.piece(np.ascontiguousarray(array).data.cast("B") if array.size else b"")

    def begin(self, name: str, dtype: str, shape: Sequence[int]) -> None:
        """Starts an array, whose bytes are then written with `piece`, in C order.

        Args:
            name: Name of the array in the file.
            dtype: Type of its numbers, in NumPy's notation.
            shape: Shape of the array.
        """
        self._end()
        kind = np.dtype(dtype)
        self._member = self._archive.open(f"{name}.npy", "w", force_zip64=True)
        text = repr({"descr": kind.str, "fortran_order": False, "shape": tuple(shape)})
        header_size = self._file.tell() + len(np.lib.format.magic(*_VERSION)) + 2 + len(text) + 1
        text += " " * (-header_size % _ALIGNMENT) + "\n"
        self._member.write(np.lib.format.magic(*_VERSION) + struct.pack("<H", len(text)) + text.encode())
        self._name, self._sums[name] = name, _sum_of(kind, tuple(shape))

    def piece(self, data: bytes | memoryview) -> None:
        """Writes the next bytes of the array that was started last."""
        self._member.write(data)
        self._sums[self._name].update(data)

    def digest(self) -> str:
        """SHA-256 of everything written so far, equal to `digest` of the same arrays."""
        return _digest({name: checksum.hexdigest() for name, checksum in self._sums.items()})

    def _end(self) -> None:
        if self._member is not None:
            self._member.close()
            self._member = None


def digest(arrays: Mapping[str, NDArray[Any]]) -> str:
    """SHA-256 of the names, types, shapes and bytes of arrays of any shape; their order does not matter."""
    sums = {}
    for name, array in arrays.items():
        checksum = _sum_of(array.dtype, array.shape)
        data = np.ascontiguousarray(array).data.cast("B") if array.size else memoryview(b"")
        for offset in range(0, len(data), _PIECE):
            checksum.update(data[offset : offset + _PIECE])
        sums[name] = checksum.hexdigest()
    return _digest(sums)


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """Reads the arrays of an npz file written by `ArrayWriter` or `numpy.savez`, by name, any shape.

    Arrays that are aligned for their type are views of the file, which must not change while they are in use. A file
    may therefore be larger than memory.

    Raises:
        ValueError: The file contains anything but plain numbers, or declares more data than it has.
        Exception: The file is missing or damaged; any error that reading raises is passed on.
    """
    members: dict[str, NDArray[Any]] = {}
    with zipfile.ZipFile(path) as archive:
        entries = archive.infolist()
        if sum(entry.file_size for entry in entries) > path.stat().st_size:
            raise ValueError("it is shorter than the sizes that it declares")
        for entry in entries:
            if entry.compress_type != zipfile.ZIP_STORED or entry.filename in members:
                raise ValueError(f"{entry.filename} was not written by hedon")
        damaged = archive.testzip()
        if damaged is not None:
            raise ValueError(f"{damaged} is damaged")
        # Windows cannot remove a mapped file, and a run removes its old checkpoints.
        file = np.fromfile(path, np.uint8) if os.name == "nt" else np.asarray(np.memmap(path, np.uint8, "r"))
        file.setflags(write=False)
        for entry in entries:
            head = entry.header_offset
            offset = head + _LOCAL_HEAD + sum(_LENGTHS.unpack(file[head : head + _LOCAL_HEAD].tobytes()))
            array = _parse_array(file[offset : offset + entry.file_size])
            members[entry.filename.removesuffix(".npy")] = array
    return members


def _parse_array(data: NDArray[np.uint8]) -> NDArray[Any]:
    head = io.BytesIO(data[:_LONGEST_HEAD].tobytes())
    if np.lib.format.read_magic(head) != _VERSION:
        raise ValueError("an array has an unknown format")
    shape, in_columns, dtype = np.lib.format.read_array_header_1_0(head)
    if dtype.kind not in "iuf" or not dtype.isnative or in_columns:
        raise ValueError(f"an array has type {dtype}, but only plain numbers are allowed")
    numbers = data[head.tell() :]
    if math.prod(shape) * dtype.itemsize != len(numbers):
        raise ValueError("the length of an array does not match its shape")
    return np.require(numbers.view(dtype).reshape(shape), requirements=["A"])


def _sum_of(kind: np.dtype[Any], shape: tuple[int, ...]) -> Any:
    return hashlib.sha256(f"{kind.str} {shape}\n".encode())


def _digest(sums: Mapping[str, str]) -> str:
    return hashlib.sha256(
        "".join(f"{name} {checksum}\n" for name, checksum in sorted(sums.items())).encode()
    ).hexdigest()
