"""The root of every error that hedon raises about what its user asked for."""


class HedonError(Exception):
    """Something that the user can put right; the command line prints it as a message, without a traceback."""
