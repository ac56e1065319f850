"""The tables and the figure of a contingency assay, which compares futures with fresh worlds."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from hedon.analysis.result import ResultTable, make_table
from hedon.assay.contingency import Divergence, Futures, Overlap, diverged, lineages_since, measures_of, overlaps
from hedon.assay.report import assay_answer, world_line, world_table
from hedon.assay.sample import Sample
from hedon.assay.stability import ALPHA
from hedon.figure.named import NamedFigure
from hedon.figure.style import MUTED, SEED_COLORS, head, new_figure, styled
from hedon.report.answer import CAUTIONS, FACTORS, Answer

PAST = "past"
FRESH = "fresh"
CAUTION = (
    "Worlds with one past are futures of one world: intervals and tests are about its futures, not about independent "
    "worlds."
)


def contingency_answer(samples: Sequence[Sample]) -> Answer:
    """The results of a contingency assay; the first sample contains the fresh worlds, the others futures."""
    fresh = samples[0]
    futures: list[Futures] = [(sample.demand.past, sample) for sample in samples if sample.demand.past is not None]
    divergences, shared = diverged(fresh, futures), overlaps(futures)
    content = {
        FACTORS: [PAST],
        CAUTIONS: [CAUTION],
        "pasts": [{"seed": past.seed, "step": past.step} for past, _ in futures],
    }
    intro = (
        "Futures of one world begin with the same agents and differ by chance alone from then on. "
        f"{world_line(samples)}"
    )
    tables = [*contingency_tables(divergences, shared), world_table(_world_rows(fresh, futures))]
    figure = NamedFigure("contingency", "How much was settled, and when?", draw_contingency(divergences))
    return assay_answer("contingency", samples, content, tables, intro, figure)


def contingency_tables(found: Sequence[Divergence], shared: Sequence[Overlap]) -> list[ResultTable]:
    """Tables of how far apart futures end, and of whether they have the same ancestors."""
    rows = [
        {
            "step": each.step,
            "generation": each.generation,
            "measure": each.measure,
            "apart": each.apart,
            "fresh apart": each.fresh_apart,
            "ratio": each.ratio,
            "low": each.low,
            "high": each.high,
            "p": each.p_holm,
            "result": verdict(each),
            "futures": each.futures,
            "fresh": each.fresh,
        }
        for each in found
    ]
    note = (
        "Step and generation: when futures part. Apart: mean distance between two futures of one world at the end; "
        "fresh apart: between two fresh worlds; of logarithms for measures above 0. A ratio near 0: the outcome was "
        "settled by then; near 1: everything was open. Intervals (jackknife) are about these pasts; p: Holm over "
        "all rows. Neutral genes show what drift and shared descent alone give."
    )
    lineages = [
        {
            "past": each.past,
            "step": each.step,
            **({"species": each.species} if len({other.species for other in shared}) > 1 else {}),
            "agents then": each.agents,
            "descendants in all": each.everywhere,
            "in none": each.nowhere,
            "overlap": each.overlap,
            "by chance": each.chance,
            "p": each.p_holm,
        }
        for each in shared
    ]
    overlap_note = (
        "Overlap: the part of two futures' living that descends from the same agents. By chance: the same if the "
        "agents of that step were interchangeable. Permutation test, Holm over all rows."
    )
    return [
        make_table("contingency", "How far apart the worlds end", rows, note),
        make_table("contingency_lineage", "Do the same agents leave descendants?", lineages, overlap_note),
    ]


def verdict(each: Divergence) -> str:
    """The conclusion from the interval of the ratio, given the corrected p value."""
    if not each.p_holm < ALPHA:
        return "cannot tell" if np.isnan(each.p_holm) else "not shown"
    return "partly settled" if each.ratio < 1 else "futures lie further apart"


def draw_contingency(found: Sequence[Divergence]) -> Figure:
    """Draws the ratio of each measure with its interval, for each step from which there are futures."""
    steps = sorted({result.step for result in found})
    measures = list(dict.fromkeys(result.measure for result in found))[::-1]
    with styled():
        figure = new_figure(5.6, 1.2 + 0.32 * len(measures))
        axes = figure.subplots()
        axes.axvline(1.0, color=MUTED, linewidth=0.8, linestyle="--")
        for i, step in enumerate(steps):
            step_rows = [result for result in found if result.step == step and np.isfinite(result.ratio)]
            color, shift = SEED_COLORS[i % len(SEED_COLORS)], 0.22 * ((len(steps) - 1) / 2 - i)
            rows = [measures.index(result.measure) + shift for result in step_rows]
            axes.hlines(
                rows,
                [result.low for result in step_rows],
                [result.high for result in step_rows],
                color=color,
                linewidth=1.4,
            )
            axes.plot(
                [result.ratio for result in step_rows],
                rows,
                "o",
                color=color,
                markersize=4,
                label=_when(found, step),
            )
        axes.set_xscale("log")
        axes.set_yticks(range(len(measures)), measures)
        axes.set_xlabel("distance of two futures / distance of two fresh worlds, at the end")
        if len(steps) > 1:
            axes.legend()
        settled_count = sum(verdict(result) == "partly settled" for result in found)
        head(
            axes,
            "How much was settled, and when",
            f"1: nothing was; {settled_count} of {len(found)} are shown to be lower",
        )
    return figure


def _when(divergences: Sequence[Divergence], step: int) -> str:
    generation = next(result.generation for result in divergences if result.step == step)
    return f"futures part at step {step:,} (generation {generation:.1f})"


def _world_rows(fresh: Sample, futures: Sequence[Futures]) -> list[dict[str, Any]]:
    """A row for each world; the column of the past groups the futures of one world."""
    groups = [(FRESH, None, fresh), *((f"seed {past.seed} at {past.step}", past.step, each) for past, each in futures)]
    rows: dict[tuple[str, int], dict[str, Any]] = {}
    for name, step, sample in groups:
        for world in sample.worlds:
            row = rows.setdefault((name, world.seed), {PAST: name, "seed": world.seed})
            prefix = f"{world.species}." if len(world.config.species) > 1 else ""
            measures = [each for group in measures_of(world).values() for each in group]
            measures += [lineages_since(step)] if step is not None else []
            row |= {f"{prefix}{each.name}": each.value(world) for each in measures}
    return list(rows.values())
