"""A window with pictures of a world that a program drives."""

import numpy as np
from numpy.typing import NDArray

from hedon.error import ArgumentError

PICTURES_PER_SECOND = 30


class Window:
    """A window that shows pictures one after another, at most thirty per second.

    Raises:
        ArgumentError: pygame is not installed.
    """

    def __init__(self) -> None:
        try:
            import pygame
        except ImportError:
            raise ArgumentError('render_mode = "human": needs pygame: pip install "hedon[window]"') from None
        self._pygame = pygame
        self._clock = pygame.time.Clock()
        self._surface: pygame.Surface | None = None
        self.closed = False
        """Whether the user closed it; it then shows nothing more."""

    def show(self, picture: NDArray[np.uint8]) -> None:
        """Shows a picture, after a pause if the last one was shown a moment ago.

        Args:
            picture: (height, width, 3), red, green, blue.
        """
        if self.closed:
            return
        if self._surface is None:
            self._pygame.display.init()
            self._pygame.display.set_caption("hedon")
            self._surface = self._pygame.display.set_mode((picture.shape[1], picture.shape[0]))
        self._pygame.surfarray.blit_array(self._surface, picture.swapaxes(0, 1))
        self._pygame.display.flip()
        self._clock.tick(PICTURES_PER_SECOND)
        if any(event.type == self._pygame.QUIT for event in self._pygame.event.get()):
            self.close()

    def close(self) -> None:
        """Closes the window."""
        self.closed = True
        if self._surface is not None:
            self._surface = None
            self._pygame.display.quit()
