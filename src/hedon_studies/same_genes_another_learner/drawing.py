"""The figures of the study, one for each part.

`python -m hedon_studies.same_genes_another_learner.drawing docs/results/learner` draws them from the committed tables,
each next to its table.
"""

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hedon.figure import BLUE, GREEN, MUTED, ORANGE, PALE, draw_zero_line, new_figure, save_figure, styled
from hedon.statistic import mean_interval
from hedon_studies.same_genes_another_learner import behavior, decoy, evolution, landscape
from hedon_studies.same_genes_another_learner.landscape import FOOD, SIGHT

COLORS = {"slow": BLUE, "fast": ORANGE}
"""Color of each arm of part B, as a learner or as the origin of genes."""
GENE_COLORS = {"sight": GREEN, "food": BLUE}
SHORT, TALL = (5.6, 3.2), (5.6, 4.4)
"""Sizes of figures [inch]."""


def draw_slopes(slopes: Mapping[str, pl.DataFrame]) -> Figure:
    """Part A: the slopes of food intake on the weights of food and its sight, a cross for each learner.

    Args:
        slopes: Rows from `landscape.slopes`, by arm.
    """
    with styled():
        figure = new_figure(*TALL)
        axes = figure.subplots()
        for arm, worlds in slopes.items():
            bounds = [mean_interval(worlds[gene].to_list()) for gene in (FOOD, SIGHT)]
            x, y = (np.array([each.low, each.mean, each.high], np.float64) for each in bounds)  # None becomes NaN
            axes.plot(x, np.full(3, y[1]), color=BLUE)
            axes.plot(np.full(3, x[1]), y, color=BLUE)
            axes.plot(x[1], y[1], "o", color=BLUE, markersize=5)
            axes.annotate(arm, (x[1], y[1]), xytext=(6, 5), textcoords="offset points")
        _draw_diagonal(axes)
        axes.margins(0.15)
        axes.set_xlabel("slope on the weight of food")
        axes.set_ylabel("slope on the weight of its sight")
    return figure


def draw_ends(worlds: pl.DataFrame) -> Figure:
    """Part B: the mean weights of food and its sight at the end of each world, and the mean direction of each arm.

    Args:
        worlds: Rows of worlds from `evolution.measure`.
    """
    with styled():
        figure = new_figure(*TALL)
        axes = figure.subplots()
        for arm, color in COLORS.items():
            ends = worlds.filter(pl.col("arm") == arm)
            axes.plot(ends[FOOD], ends[SIGHT], "o", color=color, markersize=4, label=f"{arm} learner")
            angle = np.arctan2(ends[SIGHT], ends[FOOD]).mean()
            axes.axline((0, 0), slope=float(np.tan(angle)), color=color, linewidth=0.8)
        _draw_diagonal(axes)
        axes.set_xlabel("weight of food")
        axes.set_ylabel("weight of its sight")
        axes.legend(loc="upper left")
    return figure


def draw_shares(worlds: pl.DataFrame) -> Figure:
    """Part C: the share of the genes that evolved under the fast learner, at the end of each contest.

    Args:
        worlds: Rows of `worlds.csv`.
    """
    with styled():
        figure = new_figure(*SHORT)
        axes = figure.subplots()
        axes.axhline(0.5, color=MUTED, linestyle="--", linewidth=0.8)
        groups = {f"{learner} learner": worlds.filter(pl.col("treatment") == learner)["share"] for learner in COLORS}
        _draw_groups(axes, groups, list(COLORS.values()))
        axes.set_ylabel("share of the fast-evolved at the end")
    return figure


def draw_losses(worlds: pl.DataFrame) -> Figure:
    """Part D: the share of their intake that agents lose to decoys, by learner and genes.

    Args:
        worlds: Rows of `worlds.csv`.
    """
    loss = decoy.losses(worlds)
    order = [(genes, learner) for learner in COLORS for genes in COLORS]
    with styled():
        figure = new_figure(*SHORT)
        axes = figure.subplots()
        draw_zero_line(axes)
        groups = {f"{genes}-evolved,\n{learner} learner": loss[genes, learner] for genes, learner in order}
        _draw_groups(axes, groups, [COLORS[genes] for genes, _ in order])
        axes.set_ylabel("share of intake lost to decoys")
    return figure


def draw_learning(rows: pl.DataFrame) -> Figure:
    """Mechanism: how strongly the weights of sight and food shape the intake of agents, by their age.

    Args:
        rows: Rows from `behavior.world_rows` of all worlds.
    """
    intake = rows.filter(pl.col("measure") == "intake")
    with styled():
        figure = new_figure(7.2, 2.8)
        panels = figure.subplots(1, len(behavior.LEARNERS), sharey=True)
        for axes, learner in zip(panels, behavior.LEARNERS, strict=True):
            steps = intake.filter(pl.col("learner") == learner).sort("step").partition_by("step", as_dict=True)
            ages = [float(step) / 1000 for (step,) in steps]
            for name, gene in behavior.GENES.items():
                color = GENE_COLORS[name]
                bounds = [mean_interval((1000 * worlds[gene]).to_list()) for worlds in steps.values()]
                mean, low, high = np.array([[each.mean, each.low, each.high] for each in bounds], np.float64).T
                axes.fill_between(ages, low, high, color=color, alpha=0.2, linewidth=0)
                axes.plot(ages, mean, color=color, label=f"weight of {name}")
            draw_zero_line(axes)
            axes.set_title(f"{learner} learner")
            axes.set_xlabel("age [1,000 steps]")
        panels[0].set_ylabel("slope of intake\n[foods per 1,000 steps]")
        panels[0].legend(loc="upper left")
    return figure


def _draw_diagonal(axes: Axes) -> None:
    """The line on which sight counts as much as food."""
    axes.axline((0, 0), slope=1, color=MUTED, linestyle="--", linewidth=0.8)


def _draw_groups(axes: Axes, groups: Mapping[str, Any], colors: Sequence[str]) -> None:
    """Each value as a dot, and the mean of each group with its 95 % interval."""
    rng = np.random.default_rng(1)  # spreads the dots
    for x, (values, color) in enumerate(zip(groups.values(), colors, strict=True)):
        axes.plot(x + rng.uniform(-0.2, 0.2, len(values)), values, "o", color=PALE, markersize=3)
        bounds = mean_interval(list(values))
        low, mean, high = np.array([bounds.low, bounds.mean, bounds.high], np.float64)  # None becomes NaN
        axes.plot([x, x], [low, high], color=color, linewidth=2)
        axes.plot(x, mean, "o", color=color, markersize=6)
    axes.set_xticks(range(len(groups)), list(groups))
    axes.set_xlim(-0.6, len(groups) - 0.4)


def main(arguments: Sequence[str] | None = None) -> None:
    """Draws the figures of the committed tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path, help="docs/results/learner")
    folder = parser.parse_args(arguments).folder
    tables = {"evolution": draw_ends, "swap": draw_shares, "decoy": draw_losses}
    rows = folder / "behavior" / behavior.ROWS
    landscapes = [folder / name for name in (landscape.FOUNDERS, landscape.OUTCOMES)]
    evolution.require_files(parser, [*landscapes, *(folder / part / evolution.WORLDS for part in tables), rows])
    arms = landscape.read_arms(folder)
    slopes = {arm: landscape.slopes(founders, "food") for arm, founders in arms.items()}
    save_figure(draw_slopes(slopes), folder / "landscape.svg")
    for part, draw in tables.items():
        save_figure(draw(pl.read_csv(folder / part / evolution.WORLDS)), folder / part / f"{part}.svg")
    save_figure(draw_learning(pl.read_parquet(rows)), rows.with_name("behavior.svg"))


if __name__ == "__main__":
    main()
