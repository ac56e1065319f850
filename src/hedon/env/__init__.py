"""Worlds as environments for other programs' agents: `batch` for many worlds as arrays, `parallel_env` for PettingZoo.

`parallel_env` needs the optional packages: `pip install "hedon[env]"`.
"""

from typing import TYPE_CHECKING, Any

from hedon.env.batch import Batch, batch
from hedon.env.group import Group

if TYPE_CHECKING:
    from hedon.env.parallel import World, parallel_env

__all__ = ["Batch", "Group", "World", "batch", "parallel_env"]


def __getattr__(name: str) -> Any:
    # Imported on first use: the arrays need neither PettingZoo nor Gymnasium.
    if name not in ("World", "parallel_env"):
        raise AttributeError(f"module 'hedon.env' has no attribute {name!r}")
    try:
        from hedon.env import parallel
    except ModuleNotFoundError as error:
        from hedon.error import HedonError

        raise HedonError(f'hedon.env.{name} needs {error.name}: pip install "hedon[env]"') from error
    return getattr(parallel, name)
