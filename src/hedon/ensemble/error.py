"""The error that ensembles raise."""

from hedon.error import HedonError


class EnsembleError(HedonError):
    """Worlds cannot be planned, simulated or stored. The message names them and the place, and gives a remedy."""
