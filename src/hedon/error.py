"""The root of every error that hedon raises about what its user asked for, and those that no part owns."""


class HedonError(Exception):
    """Something that the user can put right; the command line prints it as a message, without a traceback."""


class ArgumentError(HedonError):
    """An argument from Python that cannot be used: the message names it, its value and what is allowed."""


class EngineError(HedonError):
    """What the engine reports: a world that cannot go on, or a simulation that cannot be made or used."""
