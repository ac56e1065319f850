"""Copies of environments around a `VectorEnv`: they have worlds of their own, and go on as the original does."""

import copy
from typing import Self


class Copied:
    """Makes `clone` and `copy.copy` the same as `copy.deepcopy`, for classes that can be pickled."""

    def clone(self) -> Self:
        """A copy with worlds and arrays of its own, which goes on as this one does; it is not recorded."""
        return copy.deepcopy(self)

    def __copy__(self) -> Self:
        return self.clone()
