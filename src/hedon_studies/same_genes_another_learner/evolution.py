"""Part B: which weights of sight and food evolve under a slow and a fast learner, from the same founders.

`python -m hedon_studies.same_genes_another_learner.evolution worlds RUN… --out FOLDER` reduces runs to two tables:
`worlds.csv`, a row per world, and `living.parquet`, the weights of the agents alive at the end.
`python -m hedon_studies.same_genes_another_learner.evolution tests FOLDER` prints the tests named in expected.md.
"""

import argparse
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis import (
    WorldRecord,
    last_living,
    mean_alive,
    read_worlds,
    standard_drift,
)
from hedon.measure import MEASURES
from hedon.record import Run, open_run
from hedon_studies.same_genes_another_learner.landscape import ACTION, FOOD, SIGHT
from hedon_studies.same_genes_another_learner.named_test import holm_table, named_test

PRESET = "appetite"
SEEN = "reward.pay.see_normal.coef=0.2"
"""The setting that pays for the sight of food, in all parts."""
EVOLVING = (
    SEEN,
    "reward.pay.see_normal.gene.initial_sd=1",
    "food.normal.gene.initial_sd=1",
    "hazard.alpha_age=7e-5",
    "energy.basic_cost=0.001",
    "food.normal.growth_rate=2",
)
ARMS = {"slow": 0.0003, "fast": 0.003}
"""The learning rate of each arm."""
WORLDS, LIVING = "worlds.csv", "living.parquet"

Floats = NDArray[np.float64]


def measure(world: WorldRecord) -> dict[str, Any]:
    """The measures of one world, as in `worlds.csv`.

    Returns:
        Arm and seed; demography, with the number alive averaged over all steps; for each weight the mean among the
        living at the end and its score against neutral walks down the same pedigree.
    """
    rate = world.species_config.learning.learning_rate
    arm = next((name for name, value in ARMS.items() if math.isclose(value, rate, rel_tol=1e-6)), str(rate))
    drift = standard_drift(world)
    return {
        "arm": arm,
        "seed": world.seed,
        "steps": world.last_step,
        "extinct_step": world.extinct_step,
        "alive_all_steps": mean_alive(world.population),
        **{name: MEASURES[name].of(world) for name in ("mean_lifetime", "food_per_step")},
        "generation": drift[0].generation if drift else None,
        **{
            key: value
            for entry in drift
            for key, value in (
                (entry.weight, entry.mean),
                (f"{entry.weight}_score", entry.score),
            )
        },
    }


def provenance(world: WorldRecord, run: Run) -> dict[str, Any]:
    """The revision, start and digests of a world, which end its row of `worlds.csv`."""
    manifest = run.manifest
    return {
        "backend": manifest.sessions[-1].backend,
        "hedon_version": manifest.hedon_version,
        "git_revision": manifest.git_revision,
        "started": manifest.sessions[0].started,
        "config_digest": manifest.config_digest,
        "world_digest": manifest.world_digests[manifest.seeds.index(world.seed)],
    }


def living(world: WorldRecord) -> pl.DataFrame:
    """The rows of `living.parquet` for one world: the weights of the agents alive at the end, without neutral genes."""
    weights = last_living(world.agents, world.population).select(pl.col(world.reward_names).cast(pl.Float32))
    rate = pl.lit(world.species_config.learning.learning_rate).alias("learning_rate")
    return weights.select(rate, pl.lit(world.seed, pl.Int32).alias("seed"), pl.all())


def reduce_runs(folders: Iterable[Path], out: Path) -> None:
    """Reduces some runs to the two tables.

    Args:
        folders: Folders of the runs.
        out: Folder of the tables.
    """
    rows: list[dict[str, Any]] = []
    genes: list[pl.DataFrame] = []
    for folder in folders:
        run = open_run(folder)
        for world in read_worlds([run]):
            rows.append(measure(world) | provenance(world, run))
            genes.append(living(world))
    out.mkdir(parents=True, exist_ok=True)
    pl.DataFrame(rows, infer_schema_length=None).sort("arm", "seed").write_csv(out / WORLDS)
    pl.concat(genes).write_parquet(out / LIVING, compression="zstd", compression_level=19)


def pairs(worlds: pl.DataFrame) -> pl.DataFrame:
    """The worlds of both arms by seed, without pairs in which a world died out.

    Returns:
        One row per pair: "seed", and each weight with the suffixes `_slow` and `_fast`.
    """
    survivors = worlds.filter(pl.col("extinct_step").is_null())
    weights = [name for name in worlds.columns if f"{name}_score" in worlds.columns]
    arms = [
        survivors.filter(pl.col("arm") == arm).select("seed", pl.col(weights).name.suffix(f"_{arm}")) for arm in ARMS
    ]
    return arms[0].join(arms[1], on="seed").sort("seed")


def direction(paired: pl.DataFrame, arm: str, gene: str = SIGHT) -> Floats:
    """The direction of the mean evolved reward: the angle of (food, sight), which is 0 if only food is liked.

    Args:
        paired: Rows from `pairs`.
        arm: The arm.
        gene: Genome column to use for sight.

    Returns:
        One angle per pair [degrees].
    """
    return np.degrees(np.arctan2(paired[f"{gene}_{arm}"].to_numpy(), paired[f"{FOOD}_{arm}"].to_numpy()))


def named_tests(worlds: pl.DataFrame) -> pl.DataFrame:
    """The primary test and the secondary tests, in the order of expected.md.

    Returns:
        One row per test: "test", "worlds", "effect" (mean), "low" and "high" (95 %, Student's t), "p" (t test),
        "p_sign_flip", and "p_holm". The last corrects the sign-flip tests, since scores against drift have an upper
        limit; it is null for the primary test.
    """
    paired = pairs(worlds)
    change = direction(paired, "fast") - direction(paired, "slow")
    rows = [named_test("primary: direction, fast less slow [degrees]", change)]
    for gene in (SIGHT, FOOD):
        difference = paired[f"{gene}_fast"] - paired[f"{gene}_slow"]
        rows.append(named_test(f"{gene}, fast less slow", difference.to_numpy()))
    survivors = worlds.filter(pl.col("extinct_step").is_null())
    for arm in ARMS:
        arm_rows = survivors.filter(pl.col("arm") == arm)
        rows += [
            named_test(f"{gene}, {arm}, against drift [sd]", arm_rows[f"{gene}_score"].to_numpy())
            for gene in (SIGHT, FOOD)
        ]
    return holm_table(rows)


def neutral_control(worlds: pl.DataFrame) -> pl.DataFrame:
    """The primary test with each neutral gene in place of sight.

    Returns:
        One row per neutral gene, with the columns of `named_test`.
    """
    paired = pairs(worlds)
    names = [name for name in worlds.columns if name.startswith("neutral_") and not name.endswith("_score")]
    return pl.DataFrame(
        [named_test(name, direction(paired, "fast", name) - direction(paired, "slow", name)) for name in names]
    )


def require_files(parser: argparse.ArgumentParser, paths: Iterable[Path]) -> None:
    """Ends the program with a message and exit code 2 if a file is missing."""
    for path in paths:
        if not path.is_file():
            parser.error(f"{path}: there is no such file")


def require_groups(parser: argparse.ArgumentParser, found: pl.Series, needed: Iterable[str]) -> None:
    """Ends the program with a message and exit code 2 if a table has no world of a group that its tests compare."""
    lacking = [name for name in needed if name not in set(found)]
    if lacking:
        parser.error(f"no worlds of {', '.join(lacking)}; the tests need some of each")


def main(arguments: Sequence[str] | None = None) -> None:
    """Reduces runs to tables, or prints the tests of such tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    reduce = verbs.add_parser("worlds", help="reduce runs to worlds.csv and living.parquet")
    reduce.add_argument("run", nargs="+", type=Path)
    reduce.add_argument("--out", type=Path, required=True)
    verbs.add_parser("tests", help="print the tests").add_argument("folder", type=Path)
    options = parser.parse_args(arguments)
    if options.verb == "worlds":
        reduce_runs(options.run, options.out)
        return
    require_files(parser, [options.folder / WORLDS])
    worlds = pl.read_csv(options.folder / WORLDS)
    require_groups(parser, worlds["arm"], ARMS)
    means = ["alive_all_steps", "mean_lifetime", "food_per_step", "generation", SIGHT, FOOD, ACTION]
    with pl.Config(tbl_rows=20, tbl_cols=12, fmt_str_lengths=48, tbl_width_chars=160):
        extinct = pl.col("extinct_step").is_not_null().sum().alias("extinct")
        print(worlds.group_by("arm", maintain_order=True).agg(pl.len(), extinct, pl.col(means).mean()))
        print(named_tests(worlds))
    control = neutral_control(worlds)
    nonzero = control.filter((pl.col("low") > 0) | (pl.col("high") < 0))["test"].to_list()
    print(f"{len(nonzero)} of {control.height} neutral genes have an interval without 0: {', '.join(nonzero)}")


if __name__ == "__main__":
    main()
