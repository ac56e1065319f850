"""The error of this part."""

from pathlib import Path

from hedon.error import HedonError


class RecordError(HedonError):
    """A record cannot be written or read. The message names the file or column and says what to do."""


class InUseError(RecordError):
    """A folder that another process has locked.

    Args:
        folder: of the run.
        owner: who has locked it, as text to follow "by another run"; may be empty.

    Attributes:
        owner: what is known of the process, in brackets after a space; empty if nothing is.
    """

    def __init__(self, folder: Path, owner: str) -> None:
        super().__init__(f"{folder} is in use by another run{owner}: wait for it, or stop it first")
        self.owner = owner
