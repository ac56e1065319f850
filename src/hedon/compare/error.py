"""The error that comparisons raise."""

from hedon.error import HedonError


class CompareError(HedonError):
    """Worlds cannot be compared. The message gives the reason, and what can be compared."""
