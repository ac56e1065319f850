"""What a video cannot be made from, or written to."""

from hedon.error import HedonError


class VideoError(HedonError):
    """A moment that was not recorded, or a file that cannot be written."""
