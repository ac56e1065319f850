"""Measures computed from the records of runs, for worlds, agents, descent and genes; `topic` makes tables of them."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
