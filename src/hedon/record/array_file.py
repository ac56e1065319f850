"""Reads files of plain NumPy arrays, which may come from anyone: no pickle, and no memory before sizes are known."""

import io
import math
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """The arrays of an npz file as `numpy.savez` writes it, by name, any shape.

    Raises:
        ValueError: the file holds anything but plain numbers, or more than it could.
        Exception: the file is missing or damaged: whatever reading it raises.
    """
    members: dict[str, NDArray[Any]] = {}
    with zipfile.ZipFile(path) as archive:
        entries = archive.infolist()
        if sum(entry.file_size for entry in entries) > path.stat().st_size:
            raise ValueError("it is shorter than the sizes that it declares")
        for entry in entries:
            if entry.compress_type != zipfile.ZIP_STORED or entry.filename in members:
                raise ValueError(f"{entry.filename} was not written by hedon")
            members[entry.filename.removesuffix(".npy")] = _parse_array(archive.read(entry))
    return members


def _parse_array(data: bytes) -> NDArray[Any]:
    file = io.BytesIO(data)
    if np.lib.format.read_magic(file) != (1, 0):
        raise ValueError("an array has an unknown format")
    shape, in_columns, dtype = np.lib.format.read_array_header_1_0(file)
    if dtype.kind not in "iuf" or not dtype.isnative or in_columns:
        raise ValueError(f"an array has type {dtype}, but only plain numbers are allowed")
    if math.prod(shape) * dtype.itemsize != len(data) - file.tell():
        raise ValueError("the length of an array does not match its shape")
    return np.frombuffer(data, dtype, offset=file.tell()).reshape(shape)
