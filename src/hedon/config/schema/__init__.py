"""The settings, one dataclass per topic: meaning, unit, range, default and source. The root is `settings.py`."""
