"""Studies: what is claimed, the worlds that this needs, and what they say."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
