"""Serializes arrays with a description of their origin, for `VectorEnv.save` to add to the worlds."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hedon.error import ArgumentError

Arrays = dict[tuple[str, str], NDArray[Any]]
FREE = "_gone"
"""The only array whose length may differ."""


def text_of(about: dict[str, Any], arrays: Arrays) -> bytes:
    """Serializes arrays.

    Args:
        about: Description of the environment that they belong to.
        arrays: Arrays of any shapes, by two names.
    """
    rows = [[*names, len(array)] for names, array in arrays.items()]
    head = json.dumps({"about": about, "rows": rows}).encode()
    return b"".join([head, b"\n", *(np.ascontiguousarray(array).tobytes() for array in arrays.values())])


def arrays_in(text: bytes, about: dict[str, Any], like: Arrays) -> Arrays:
    """Reads serialized arrays.

    Args:
        text: Bytes from `text_of`.
        about: Description that they must match.
        like: Arrays whose types and shapes they must have.

    Returns:
        Arrays by name, of the shapes of `like`.

    Raises:
        ArgumentError: The bytes are anything else.
    """
    head, _, data = text.partition(b"\n")
    try:
        header = json.loads(head)
    except ValueError:
        raise ArgumentError("saved: these bytes hold worlds alone, without those who drive them") from None
    if header["about"] != about:
        raise ArgumentError(f"saved: these worlds were driven in another way: {header['about']}, here {about}")
    arrays: Arrays = {}
    offset = 0
    for (species, name, rows), (names, array) in zip(header["rows"], like.items(), strict=True):
        if name == "steps" and rows != len(array):  # the first array: a number per world
            raise ArgumentError(f"saved: there are {rows} worlds, here {len(array)}")
        shape = (rows, *array.shape[1:])
        count = rows * int(np.prod(array.shape[1:], dtype=np.int64))
        if (species, name) != names or (rows != len(array) and name != FREE) or rows < 0:
            raise ArgumentError(f"saved: {name} is of other worlds")
        arrays[names] = np.frombuffer(data, array.dtype, count, offset).reshape(shape).copy()
        offset += count * array.dtype.itemsize
    return arrays
