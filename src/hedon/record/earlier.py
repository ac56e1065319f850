"""What files of earlier versions have in place of what they have now."""

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

NAMES = {"kernel": "backend", "inner": "stores"}
"""Fields of a manifest, of its sessions, and of the head of a checkpoint."""


def with_names(content: bytes) -> bytes:
    """JSON whose fields have the names of this version.

    Args:
        content: Of a file; one without old names comes back as it is.

    Raises:
        ValueError: It is not JSON.
    """
    if not any(f'"{old}"'.encode() in content for old in NAMES):
        return content
    found = json.loads(content)
    if not isinstance(found, dict):
        return content
    sessions = found.get("sessions", ())
    for each in (found, *(sessions if isinstance(sessions, list) else ())):
        for old, name in NAMES.items():
            if isinstance(each, dict) and old in each and name not in each:
                each[name] = each.pop(old)
    return json.dumps(found).encode()


def earlier_digest(arrays: Mapping[str, NDArray[Any]]) -> str:
    """The digest that a checkpoint of version 0.4 has as its member `digest`, of arrays of any shape."""
    found = hashlib.sha256()
    for name, array in sorted(arrays.items()):
        found.update(f"{name} {array.dtype.str} {array.shape}\n".encode())
        found.update(np.ascontiguousarray(array).data)
    return found.hexdigest()
