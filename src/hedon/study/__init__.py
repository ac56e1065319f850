"""Studies: claims, the worlds needed to test them, and the results."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
