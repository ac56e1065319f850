"""Where do lines go that only mutate? By the table of mutations that a seed of the paper's program has.

With `world.mutation_noise = "tabulated"`, as `--fidelity released` has it, the mutation of a birth depends on the seed,
the gene, the number of births in its window and the birth's index among them, and on nothing else. So the seed alone
says where a gene drifts. The example draws the births of many lines without selection and writes where they end, and
beside them where the genes of a run are, and how they came there:

    python examples/mutation_lines.py --seeds 1,2,3,4,5 --out docs/results/program
    python examples/mutation_lines.py --run runs/paper --out docs/results/program/full
"""

import argparse
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import polars as pl
from scipy import stats

from hedon._engine.random import philox
from hedon.analysis import last_agents
from hedon.config.layout import layouts
from hedon.config.load import load_config
from hedon.record.error import RecordError
from hedon.record.reader import Run, open_run

BIRTHS = 18.0
"""Births of a window, mean of a Poisson law: 110 alive that live 6,200 steps each, 1,024 steps a window."""
MOST_BIRTHS = 60
"""Births of the fullest window that is drawn; with 18 in the mean, one in 10¹³ has more."""
GENERATIONS, LINES = 1500, 2000
STRETCH = 512_000
"""Steps of a stretch of which means are told: 500 windows."""
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


def lines(seeds: Iterable[int]) -> Iterator[dict[str, object]]:
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


def ends(run: Run) -> pl.DataFrame:
    """Of each seed and gene of a run, the mean weight of the 5,000 agents born last, and whether lines end on its side.

    Args:
        run: whose worlds are read, as far as they are recorded.
    """
    found = pl.DataFrame(list(lines(run.manifest.seeds)))
    newest = last_agents(run.agents(skip_damaged=True))
    mean = {
        (seed, gene): float(agents[gene].to_numpy().mean(dtype=np.float64))
        for (seed,), agents in newest.group_by("seed")
        for gene in run.weight_names
    }
    end = pl.Series("end", [round(mean[key], 2) for key in found.select("seed", "gene").iter_rows()])
    return found.with_columns(end, (end.sign() == found["median"].sign()).alias("as_lines"))


def course(run: Run) -> pl.DataFrame:
    """Means over stretches of a run, per seed: numbers, food, lives, generation and weights.

    Args:
        run: whose worlds are read, as far as they are recorded.
    """
    neutral = pl.mean_horizontal(pl.col(f"{name}_mean") ** 2 for name in run.neutral_names).mean().sqrt()
    return (
        run.population(skip_damaged=True)
        .filter(pl.col("step") > 0)
        .group_by("seed", step=((pl.col("step") - 1) // STRETCH + 1) * STRETCH, maintain_order=True)
        .agg(
            steps=pl.col("steps").sum(),
            alive=(pl.col("agent_steps").sum() / pl.col("steps").sum()).round(1),
            food_per_agent_step=(pl.col("eaten_normal").sum() / pl.col("agent_steps").sum()).round(7),
            steps_per_death=(pl.col("agent_steps").sum() / pl.col("deaths").sum()).round(0),
            births=pl.col("births").sum(),
            energy=pl.col("energy_mean").mean().round(3),
            generation=pl.col("generation_mean").last().round(1),
            w_normal=pl.col("w_normal_mean").mean().round(3),
            w_action=pl.col("w_action_mean").mean().round(3),
            neutral_rms=neutral.round(3),
        )
        .sort("seed", "step")
    )


def main() -> None:
    """Writes the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", default="1,2,3,4,5", help="of worlds, with commas")
    parser.add_argument("--run", type=Path, help="folder of a run of `baseline --fidelity released`, for its seeds")
    parser.add_argument("--out", type=Path, default=Path("lines"), help="folder of the tables")
    asked = parser.parse_args()
    if asked.run is None:
        tables = {"mutation-lines": pl.DataFrame(list(lines([int(seed) for seed in asked.seeds.split(",")])))}
    else:
        try:
            run = open_run(asked.run)
        except RecordError as error:
            parser.error(str(error))
        if (run.manifest.preset, run.manifest.fidelity, run.manifest.modified) != ("baseline", "released", False):
            parser.error(f"--run: {asked.run} is not of `hedon run baseline --fidelity released` without --set")
        tables = {"genes": ends(run), "course": course(run)}
    asked.out.mkdir(parents=True, exist_ok=True)
    for name, table in tables.items():
        table.write_csv(asked.out / f"{name}.csv")
        print(f"wrote {asked.out / f'{name}.csv'}")


if __name__ == "__main__":
    main()
