"""What objects with worlds have in common when they are copied: the copy has worlds of its own, and goes on alike."""

import copy
from typing import Any, Self


class Cloned:
    """Makes `copy.copy` and `copy.deepcopy` the same as `clone`, for objects that hold worlds themselves.

    A copy makes anew what it was made with, `_own`, and takes over what a subclass or a user has added.
    """

    _own: set[str]

    def clone(self) -> Self:
        """A copy with worlds of its own, which goes on as this one does; `copy.copy` and `deepcopy` give the same."""
        raise NotImplementedError

    def _keep_own(self, *later: str) -> None:
        """Marks the attributes that there are now as made anew by copies, and those that come later."""
        self._own = {*vars(self), "_own", *later}

    def _added(self) -> dict[str, Any]:
        """Attributes of a subclass, or of a user."""
        return {name: value for name, value in vars(self).items() if name not in self._own}

    def __copy__(self) -> Self:
        return self.clone()

    def __deepcopy__(self, memo: Any) -> Self:
        return self.clone()


class Copied:
    """Makes `clone` and `copy.copy` the same as `copy.deepcopy`, for objects around those that hold worlds."""

    def clone(self) -> Self:
        """A copy with worlds and arrays of its own, which goes on as this one does; it is not recorded."""
        return copy.deepcopy(self)

    def __copy__(self) -> Self:
        return self.clone()
