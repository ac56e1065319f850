"""Where do lines go that only mutate? By the table of mutations that a seed of the paper's program has.

With `world.mutation_noise = "tabulated"`, as `--fidelity released` has it, the mutation of a birth depends on the seed,
the gene, the number of births in its window and the birth's index among them, and on nothing else. So the seed alone
says where a gene drifts. The example draws the births of many lines without selection and writes where they end:

    python examples/mutation_lines.py --seeds 1,2,3,4,5 --out docs/results/program/mutation-lines.csv
"""

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import polars as pl
from scipy import stats

from hedon._engine.random import philox
from hedon.config.layout import layouts
from hedon.config.load import load_config

BIRTHS = 18.0
"""Births of a window, mean of a Poisson law: 110 alive that live 6,200 steps each, 1,024 steps a window."""
MOST_BIRTHS = 60
"""Births of the fullest window that is drawn; with 18 in the mean, one in 10¹³ has more."""
GENERATIONS, LINES = 1500, 2000
TABLE = 11
"""The purpose of these draws in `engine/base/random.h`."""


def birth_table(seed: int, gene: int, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """The mutations of one gene by one seed.

    Args:
        seed: of the world.
        gene: its place in the genome, from 0.
        scale: of the Cauchy noise.

    Returns:
        The mutation of each birth that a window can have, and the share of all births that are this one; both (n,).
    """
    numbers = [(index, births) for births in range(1, MOST_BIRTHS + 1) for index in range(births)]
    key = (seed & 0xFFFFFFFF, seed >> 32)
    words = np.array([philox((gene, TABLE, index, births), key)[0] for index, births in numbers])
    share = stats.poisson.pmf([births for _, births in numbers], BIRTHS)
    return scale * np.tan(np.pi * ((words + 0.5) * 2.0**-32 - 0.5)), share / share.sum()


def lines(seeds: list[int]) -> Iterator[dict[str, object]]:
    """Of each seed and gene, the mean mutation of a birth, and where lines end that have one in each generation."""
    config = load_config("baseline", fidelity="released")
    (layout,) = layouts(config).values()
    genome = config.species["agent"].genome
    for seed in seeds:
        rng = np.random.default_rng(seed)
        for place, gene in enumerate(layout.genes):
            mutation, share = birth_table(seed, place, genome.mutation_scale)
            weight = rng.normal(gene.law.initial_mean, gene.law.initial_sd, LINES)
            for _ in range(GENERATIONS):
                step = rng.choice(mutation, LINES, p=share)
                weight = np.clip(weight + step, -genome.weight_limit, genome.weight_limit)
            yield {
                "seed": seed,
                "gene": gene.name,
                "mean_mutation": round(float(mutation @ share), 4),
                "median": round(float(np.median(weight)), 2),
                "share_positive": float((weight > 0).mean()),
            }


def main() -> None:
    """Writes the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1,2,3,4,5", help="of worlds, with commas")
    parser.add_argument("--out", type=Path, default=Path("mutation-lines.csv"), help="table that is written")
    asked = parser.parse_args()
    pl.DataFrame(list(lines([int(seed) for seed in asked.seeds.split(",")]))).write_csv(asked.out)
    print(f"wrote {asked.out}")


if __name__ == "__main__":
    main()
