"""The settings, a dataclass per concern: meaning, unit, range, default, source. The root is `settings.py`."""
