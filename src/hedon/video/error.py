"""The error that videos raise."""

from hedon.error import HedonError


class VideoError(HedonError):
    """A moment was not recorded, or a file cannot be written."""
