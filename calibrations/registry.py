"""All calibrations: those of each module of this package."""

import importlib
import pkgutil

import calibrations
from calibrations.calibration import Calibration

NO_TOPIC = {"__main__", "calibration", "page", "registry"}


def all_calibrations() -> dict[str, Calibration]:
    """Every calibration by its key, in the order of modules and of their lists `CALIBRATIONS`.

    Raises:
        ValueError: two have the same key.
    """
    entries: dict[str, Calibration] = {}
    for module in sorted(info.name for info in pkgutil.iter_modules(calibrations.__path__)):
        if module in NO_TOPIC:
            continue
        for entry in importlib.import_module(f"calibrations.{module}").CALIBRATIONS:
            if entry.key in entries:
                raise ValueError(f"two calibrations are called {entry.key!r}")
            entries[entry.key] = entry
    return entries
