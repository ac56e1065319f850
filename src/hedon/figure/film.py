"""What does a world look like, frame by frame? Like the figure of the world, but walls and obstacles are drawn once."""

from collections.abc import Mapping

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from hedon.config.color import species_color
from hedon.figure.style import DOTS_PER_INCH, MUTED, styled, wrapped_legend
from hedon.figure.world import draw_agents, draw_foods, draw_obstacles, draw_ring, draw_walls
from hedon.record.snapshot import Snapshot

CAPTION = 34
"""Height of the line of text above the world [pixel]; a legend that does not fit into it gets its own lines."""
MARGIN = 0.012
"""Distance of the text from the left edge, in widths of the picture."""
GROWTH = 1.2
"""Factor by which the text may get longer as a world continues."""
CLOSE = 2.0
"""Width of the part of the arena shown around a followed agent, in lengths of its rays."""


class Film:
    """Draws moments of one world as pictures of the same size.

    Args:
        snapshot: Any moment of the world; it provides the arena.
        colors: Color of each food kind.
        width: Width of the pictures [pixel]; made even, as video formats require.
        top: Energy at and above which an agent has the darkest color.
        follow: ID of the agent that the view follows within the arena; None to show the whole arena.
    """

    def __init__(
        self, snapshot: Snapshot, colors: Mapping[str, str], width: int, top: float, follow: int | None = None
    ) -> None:
        low = snapshot.walls.reshape(-1, 2).min(axis=0)
        high = snapshot.walls.reshape(-1, 2).max(axis=0)
        self._colors, self._top, self._follow = colors, top, follow
        self._low, self._high, self._middle = low, high, (low + high) / 2
        self._rim = 0.015 * (high - low)
        self._span = high - low + 2 * self._rim
        if follow is not None:
            self._span = self._span * min(1.0, CLOSE * float(snapshot.ray_length.max()) / self._span[0])
        self.width = width // 2 * 2
        world_height = int(self.width * self._span[1] / self._span[0]) // 2 * 2
        with styled():
            self._figure = Figure(figsize=(self.width / DOTS_PER_INCH, 1), dpi=DOTS_PER_INCH)
            self._figure.set_facecolor("white")
            self._canvas = FigureCanvasAgg(self._figure)
            caption = self._words(snapshot)
            self._caption = self._figure.text(MARGIN, 1, caption, va="center", fontsize=8, color=MUTED)
            legend, header_height = self._legend(snapshot)
            self.height = world_height + header_height
            self._figure.set_size_inches(self.width / DOTS_PER_INCH, self.height / DOTS_PER_INCH)
            self._caption.set_y(1 - CAPTION / 2 / self.height)
            is_beside = header_height == CAPTION
            legend.set_loc("center right" if is_beside else "center left")
            offset = CAPTION / 2 if is_beside else (CAPTION + header_height) / 2
            legend.set_bbox_to_anchor((int(is_beside), 1 - offset / self.height))
            self._axes = self._figure.add_axes((0, 0, 1, 1 - header_height / self.height))
            self._axes.axis("off")
            draw_walls(self._axes, snapshot.walls)
            draw_obstacles(self._axes, snapshot.obstacles)
        self._fixed = len(self._axes.collections)

    def draw(self, snapshot: Snapshot) -> memoryview:
        """Draws one picture: four bytes for each pixel (red, green, blue, opacity), row by row from the top.

        The picture is valid until the next call.
        """
        for artist in list(self._axes.collections)[self._fixed :]:
            artist.remove()
        with styled():
            draw_foods(self._axes, snapshot, self._colors)
            if len(snapshot.x):
                draw_agents(self._axes, snapshot, self._top)
            followed = np.flatnonzero(snapshot.agent_id == self._follow) if self._follow is not None else []
            if len(followed):  # otherwise it is unborn or dead, and the view stays
                self._look_at(np.array([snapshot.x[followed[0]], snapshot.y[followed[0]]]))
                draw_ring(self._axes, snapshot, followed[0])
            (left, bottom), (right, top) = self._middle - self._span / 2, self._middle + self._span / 2
            self._axes.set(xlim=(left, right), ylim=(bottom, top))
            self._caption.set_text(self._words(snapshot))
            self._canvas.draw()
        return self._canvas.buffer_rgba()

    def _look_at(self, position: np.ndarray) -> None:
        """Centers the view on a place, as far as the arena allows."""
        half = self._span / 2 - self._rim
        self._middle = np.clip(position, self._low + half, self._high - half)

    def _words(self, snapshot: Snapshot) -> str:
        agent = "" if self._follow is None else f", agent {self._follow}"
        return f"seed {snapshot.seed}{agent}, step {snapshot.step:,}: {len(snapshot.x)} agents"

    def _legend(self, snapshot: Snapshot) -> tuple[Legend, int]:
        """The legend, not yet placed, and the height of everything above the world [pixel]."""
        marker_style = {"marker": "o", "linestyle": "", "markersize": 5}
        marks = [Line2D([], [], color=self._colors[kind], label=kind, **marker_style) for kind in snapshot.food_kinds]
        if len(snapshot.species_names) > 1:
            ring = {**marker_style, "markerfacecolor": "none", "markeredgewidth": 1.8}
            marks += [
                Line2D([], [], markeredgecolor=species_color(i), label=name, **ring)
                for i, name in enumerate(snapshot.species_names)
            ]
        legend = wrapped_legend(self._figure, marks, len(marks), fontsize=8, borderaxespad=0.4)
        legend.set_in_layout(False)
        size, caption_width = legend.get_window_extent(), GROWTH * self._caption.get_window_extent().width
        available_width = (1 - MARGIN) * self.width
        if size.height <= CAPTION and caption_width + size.width <= available_width:
            return legend, CAPTION
        self._caption.set_fontsize(8 * min(available_width / caption_width, 1))
        return legend, CAPTION + int(size.height) // 2 * 2
