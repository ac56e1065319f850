"""The tables, the JSON summary and the figure of fitness against frequency."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.contest import sample_lines
from hedon.assay.frequency import VERDICTS, Frequency, estimate_frequency
from hedon.assay.report import assay_answer, finite_row, world_line, world_table
from hedon.assay.sample import Sample
from hedon.figure.named import NamedFigure
from hedon.figure.style import BLUE, INK, MUTED, PALE, head, new_figure, styled
from hedon.report.answer import FACTORS, Answer

START = "share at the start"


def frequency_answer(
    groups: tuple[str, str], species: str, shares: Sequence[float], samples: Sequence[Sample]
) -> Answer:
    """The results of finished worlds with two groups, with one sample for each starting share of the first.

    Raises:
        AssayError: There is no table of founders, or its groups cannot be distinguished.
    """
    pairs = zip(shares, samples, strict=True)
    lines_by_share = {share: sample_lines(each, groups, species) for share, each in pairs}
    frequency = estimate_frequency(groups, lines_by_share)
    content = {"groups": list(groups), "verdict": frequency.verdict, FACTORS: [START]}
    content |= {"slope": vars(frequency.slope), "crossing": vars(frequency.crossing)}
    intro = f"{groups[0]} against {groups[1]} from several shares, without mutation. {world_line(samples)}"
    worlds = [
        {START: share, "seed": lines.seed, "share": float(lines.share[-1]), "selection": lines.selection}
        for share, each in lines_by_share.items()
        for lines in each
    ]
    tables = [*frequency_tables(frequency), world_table(worlds)]
    figure = NamedFigure("frequency", "Does growth depend on the share?", draw_frequency(frequency))
    return assay_answer("frequency", samples, content, tables, intro, figure)


def frequency_tables(found: Frequency) -> list[ResultTable]:
    """Tables of slope and crossing, and of the selection coefficient at each share."""
    first, second = found.groups
    rows = [
        {"quantity": "slope of the selection coefficient over the share", **vars(found.slope)},
        {"quantity": f"share of {first} at which neither grows", **vars(found.crossing)},
    ]
    note = (
        f"{found.verdict}: {VERDICTS[found.verdict]}. A slope below 0 favors the rarer group. Without a value of the "
        "crossing, the line does not cross 0 between the shares that worlds began with; its bounds are where the "
        "line's interval has 0. Intervals: bootstrap over seeds."
    )
    shares = [
        {
            START: share_result.start,
            "mean share": share_result.share,
            "s": share_result.selection.value,
            "low": share_result.selection.low,
            "high": share_result.selection.high,
            "share at the end": share_result.end.value,
            "worlds": share_result.worlds,
            "died out": share_result.extinct,
            f"{first} alone": share_result.fixed,
            f"{second} alone": share_result.lost,
            "generations": share_result.generations,
        }
        for share_result in found.shares
    ]
    result = f"{first} against {second}, by the share of {first}"
    title = f"Selection coefficient of {first} per generation, by its share among the founders"
    return [
        make_table("frequency", result, [finite_row(row) for row in rows], note),
        make_table("frequency_share", title, [finite_row(row) for row in shares]),
    ]


def draw_frequency(found: Frequency) -> Figure:
    """Draws the selection coefficient at each share with its interval, the fitted line, and the share where it is 0."""
    share, line, low, high = found.line
    with styled():
        figure = new_figure(5.6, 3.6)
        axes = figure.subplots()
        axes.axhline(0.0, color=MUTED, linewidth=0.8)
        axes.fill_between(share, low, high, color=PALE, alpha=0.6, where=np.isfinite(low) & np.isfinite(high))
        axes.plot(share, line, color=INK, linewidth=1.4)
        for share_result in found.shares:
            bounds = (share_result.selection.low, share_result.selection.high)
            axes.plot((share_result.share, share_result.share), bounds, color=BLUE, linewidth=1.4)
            axes.plot(share_result.share, share_result.selection.value, "o", color=BLUE, markersize=5)
        if np.isfinite(found.crossing.value):
            axes.axvline(found.crossing.value, color=MUTED, linewidth=0.8, linestyle="--")
        axes.set_xlim(0, 1)
        axes.set_xlabel(f"mean share of {found.groups[0]}")
        axes.set_ylabel("selection coefficient per generation")
        slope, crossing = found.slope, found.crossing
        crosses = f"crosses 0 at {crossing.value:.2g}" if np.isfinite(crossing.value) else "does not cross 0"
        head(
            axes,
            f"Fitness of {found.groups[0]} against its frequency",
            f"slope {slope.value:.3g}, {slope.low:.3g} to {slope.high:.3g}; {crosses}: {found.verdict}",
        )
    return figure
