"""Registers the presets with Gymnasium: `gymnasium.make("hedon/baseline-v0")`, in whatever order both are imported."""

import sys
from importlib.abc import MetaPathFinder
from pathlib import Path
from typing import Any

_PRESETS = Path(__file__).parent / "config" / "presets"
_REGISTRY = "gymnasium.envs.registration"


def register_presets() -> None:
    """Registers each preset, now or as soon as Gymnasium is there.

    `import hedon` calls this. It must not load Gymnasium, which takes longer than everything else.
    """
    if _REGISTRY in sys.modules:
        _register()
    else:
        sys.meta_path.insert(0, _AfterRegistry())


def _register() -> None:
    register = sys.modules[_REGISTRY].register
    for preset in sorted(path.stem for path in _PRESETS.glob("*.toml")):
        # An environment whose episode is the life of one agent. What makes it loads when it is made.
        entry, vector = "hedon.env:AgentEnv", "hedon.env:AgentVectorEnv"
        register(f"hedon/{preset}-v0", entry, kwargs={"config": preset}, vector_entry_point=vector)


class _AfterRegistry(MetaPathFinder):
    """Finds no module; sees that Gymnasium, which imports its registry first, imports another part of itself."""

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> None:
        if fullname.startswith("gymnasium.") and hasattr(sys.modules.get(_REGISTRY), "make_vec"):
            sys.meta_path.remove(self)
            _register()
