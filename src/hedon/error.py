"""The base class of all errors that hedon raises about a user's input, and the errors that several parts share."""


class HedonError(Exception):
    """A problem that the user can fix; the command line prints it as a message, without a traceback."""


class ArgumentError(HedonError):
    """An argument from Python that cannot be used: the message names it, its value and what is allowed."""


class EngineError(HedonError):
    """An error of the engine: a world that cannot continue, or a simulation that cannot be made or used."""
