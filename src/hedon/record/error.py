"""The error of this part."""

from hedon.error import HedonError


class RecordError(HedonError):
    """A record cannot be written or read. The message names the file or column and says what to do."""
