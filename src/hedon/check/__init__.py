"""Checks whether a run's folder is complete and consistent, and which data are still usable. Needs no engine."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
