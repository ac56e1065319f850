"""Pictures: one question per file, drawn from numbers that are there. Nothing is computed here but what is drawn."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
