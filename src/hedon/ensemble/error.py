"""The error of ensembles."""

from hedon.error import HedonError


class EnsembleError(HedonError):
    """Worlds that cannot be planned, made or kept: the message says which, where, and what to do."""
