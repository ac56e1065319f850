"""A pytest plugin that replaces the engine with the sanitizer build at the path in `HEDON_SANITIZED`."""

import importlib.util
import os
import sys

import hedon

NAME = "hedon._engine"
assert "hedon.experiment" not in sys.modules, "hedon was already loaded, with its usual engine"

spec = importlib.util.spec_from_file_location(NAME, os.environ["HEDON_SANITIZED"])
assert spec is not None
assert spec.loader is not None
module = importlib.util.module_from_spec(spec)
sys.modules[NAME] = module
setattr(hedon, "_engine", module)  # noqa: B010 (the stubs do not allow setting it)
spec.loader.exec_module(module)
