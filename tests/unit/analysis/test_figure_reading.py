"""Whether figures can be read: nothing printed over the data, plain numbers, panels that are filled."""

import polars as pl
import pytest
from matplotlib.figure import Figure

from hedon.analysis.figure_lineage import draw_lineages


@pytest.mark.parametrize("counts", [(50, 56), (20, 140), (3, 700), (1, 20_000)])
def test_numbers_of_lines_are_written_in_full(counts: tuple[int, int]) -> None:
    rows = {"seed": [1, 1], "step": [0, 1024], "weight": ["w_normal"] * 2, "lines": counts, "alive": counts}
    lines = pl.DataFrame(rows | {"line_mean": [0.0, 0.1], "living_mean": [0.0, 0.2]})
    shown = numbers(draw_lineages(lines, {"w_normal": "weight"}, {"w_normal": "green"}))
    assert len(shown) >= 2
    assert all(text.replace(",", "").replace(".", "").isdigit() for text in shown)


def numbers(figure: Figure) -> list[str]:
    """What is written at the ticks of the first y axis, within its limits."""
    figure.draw_without_rendering()
    axes = figure.axes[0]
    low, high = axes.get_ylim()
    ticks = [*axes.yaxis.get_major_ticks(), *axes.yaxis.get_minor_ticks()]
    return [t.label1.get_text() for t in ticks if low <= t.get_loc() <= high and t.label1.get_text()]
