"""The error of jobs."""

from hedon.error import HedonError


class JobError(HedonError):
    """Jobs that cannot be made or kept: the message says which, where, and what to do."""
