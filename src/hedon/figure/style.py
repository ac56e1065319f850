"""The style of all figures: colors that color-blind readers can distinguish, light axes, and sizes for a page.

Colors: Okabe & Ito (2008), "Color universal design", and grays. `config.color` sets those of species, foods, weights.
"""

import io
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.ticker import LogLocator, NullFormatter

from hedon.config.color import food_colors as food_colors
from hedon.config.color import meal_colors as meal_colors
from hedon.config.problem import nearest
from hedon.error import ArgumentError
from hedon.record.atomic import write_atomically

INK = "#22303c"
MUTED = "#6b7884"
PALE = "#c9d1d8"
GRID = "#e9edf0"
BLUE, VERMILION, GREEN, ORANGE = "#0072b2", "#d55e00", "#009e73", "#e69f00"
SKY, PINK, YELLOW, VIOLET = "#56b4e9", "#cc79a7", "#f0e442", "#5e4fa2"

SEED_COLORS = (BLUE, VERMILION, GREEN, ORANGE, PINK, SKY, VIOLET, MUTED, YELLOW, INK)

STYLE: dict[Any, Any] = {
    "figure.facecolor": "white",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # ships with Matplotlib, so figures are the same everywhere
    "font.size": 9.0,
    "text.color": INK,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 8.0,
    "axes.titley": 1.0,  # no axes has ticks above it, so titles need not make room for them
    "axes.labelsize": 9.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": PALE,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "xtick.color": PALE,
    "ytick.color": PALE,
    "xtick.labelcolor": MUTED,
    "ytick.labelcolor": MUTED,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.major.size": 3.0,
    "ytick.major.size": 0.0,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "legend.handlelength": 1.4,
}
DOTS_PER_INCH = 160
COLUMN, PAGE = 3.5, 7.2
"""Usual widths of a column and of a page in journals [inch]."""
_LOG_NUMBERS = {10.0: (1, 2, 3, 5, 7), 300.0: (1, 2, 5)}  # by the ratio of a logarithmic axis's ends, up to which


@contextmanager
def styled() -> Iterator[None]:
    """Context in which figures are drawn in this style, whatever the caller's own Matplotlib settings."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(STYLE)
        yield


def new_figure(width: float, height: float) -> Figure:
    """An empty figure that belongs to no window and lays out its parts automatically.

    Args:
        width: Width of the figure [inch].
        height: Height of the figure [inch].
    """
    figure = Figure(figsize=(width, height), dpi=DOTS_PER_INCH)
    figure.set_layout_engine("constrained", wspace=0.05, hspace=0.05)
    FigureCanvasAgg(figure)
    return figure


def save_figure(figure: Figure, path: Path | str, width: float | None = None) -> Path:
    """Writes a figure in the format of the path's suffix: .svg, .pdf or .png. Returns the path.

    Args:
        figure: The figure to write.
        path: Path of the file; its folder must exist.
        width: Width for which the figure is laid out again, with letters of the same size [inch]; `COLUMN` and `PAGE`
            suit journals. None to keep its width.

    Raises:
        ArgumentError: The suffix is not one of these, or the width is not above 0.
        RecordError: The file cannot be written.
    """
    path = Path(path)
    form = path.suffix.removeprefix(".")
    if form not in FORMATS:
        suggestion = nearest(form, FORMATS)
        hint = f"; did you mean .{suggestion}?" if suggestion else ""
        raise ArgumentError(f"path = {path}: must end in {', '.join(f'.{suffix}' for suffix in FORMATS)}{hint}")
    if width is not None:
        if not (isinstance(width, int | float) and 0 < width < math.inf):
            raise ArgumentError(f"width = {width!r}: must be a number above 0, in inches")
        size = figure.get_size_inches()
        figure.set_size_inches(width, size[1] * width / size[0])
        figure.set_layout_engine("constrained", wspace=0.05, hspace=0.05)
    content = FORMATS[form](figure)
    write_atomically(path, lambda file: file.write(content))
    return path


def png_bytes(figure: Figure) -> bytes:
    """A figure as PNG."""
    buffer = io.BytesIO()
    with styled():
        _lay_out(figure)
        FigureCanvasAgg(figure).print_png(buffer)
    return buffer.getvalue()


def svg_bytes(figure: Figure) -> bytes:
    """A figure as SVG with letters as outlines; the bytes are the same each time and on every machine."""
    buffer = io.BytesIO()
    with styled():
        mpl.rcParams["svg.hashsalt"] = "hedon"
        _lay_out(figure)
        FigureCanvasSVG(figure).print_svg(buffer, metadata={"Date": None, "Creator": None})
        FigureCanvasAgg(figure)
    return buffer.getvalue()


def pdf_bytes(figure: Figure) -> bytes:
    """A figure as PDF with fonts embedded as TrueType, as publishers require; the bytes are the same each time."""
    from matplotlib.backends.backend_pdf import FigureCanvasPdf  # loads fontTools, which few reports need

    buffer = io.BytesIO()
    with styled():
        mpl.rcParams["pdf.fonttype"] = 42
        _lay_out(figure)
        FigureCanvasPdf(figure).print_pdf(buffer, metadata={"CreationDate": None})
        FigureCanvasAgg(figure)
    return buffer.getvalue()


FORMATS: dict[str, Callable[[Figure], bytes]] = {"svg": svg_bytes, "pdf": pdf_bytes, "png": png_bytes}
"""Functions that write a figure, by the suffix of the file."""


def _lay_out(figure: Figure) -> None:
    """Lays out the parts of a figure once for all files, since this takes as long as drawing them."""
    engine = figure.get_layout_engine()
    if engine is not None:
        for axes in figure.axes:
            for spine in axes.spines.values():
                spine.set_in_layout(False)  # axes and tick labels enclose it, and each asked places all ticks again
        engine.execute(figure)
        figure.set_layout_engine("none")


def seed_color(index: int) -> str:
    """The color of a world."""
    return SEED_COLORS[index % len(SEED_COLORS)]


def step_unit(last_step: float) -> tuple[float, str]:
    """A unit of time that keeps the numbers of an axis short: its size [step] and its name."""
    if last_step >= 2e6:
        return 1e6, "million steps"
    if last_step >= 2e3:
        return 1e3, "thousand steps"
    return 1.0, "steps"


def head(axes: Axes, title: str, remark: str = "") -> None:
    """Writes a title above axes with a remark below it in smaller type; nothing if both are empty."""
    lines = remark.count("\n") + 1 if remark else 0
    if title:
        axes.set_title(title, pad=8.0 + 11.0 * lines)
    if remark:
        placement = {"xy": (0, 1), "xycoords": "axes fraction", "xytext": (0, 6), "textcoords": "offset points"}
        axes.annotate(remark, **placement, va="bottom", color=MUTED, fontsize=8.0, linespacing=1.15)


def legend_above(axes: Axes, columns: int = 2) -> None:
    """Adds a legend to the axes of a panel, with room for it above everything drawn."""
    legend = axes.legend(loc="upper left", ncols=columns, borderaxespad=0.2)
    rows = -(-len(legend.get_texts()) // columns)
    low, high = axes.get_ylim()
    axes.set_ylim(top=high + (high - low) * (0.06 + 0.11 * rows))


def wrapped_legend(figure: Figure, handles: Sequence[Artist], columns: int, **options: Any) -> Legend:
    """Adds a legend to a figure, in as few rows as its width allows."""
    rows = -(-len(handles) // columns)
    while True:
        columns = -(-len(handles) // rows)
        legend = figure.legend(handles=handles, ncols=columns, **options)
        if columns == 1 or legend.get_window_extent().width <= figure.bbox.width:
            return legend
        legend.remove()
        rows += 1


def number_log_axis(axis: Axis) -> None:
    """Writes plain numbers on a logarithmic axis whose limits are set, a few per decade if there is room."""
    low, high = axis.get_view_interval()
    digits = next((numbers for ratio, numbers in _LOG_NUMBERS.items() if high < ratio * low), (1,))
    axis.set_major_locator(LogLocator(subs=digits))
    axis.set_major_formatter("{x:,.10g}")
    axis.set_minor_formatter(NullFormatter())


def say_empty(axes: Axes, text: str) -> None:
    """Writes in the middle of empty axes why there is nothing to show.

    Args:
        axes: Axes to write in.
        text: The reason.
    """
    axes.text(0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=MUTED)


def draw_message(text: str) -> Figure:
    """A figure that contains only a message, such as why there is nothing to show."""
    with styled():
        figure = new_figure(4.6, 1.4)
        axes = figure.add_subplot()
        axes.axis("off")
        say_empty(axes, text)
    return figure
