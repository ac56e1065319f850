"""Environments for other programs' agents: `vector_env` for many worlds as arrays, `parallel_env` for PettingZoo.

`parallel_env` needs the optional packages: `pip install "hedon[env]"`.
"""

from typing import TYPE_CHECKING, Any

from hedon.env.group import Group
from hedon.env.vector import VectorEnv, vector_env

if TYPE_CHECKING:
    from hedon.env.parallel import ParallelEnv, parallel_env

__all__ = ["Group", "ParallelEnv", "VectorEnv", "parallel_env", "vector_env"]


def __getattr__(name: str) -> Any:
    # Imported on first use: the arrays need neither PettingZoo nor Gymnasium.
    if name not in ("ParallelEnv", "parallel_env"):
        raise AttributeError(f"module 'hedon.env' has no attribute {name!r}")
    try:
        from hedon.env import parallel
    except ModuleNotFoundError as error:
        from hedon.error import HedonError

        raise HedonError(f'hedon.env.{name} needs {error.name}: pip install "hedon[env]"') from error
    return getattr(parallel, name)
