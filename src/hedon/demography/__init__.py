"""What follows from the settings alone, before any run: lives, births, room for newborns, and what limits a world."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
