"""The base class of hedon's errors about a user's input, and errors shared by several parts."""


class HedonError(Exception):
    """A problem that the user can fix; the command line prints it as a message, without a traceback."""


class ArgumentError(HedonError):
    """An invalid argument from Python; the message gives the argument, its value and what is allowed."""


class EngineError(HedonError):
    """An error of the engine: a world cannot continue, or a simulation cannot be created or used."""
