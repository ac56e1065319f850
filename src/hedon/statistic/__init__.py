"""Statistical methods, one per file: functions of arrays that do not depend on runs, files or worlds."""

from lazy_loader import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
