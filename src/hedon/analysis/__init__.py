"""What is computed from the records of runs: of worlds, agents, descent and genes; `topic` makes tables of it."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
