"""The tables, the JSON summary, the figure and the page of a contest of two groups."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.contest import Contest, estimate, sample_lines
from hedon.assay.report import assay_answer, finite_row, world_line, world_table
from hedon.assay.sample import Sample
from hedon.figure.named import NamedFigure
from hedon.figure.style import BLUE, INK, MUTED, PALE, head, new_figure, step_unit, styled
from hedon.report.answer import Answer
from hedon.text import p_phrase

_SHOWN_TIMES = 10


def contest_answer(kind: str, groups: tuple[str, str], species: str, samples: Sequence[Sample]) -> Answer:
    """The results of finished worlds with two groups.

    Raises:
        AssayError: There is no table of founders, or its groups cannot be distinguished.
    """
    (sample,) = samples
    contest = estimate(groups, sample_lines(sample, groups, species), sample.steps)
    result = contest.result
    content = {"groups": list(groups), "selection": vars(result.selection), "share": vars(result.end)}
    content |= {"start": result.start, "p": contest.p}
    content |= {name: getattr(result, name) for name in ("fixed", "lost", "generations")}
    intro = f"{groups[0]} against {groups[1]}, without mutation. {world_line(samples)}"
    figure = NamedFigure(kind, "Which group grows?", draw_contest(contest))
    return assay_answer(kind, samples, content, contest_tables(contest), intro, figure)


def contest_tables(contest: Contest) -> list[ResultTable]:
    """Tables of the result, the course of the ratio, and each world."""
    (first, second), result = contest.groups, contest.result
    rows = [
        {"quantity": "selection coefficient per generation", **vars(result.selection), "p": contest.p},
        {"quantity": f"share of {first} at the end", **vars(result.end)},
        {"quantity": f"share of {first} at the start", "value": result.start},
        {"quantity": "generations", "value": result.generations},
        {"quantity": f"worlds with {first} alone", "value": result.fixed},
        {"quantity": f"worlds with {second} alone", "value": result.lost},
        {"quantity": "worlds", "value": result.worlds},
    ]
    note = (
        f"Of {first} against {second}: above 0, {first} grows faster. Its interval comes from how the share wanders "
        "within worlds. p: the chance of so large a change of the share if both are alike; the founders of a world "
        "exchange their groups."
    )
    step, ratio, (low, high) = contest.course()
    ratio_rows = [
        finite_row({"step": int(step[i]), "value": float(ratio[i]), "low": float(low[i]), "high": float(high[i])})
        for i in np.linspace(0, len(step) - 1, _SHOWN_TIMES + 1).round().astype(int)
    ]
    worlds = [
        {
            "seed": lines.seed,
            first: int(lines.count[-1, 0]),
            second: int(lines.count[-1, 1]),
            "generations": float(lines.generation[-1]),
            "last step": int(lines.step[-1]),
            "share": float(lines.share[-1]),
            "selection": lines.selection,
        }
        for lines in contest.lines
    ]
    return [
        make_table("contest", f"{first} against {second}", rows, note),
        make_table("ratio", f"Log ratio of the numbers of {first} and {second}, all worlds together", ratio_rows),
        world_table(worlds),
    ]


def draw_contest(contest: Contest) -> Figure:
    """Draws the share of the first group over time in each world, and the log ratio of all worlds together."""
    unit, name = step_unit(contest.steps)
    step, ratio, (low, high) = contest.course()
    with styled():
        figure = new_figure(8.0, 3.4)
        left, right = figure.subplots(1, 2)
        for lines in contest.lines:
            left.plot(lines.step / unit, lines.share, color=PALE, linewidth=0.9)
        left.plot(step / unit, _mean_share(contest), color=BLUE, linewidth=1.8)
        left.axhline(contest.result.start, color=MUTED, linewidth=0.8, linestyle="--")
        left.set_ylim(0, 1)
        left.set_xlabel(name)
        head(left, f"Share of {contest.groups[0]}", "gray: worlds; blue: their mean; dashed: at the start")
        is_finite = np.isfinite(ratio)
        right.plot(step[is_finite] / unit, ratio[is_finite], color=INK, linewidth=1.6)
        right.fill_between(step / unit, low, high, color=PALE, alpha=0.6, where=np.isfinite(low) & np.isfinite(high))
        right.axhline(0.0, color=MUTED, linewidth=0.8)
        right.set_xlabel(name)
        selection = contest.result.selection
        head(
            right,
            "Log ratio",
            f"s = {selection.value:.3g} per generation, {selection.low:.3g} to {selection.high:.3g}, "
            f"{p_phrase(contest.p)}",
        )
    return figure


def _mean_share(contest: Contest) -> np.ndarray:
    shares = np.full((len(contest.lines), len(contest.course()[0])), np.nan)
    for row, lines in zip(shares, contest.lines, strict=True):
        row[: len(lines.step)] = lines.share
    return np.nanmean(shares, axis=0)
