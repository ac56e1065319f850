"""The base class of hedon's errors about a user's input, and errors shared by several parts."""

from traceback import extract_tb


class HedonError(Exception):
    """A problem that the user can fix; the command line prints it as a message, without a traceback."""


class ArgumentError(HedonError):
    """An invalid argument from Python; the message gives the argument, its value and what is allowed."""


class EngineError(HedonError):
    """An error of the engine: a world cannot continue, or a simulation cannot be created or used."""


def failure(error: Exception) -> str:
    """What failed in code of another package, and in which line of which file."""
    if isinstance(error, HedonError):
        return str(error)
    place = extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {error} (line {place.lineno} of {place.filename})"
