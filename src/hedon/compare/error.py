"""The error of comparisons."""

from hedon.error import HedonError


class CompareError(HedonError):
    """Worlds that cannot be compared: the message says why, and what can be."""
