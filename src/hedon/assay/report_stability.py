"""The tables, the summary and the figure of a stability assay."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.report import assay_answer, world_line, world_table
from hedon.assay.sample import Sample
from hedon.assay.stability import VERDICTS, Stability, judge, mean_over_worlds, measure_stability
from hedon.figure.named import NamedFigure
from hedon.figure.style import BLUE, MUTED, ORANGE, PALE, head, new_figure, step_unit, styled
from hedon.report.answer import FACTORS, Answer

_COLORS = (BLUE, ORANGE)


def stability_answer(points: Sequence[str], samples: Sequence[Sample]) -> Answer:
    """The results of finished worlds on the stability of the points at which they started.

    Args:
        points: The points, as given on the command line.
        samples: The worlds that started at each point.
    """
    starts = judge([measure_stability(sample) for sample in samples])
    content = [
        {
            "run": start.name,
            "point": dict(start.point),
            "worlds": start.worlds,
            "extinct": start.extinct,
            "generations": start.generations,
            "verdicts": {name: start.courses[name].verdict for name in start.point},
        }
        for start in starts
    ]
    lines = [
        f"- `{stability.name}`: {stability.generations:.0f} generations, {stability.extinct} worlds died out"
        for stability in starts
    ]
    intro = "\n".join([f"Evolution from {', and from '.join(points)}. {world_line(samples)}", "", *lines])
    figure = NamedFigure("stability", "Where do weights go?", draw_stability(starts))
    summary = {"starts": content, FACTORS: ["run"]}
    return assay_answer("stability", samples, summary, stability_tables(starts), intro, figure)


def stability_tables(starts: Sequence[Stability]) -> list[ResultTable]:
    """Tables of the end and the course of each weight."""
    rows, courses, worlds = [], [], []
    for start in starts:
        for i, seed in enumerate(start.seeds):
            ends = {name.removeprefix("w_"): float(start.courses[name].mean[i, -1]) for name in start.point}
            worlds.append({"run": start.name, "seed": seed, **ends})
        neutral = [course for name, course in start.courses.items() if name.startswith("neutral_")]
        for name in start.point:
            course = start.courses[name]
            rows.append(
                {
                    "run": start.name,
                    "gene": name.removeprefix("w_"),
                    "start": course.start,
                    "end": course.end.mean,
                    "low": course.end.low,
                    "high": course.end.high,
                    "drift from": float(course.null[0, -1]),
                    "drift to": float(course.null[1, -1]),
                    "score": course.score,
                    "p": course.p,
                    "p held": course.p_held,
                    "p Holm": course.p_holm,
                    "p held Holm": course.p_held_holm,
                    "verdict": course.verdict,
                }
            )
        if neutral:
            leaving_count = sum(course.verdict == "leaves" for course in neutral)
            ends = [course.end.mean for course in neutral if course.end.mean is not None]
            rows.append(
                {
                    "run": start.name,
                    "gene": f"{len(neutral)} neutral",
                    "end": float(np.mean(ends)) if ends else None,
                    "verdict": f"{leaving_count} leave",
                }
            )
        for name, course in start.courses.items():
            is_recorded = np.isfinite(course.mean).any(axis=0)
            for i in np.flatnonzero(is_recorded):
                mean, (low, high) = float(np.nanmean(course.mean[:, i])), course.null[:, i].tolist()
                courses.append(
                    {
                        "run": start.name,
                        "gene": name.removeprefix("w_"),
                        "step": int(course.step[i]),
                        "mean": mean,
                        "drift_low": low,
                        "drift_high": high,
                    }
                )
    meanings = "; ".join(f"{verdict}: {meaning}" for verdict, meaning in VERDICTS.items())
    note = (
        "Means over worlds, with intervals over worlds. drift from and to: where 95 % of neutral genes end that begin "
        f"likewise and mutate along the same pedigrees. {meanings} (p below 0.05)."
    )
    return [
        make_table("start", "Where the weights went", rows, note),
        make_table("course", "Mean weights over time", courses, shown=False),
        world_table(worlds),
    ]


def draw_stability(starts: Sequence[Stability]) -> Figure:
    """Draws a panel per reward weight: each world, the mean, and the band of neutral genes with the same start."""
    genes = list(starts[0].point)
    with styled():
        figure = new_figure(4.4 * len(genes), 3.4)
        panels = figure.subplots(1, len(genes), squeeze=False)[0]
        for axes, gene in zip(panels, genes, strict=True):
            unit, name = step_unit(float(starts[0].courses[gene].step[-1]))
            for start, color in zip(starts, _COLORS, strict=False):
                course = start.courses[gene]
                step = course.step / unit
                axes.fill_between(step, *course.null, color=PALE, alpha=0.5, linewidth=0)
                axes.plot(step, course.mean.T, color=color, linewidth=0.7, alpha=0.6)
                axes.plot(
                    step,
                    mean_over_worlds(course.mean),
                    color=color,
                    linewidth=2.0,
                    label=f"{start.name}: {course.verdict}",
                )
            axes.axhline(0.0, color=MUTED, linewidth=0.8)
            axes.set_xlabel(name)
            axes.legend(loc="best")
            head(axes, f"Weight of {gene.removeprefix('w_')}", "thin: worlds; thick: mean; gray: neutral genes")
    return figure
