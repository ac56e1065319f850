"""Figures, one question per file, drawn from existing numbers; only what is drawn is computed here."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
