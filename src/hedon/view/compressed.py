"""Compresses the answers of the local server with gzip, each content once, however often it is requested."""

import gzip
import threading
from hashlib import sha256
from pathlib import PurePosixPath

LEVEL = 6
DENSE = frozenset((".parquet", ".gz", ".jpg"))
"""Kinds of files that are compressed already."""


def takes_gzip(accepted: str) -> bool:
    """Whether a browser takes gzip, from what it sent as `Accept-Encoding`."""
    weights = {}
    for entry in accepted.lower().replace(" ", "").split(","):
        name, _, weight = entry.partition(";q=")
        weights[name] = weight.strip("0.") != "" or weight == ""
    return weights.get("gzip", weights.get("*", False))


class Compressed:
    """The compressed content of each name that was asked for; data that has changed since is compressed again."""

    def __init__(self) -> None:
        self._packed: dict[str, tuple[bytes, bytes]] = {}
        self._lock = threading.Lock()

    def pack(self, name: str, content: bytes) -> bytes | None:
        """The content in gzip's format; None if that would not be smaller.

        Args:
            name: Path of the link; its suffix gives the kind of file.
            content: The bytes to compress.
        """
        if PurePosixPath(name).suffix in DENSE:
            return None
        digest = sha256(content).digest()
        with self._lock:  # two browsers that begin at once compress a file once
            cached = self._packed.get(name)
            if cached is None or cached[0] != digest:
                cached = (digest, gzip.compress(content, LEVEL, mtime=0))
                self._packed[name] = cached
        return cached[1] if len(cached[1]) < len(content) else None
