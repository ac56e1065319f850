"""The error of sweeps."""

from hedon.error import HedonError


class SweepError(HedonError):
    """A sweep that cannot be made, run or read: the message says which, and what to do."""
