"""A plugin of pytest: the engine built with a sanitizer, named by `HEDON_SANITIZED`, in the place of the usual one."""

import importlib.util
import os
import sys

import hedon

NAME = "hedon._engine"
assert "hedon.experiment" not in sys.modules, "hedon was loaded before, with its usual engine"

spec = importlib.util.spec_from_file_location(NAME, os.environ["HEDON_SANITIZED"])
assert spec is not None
assert spec.loader is not None
module = importlib.util.module_from_spec(spec)
sys.modules[NAME] = module
setattr(hedon, "_engine", module)  # noqa: B010 (the stubs do not know that it can be set)
spec.loader.exec_module(module)
