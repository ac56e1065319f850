"""The error of this part."""

from hedon.error import HedonError


class RecordError(HedonError):
    """A record cannot be written or read: the message names the file or column and what to do."""
