"""Part A: the fitness of liking the sight of food, and food itself, for six learners with the same founders.

`python -m hedon_studies.same_genes_another_learner.landscape FOLDER` prints the tests named in expected.md. The folder
contains `founders.parquet`, the genes that all arms share, and `outcomes.parquet`, their outcomes in each arm.
"""

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon_studies.same_genes_another_learner.named_test import holm_table, named_test

ARMS: dict[str, str] = {
    "baseline": "",
    "slow": "learning.learning_rate=0.0003",
    "fast": "learning.learning_rate=0.003",
    "short": "learning.gamma=0.5",
    "long": "learning.gamma=0.99",
    "normalized": "learning.advantage_normalization=window",
}
"""The setting that each arm changes."""
SIGHT, FOOD, ACTION = "w_see_normal", "w_normal", "w_action"
REPEATS = (0.05, 0.16)
"""Range in which the mean of the primary test must be for the landscapes to replicate the pilots."""
CHANGES = (("baseline", "short"), ("baseline", "long"), ("baseline", "normalized"), ("slow", "baseline"))
HUMPS = ("baseline", "slow", "fast", "short", "long")
FOUNDERS, OUTCOMES = "founders.parquet", "outcomes.parquet"

Floats = NDArray[np.float64]


def write_arms(arms: Mapping[str, pl.DataFrame], folder: Path) -> None:
    """Writes the founders of all arms, with their genes only once.

    Args:
        arms: Founders of each arm with their genes and outcomes.
        folder: Folder of the tables.

    Raises:
        ValueError: The founders of two arms differ.
    """
    first = next(iter(arms.values()))
    genes = [name for name in first.columns if name.startswith(("w_", "neutral_"))]
    shared = first.select(pl.col("seed", "agent_id").cast(pl.Int32), pl.col(genes).cast(pl.Float32))
    outcomes = [name for name in first.columns if name not in shared.columns]
    for name, arm in arms.items():
        if not arm.select(genes).equals(first.select(genes)):
            raise ValueError(f"{name}: its founders have other genes than those of {next(iter(arms))}")
    outcome_rows = [
        arm.select(pl.lit(name).alias("arm"), pl.col(outcomes).cast(pl.Float32)) for name, arm in arms.items()
    ]
    for file, table in ((FOUNDERS, shared), (OUTCOMES, pl.concat(outcome_rows))):
        table.write_parquet(folder / file, compression="zstd", compression_level=19)


def read_arms(folder: Path) -> dict[str, pl.DataFrame]:
    """The founders of each arm with their genes and outcomes."""
    founders = pl.read_parquet(folder / FOUNDERS)
    outcome_rows = pl.read_parquet(folder / OUTCOMES).partition_by("arm", as_dict=True, include_key=False)
    return {str(name): pl.concat([founders, rows], how="horizontal") for (name,), rows in outcome_rows.items()}


def slopes(founders: pl.DataFrame, outcome: str, genes: tuple[str, ...] = (SIGHT, FOOD, ACTION)) -> pl.DataFrame:
    """The slope of relative fitness on each weight, by least squares within each world.

    Args:
        founders: Founders with their genes and outcomes.
        outcome: Column of the outcome that measures fitness.
        genes: Genome columns of the weights.

    Returns:
        One row per world: "seed", and the slope on each gene [share of mean fitness per unit of weight]; null in a
        world whose founders all have fitness 0.
    """
    rows: list[dict[str, Any]] = []
    for (seed,), world in founders.group_by("seed", maintain_order=True):
        fitness = world[outcome].to_numpy().astype(np.float64)
        design = np.column_stack([np.ones(len(fitness)), *(world[gene].to_numpy() for gene in genes)])
        if fitness.mean() > 0:
            coefficients = np.linalg.lstsq(design, fitness / fitness.mean(), rcond=None)[0][1:].tolist()
        else:
            coefficients = [None] * len(genes)
        rows.append({"seed": seed, **dict(zip(genes, coefficients, strict=True))})
    return pl.DataFrame(rows, schema={"seed": pl.Int64, **dict.fromkeys(genes, pl.Float64)})


def hump(founders: pl.DataFrame) -> pl.DataFrame:
    """Relative number of living descendants: founders with a strong liking for sight minus those with a moderate one.

    Returns:
        One row per world: "seed", and "hump", the mean for weights of sight from 1 to 2 minus the mean from 0 to 1.
    """
    relative = pl.col("descendants") / pl.col("descendants").mean().over("seed")
    positive = founders.with_columns(relative=relative).filter(pl.col(FOOD) > 0)
    strong, moderate = ((pl.col(SIGHT) >= low) & (pl.col(SIGHT) < low + 1) for low in (1.0, 0.0))
    means = [pl.col("relative").filter(part).mean() for part in (strong, moderate)]
    rows = positive.group_by("seed", maintain_order=True).agg(hump=means[0] - means[1])
    return rows.with_columns(pl.col("hump").fill_nan(None))


def direction_change(before: pl.DataFrame, after: pl.DataFrame, outcome: str = "food") -> Floats:
    """The change of the slope on sight minus the change of the slope on food, for each pair of worlds of equal seeds.

    Args:
        before: Founders in the first arm.
        after: Founders in the second arm.
        outcome: Column of the outcome that measures fitness.

    Returns:
        One value per pair, by seed [share of mean fitness per unit of weight], shape (pairs,).
    """
    pairs = slopes(before, outcome).join(slopes(after, outcome), on="seed", suffix="_after").drop_nulls().sort("seed")
    sight, food = (pairs[f"{gene}_after"] - pairs[gene] for gene in (SIGHT, FOOD))
    return (sight - food).to_numpy()


def named_tests(arms: Mapping[str, pl.DataFrame]) -> pl.DataFrame:
    """The primary test and the nine secondary tests, in the order of expected.md.

    Returns:
        One row per test: "test", "worlds", "effect" (mean), "low" and "high" (95 %, Student's t), "p" (t test),
        "p_sign_flip", and "p_holm", null for the primary test.
    """
    rows = [named_test("primary: baseline to fast", direction_change(arms["baseline"], arms["fast"]))]
    rows += [named_test(f"{a} to {b}", direction_change(arms[a], arms[b])) for a, b in CHANGES]
    rows += [named_test(f"hump, {name}", hump(arms[name])["hump"].drop_nulls().to_numpy()) for name in HUMPS]
    return holm_table(rows, p="p")


def neutral_control(arms: Mapping[str, pl.DataFrame]) -> pl.DataFrame:
    """How often a neutral gene, added to the regression, has a slope whose 95 % interval over worlds excludes 0.

    Returns:
        One row per arm: "arm", "genes", and "excluding_0", the number of genes whose interval excludes 0.
    """
    rows: list[dict[str, Any]] = []
    for name, founders in arms.items():
        neutral = [gene for gene in founders.columns if gene.startswith("neutral_")]
        slope_values = [slopes(founders, "food", (SIGHT, FOOD, ACTION, gene))[gene].drop_nulls() for gene in neutral]
        tests = [named_test(gene, values.to_numpy()) for gene, values in zip(neutral, slope_values, strict=True)]
        rows.append(
            {"arm": name, "genes": len(neutral), "excluding_0": sum(t["low"] > 0 or t["high"] < 0 for t in tests)}
        )
    return pl.DataFrame(rows)


def repeats_the_pilots(tests: pl.DataFrame) -> bool:
    """Whether the primary test meets the criterion that was fixed before the first world."""
    primary = tests.row(0, named=True)
    return primary["low"] > 0 and REPEATS[0] <= primary["effect"] <= REPEATS[1]


if __name__ == "__main__":
    read = read_arms(Path(sys.argv[1]))
    tests = named_tests(read)
    with pl.Config(tbl_rows=20, tbl_cols=10, fmt_str_lengths=40, tbl_width_chars=140):
        print(tests, neutral_control(read), sep="\n")
    print("repeats the pilots:", repeats_the_pilots(tests))
