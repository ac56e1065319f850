"""A topic on causes: mutation as a treatment that births assign at random."""

import itertools

import numpy as np

from hedon.analysis.gene.mutation import CLIP, OUTCOMES, SCALES, births_of, mutation_effects, pool
from hedon.analysis.result import ResultTable, make_table
from hedon.analysis.world.record import SEED, Conditions


def mutation_topic(conditions: Conditions) -> list[ResultTable]:
    """Effects of a child's own mutation on its life, among siblings."""
    rows, summary = [], []
    for condition, worlds in conditions.items():
        rng = np.random.default_rng([SEED, len(worlds)])
        effects = mutation_effects(pool([births_of(world) for world in worlds]), worlds[0].weight_names, rng)
        rows += [{"condition": condition} | effect for effect in effects]
        for outcome, scale in itertools.product(OUTCOMES, SCALES):
            matching = [effect for effect in effects if (effect["outcome"], effect["scale"]) == (outcome, scale)]
            neutral = [effect for effect in matching if effect["weight"].startswith("neutral_")]
            summary += [{"condition": condition} | effect for effect in matching if effect not in neutral]
            if neutral:
                significant = sum(effect["p"] < 0.05 for effect in neutral)
                summary.append(
                    {
                        "condition": condition,
                        "outcome": outcome,
                        "weight": f"{len(neutral)} neutral: {significant} with p < 0.05",
                        "scale": scale,
                    }
                )
    note = (
        "Children of one parent are compared, so parent and place cannot matter: what differs is their own mutation. "
        f"effect: change of the outcome over its mean, per unit of the weight (clipped at ± {CLIP:g}), or per standard "
        "deviation of the rank. Neutral genes do nothing, and show what chance gives. Intervals: bootstrap over "
        "parents."
    )
    return [
        make_table("mutation", "What mutations do to the lives of children", summary, note),
        make_table("mutation_gene", "What mutations of each gene do, neutral genes too", rows, shown=False),
    ]
