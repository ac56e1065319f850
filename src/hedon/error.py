"""The one base class of every error that hedon raises on purpose."""


class HedonError(Exception):
    """A mistake in what hedon was given, or a fault that it met; the message says what to do."""
