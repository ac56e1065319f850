"""Base classes for copying objects with worlds: a copy gets its own worlds, and continues as the original would."""

import copy
from typing import Any, Self


class Cloned:
    """Makes `copy.copy` and `copy.deepcopy` the same as `clone`, for objects that hold worlds themselves.

    A copy recreates the attributes in `_own`, and takes over attributes that a subclass or a user has added.
    """

    _own: set[str]

    def clone(self) -> Self:
        """Returns a copy with its own worlds, which continues as this one would, like `copy.copy` and `deepcopy`."""
        raise NotImplementedError

    def _keep_own(self, *later: str) -> None:
        """Marks the current attributes, and those that come later, as recreated by copies."""
        self._own = {*vars(self), "_own", *later}

    def _added(self) -> dict[str, Any]:
        """Attributes added by a subclass or a user."""
        return {name: value for name, value in vars(self).items() if name not in self._own}

    def __copy__(self) -> Self:
        return self.clone()

    def __deepcopy__(self, memo: Any) -> Self:
        return self.clone()


class Copied:
    """Makes `clone` and `copy.copy` the same as `copy.deepcopy`, for objects around those that hold worlds."""

    def clone(self) -> Self:
        """Returns a copy with its own worlds and arrays, which continues as this one would; it is not recorded."""
        return copy.deepcopy(self)

    def __copy__(self) -> Self:
        return self.clone()
