"""Topics on whole worlds: genealogy and regimes."""

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import genealogy
from hedon.analysis.descent.lineage import coalescence, lines_through_time
from hedon.analysis.result import ResultTable, make_table, over_worlds
from hedon.analysis.world.record import Conditions, labels
from hedon.analysis.world.regime import REGIMES, regimes
from hedon.statistic.interval import AMOUNT, SHARE

_TIMES = 20  # number of times for the coalescence
_LINE_TIMES = 100  # number of times for counts of lines


def genealogy_topic(conditions: Conditions) -> list[ResultTable]:
    """Coalescence, founder families, and weights along the lines of the survivors."""
    rows, lines = [], []
    for worlds in conditions.values():
        for world in worlds:
            tree = genealogy(world.agents)
            if not tree.size:
                continue
            times = np.linspace(0, world.last_step, _TIMES + 1).round().astype(np.int64)
            rows += [labels(world) | coalescence(tree, int(step)) for step in times]
            steps = np.linspace(0, world.last_step, _LINE_TIMES + 1).round().astype(np.int64)
            line_table = lines_through_time(tree, world.agents, world.weight_names, steps)
            lines.append(line_table.select(*(pl.lit(v).alias(k) for k, v in labels(world).items()), pl.all()))
    over_time = make_table("genealogy_time", "Common descent over time, by world", rows, shown=False)
    last_rows = (
        over_time.rows.filter(pl.col("step") == pl.col("step").max().over("condition", "seed"))
        if rows
        else over_time.rows
    )
    quantities = {
        "families": "founder families left",
        "largest": "share of the largest family",
        "depth": "time to the common ancestor [step]",
    }
    summary = over_worlds(last_rows, (), quantities, {"families": AMOUNT, "largest": SHARE, "depth": AMOUNT})
    note = (
        "Of those alive at the end. The time to the common ancestor is known only in worlds in which a single family "
        "is left; elsewhere it is longer than the run."
    )
    return [
        make_table("genealogy", "Common descent of the living, means over worlds", summary, note),
        over_time,
        ResultTable(
            "lineage",
            "Weights along the lines of the survivors, by world",
            pl.concat(lines) if lines else pl.DataFrame(),
            shown=False,
        ),
    ]


def regime(conditions: Conditions) -> list[ResultTable]:
    """Regimes over time."""
    rows = [
        labels(world) | row
        for worlds in conditions.values()
        for world in worlds
        for row in regimes(world.population, world.config, species=world.species)
    ]
    over_time = make_table("regime_time", "Regimes over time, by world", rows, shown=False)
    shares = over_time.rows
    if rows:
        spent = shares.group_by("condition", "seed", maintain_order=True).agg(
            *(
                (pl.col("steps").filter(pl.col("regime") == name).sum() / pl.col("steps").sum()).alias(name)
                for name in REGIMES
            )
        )
        shares = spent
    note = (
        "Share of the steps; the rules are in docs/guide/analysis.md. A weight is selected in another way in each: "
        "starving worlds drift, food-limited ones compete, idle ones stand still."
    )
    summary = over_worlds(shares, (), {name: name for name in REGIMES}, SHARE)
    return [make_table("regime", "Share of the run in each regime, means over worlds", summary, note), over_time]
