"""Measures: the numbers of a world, each with one name wherever it appears."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
