"""Registers the presets with Gymnasium: `gymnasium.make("hedon/baseline-v0")`. The order of imports does not matter."""

import sys
from importlib.abc import MetaPathFinder
from pathlib import Path
from typing import Any

_PRESETS = Path(__file__).parent / "config" / "presets"
_REGISTRY = "gymnasium.envs.registration"


def register_presets() -> None:
    """Registers each preset, now or as soon as Gymnasium is imported.

    `import hedon` calls this, so it must not import Gymnasium, which takes longer than everything else.
    """
    if _REGISTRY in sys.modules:
        _register()
    else:
        sys.meta_path.insert(0, _AfterRegistry())


def _register() -> None:
    register = sys.modules[_REGISTRY].register
    for preset in sorted(path.stem for path in _PRESETS.glob("*.toml")):
        # The episode of this environment is the life of one agent. Its modules are imported when it is created.
        entry, vector = "hedon.env:AgentEnv", "hedon.env:AgentVectorEnv"
        register(f"hedon/{preset}-v0", entry, kwargs={"config": preset}, vector_entry_point=vector)


class _AfterRegistry(MetaPathFinder):
    """Finds no module, but notices when Gymnasium, which imports its registry first, imports another of its modules."""

    def find_spec(self, fullname: str, path: Any, target: Any = None) -> None:
        if fullname.startswith("gymnasium.") and hasattr(sys.modules.get(_REGISTRY), "make_vec"):
            sys.meta_path.remove(self)
            _register()
