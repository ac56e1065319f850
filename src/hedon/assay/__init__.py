"""Fitness measured directly: founders with chosen genes compete, and their descendants are counted."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
