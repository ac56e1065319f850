"""Environments for training agents with other programs: arrays of many worlds, and the Gymnasium, PettingZoo, SB3 and
JAX APIs.

`hedon.make` provides the arrays and needs only NumPy. The other APIs need optional packages: `pip install "hedon[env]"`
for Gymnasium and PettingZoo, `"hedon[jax]"` for JAX; Stable-Baselines3 is installed under its own name.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from hedon.env.group import Group
from hedon.env.make import make
from hedon.env.vector import VectorEnv

if TYPE_CHECKING:
    from hedon.env.agent import AgentEnv
    from hedon.env.agent_vector import AgentVectorEnv
    from hedon.env.jax import JaxEnv, JaxParams
    from hedon.env.jax_log import JaxLog
    from hedon.env.parallel import ParallelEnv
    from hedon.env.slot import SlotVecEnv
    from hedon.env.slot_vector import SlotVectorEnv

__all__ = [
    "AgentEnv",
    "AgentVectorEnv",
    "Group",
    "JaxEnv",
    "JaxLog",
    "JaxParams",
    "ParallelEnv",
    "SlotVecEnv",
    "SlotVectorEnv",
    "VectorEnv",
    "make",
]

_PLACES = {
    "AgentEnv": ("agent", "hedon[env]"),
    "AgentVectorEnv": ("agent_vector", "hedon[env]"),
    "JaxEnv": ("jax", "hedon[jax]"),
    "JaxLog": ("jax_log", "hedon[jax]"),
    "JaxParams": ("jax", "hedon[jax]"),
    "ParallelEnv": ("parallel", "hedon[env]"),
    "SlotVecEnv": ("slot", "stable-baselines3"),
    "SlotVectorEnv": ("slot_vector", "hedon[env]"),
}
"""Module of each name, and the extra that installs the packages it needs."""


def __getattr__(name: str) -> Any:
    # Imported on first use, because the arrays need none of these packages.
    if name not in _PLACES:
        raise AttributeError(f"module 'hedon.env' has no attribute {name!r}")
    module, package = _PLACES[name]
    try:
        return getattr(import_module(f"hedon.env.{module}"), name)
    except ModuleNotFoundError as error:
        from hedon.error import HedonError

        raise HedonError(f'hedon.env.{name} needs {error.name}: pip install "{package}"') from error
