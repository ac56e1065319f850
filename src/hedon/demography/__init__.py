"""Predictions from settings, before any run: lives, births, space for newborns, and what limits a world."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
