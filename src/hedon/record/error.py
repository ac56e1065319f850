"""The errors that this package raises."""

from pathlib import Path

from hedon.error import HedonError


class RecordError(HedonError):
    """A record cannot be written or read. The message names the file or column, and gives a remedy."""


class InUseError(RecordError):
    """The folder is locked by another process.

    Args:
        folder: Folder of the run.
        owner: Description of the owner, as text to follow "by another run"; may be empty.

    Attributes:
        owner: Description of the process, in brackets after a space; empty if unknown.
    """

    def __init__(self, folder: Path, owner: str) -> None:
        super().__init__(f"{folder} is in use by another run{owner}: wait for it, or stop it first")
        self.owner = owner
