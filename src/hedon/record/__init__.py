"""Writes and reads the files of a run: tables, manifest, checkpoints and last state."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
