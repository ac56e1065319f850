"""Why does the direction of the fittest reward change? What part A's founders have learned, by age, for three learners.

Nobody is born or dies. Every 1,024 steps, we compute what the network of each agent would do, and what value it would
expect, if it saw food to the left, to the right, ahead, or nowhere. Slopes over the agents of a world show how strongly
the weights of sight and of food shape each answer.

`python -m hedon_studies.same_genes_another_learner.behavior run LEARNER FIRST LAST FILE` simulates the worlds with
these seeds; `python -m hedon_studies.same_genes_another_learner.behavior tests FILE…` prints the tests named in
expected.md.
"""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

import hedon
from hedon.assay import Spread, spread_founders
from hedon.config import Config, load_config
from hedon_studies.same_genes_another_learner.answer import BEHAVIOR, answer_table, early_values
from hedon_studies.same_genes_another_learner.evolution import PRESET, SEEN, require_files, require_groups
from hedon_studies.same_genes_another_learner.landscape import ACTION, ARMS, FOOD, SIGHT
from hedon_studies.same_genes_another_learner.named_test import holm_table, named_test

LEARNERS = ("slow", "baseline", "fast")
ROWS = "rows.parquet"
STEPS, EVERY, EARLY, LATE = 20_480, 1_024, 6_144, 8_192
NEAR = 0.5
"""Reading of a ray that sees food in half of its reach."""
IMMORTAL = ("genome.mutation_scale=0", "hazard.kappa=0", "hazard.alpha_age=0", "birth.kappa=0")
CHANGES = (("early", "intake"), ("late", "intake"), ("early", "steering"), ("early", "value"))
"""Windows and measures of the secondary tests."""
WINDOWS = {"early": pl.col("step") <= EARLY, "late": pl.col("step") > pl.col("step").max() - LATE}
GENES = {"sight": SIGHT, "food": FOOD}
WORLDS = 30
"""Number of worlds of each learner."""

Floats = NDArray[np.floating[Any]]


def config_of(learner: str) -> Config:
    """The settings of part A for one learner, without births and deaths."""
    return load_config(PRESET, overrides=[SEEN, *IMMORTAL, *filter(None, [ARMS[learner]])])


def probe(world: hedon.World, config: Config) -> dict[str, Floats]:
    """What each agent would do, and expects, if it saw food.

    Returns:
        "steering": how far the force of the outer motor exceeds that of the inner one if the food is at one side,
        averaged over both sides, as a share of the range of forces. "approach": how much larger the mean force is if
        the food is ahead than if there is none, as such a share. "value": the value that the critic expects with food
        ahead, less that without. Each has shape (agents,).
    """
    observations = world.observations()
    rays = config.species["agent"].sensor.ray_count
    food = slice(rays, 2 * rays)  # the first channel is for agents, the second for the first kind of food
    views = {"none": (0, 0), "right": (0, rays // 2), "left": (rays // 2, rays), "ahead": (rays // 4, 3 * rays // 4)}
    answers = {}
    for name, (first, last) in views.items():
        seen = observations.copy()
        seen[:, food] = -1.0
        seen[:, food.start + first : food.start + last] = NEAR
        answers[name] = forward(world.state.params[world.living], seen)
    forces = {name: 1.0 / (1.0 + np.exp(-action)) for name, (action, _) in answers.items()}
    turn = {name: force[:, 1] - force[:, 0] for name, force in forces.items()}
    return {
        "steering": (turn["left"] - turn["right"]) / 2,
        "approach": forces["ahead"].mean(axis=1) - forces["none"].mean(axis=1),
        "value": answers["ahead"][1] - answers["none"][1],
    }


def forward(params: Floats, observations: Floats) -> tuple[Floats, Floats]:
    """The mean action and the value of each agent's network, as in docs/guide/python.md.

    Args:
        params: Parameters of the networks, shape (agents, parameters).
        observations: One observation for each agent, shape (agents, inputs).

    Returns:
        Mean actions, shape (agents, 2), and values, shape (agents,).
    """
    hidden, actions, inputs = 64, 2, observations.shape[1]
    sizes = (inputs * hidden, hidden, hidden * hidden, hidden, (actions + 1) * hidden, actions + 1)
    w1, b1, w2, b2, w3, b3, _ = np.split(params, np.cumsum(sizes), axis=1)
    layer = np.tanh(np.einsum("ai,aij->aj", observations, w1.reshape(-1, inputs, hidden)) + b1)
    layer = np.tanh(np.einsum("ai,aij->aj", layer, w2.reshape(-1, hidden, hidden)) + b2)
    output = np.einsum("aj,aoj->ao", layer, w3.reshape(-1, actions + 1, hidden)) + b3
    return output[:, :actions], output[:, actions]


def slopes(genes: Mapping[str, Floats], values: Floats) -> dict[str, float]:
    """The slopes of a measure on the weights of sight, food and action over the agents of one world, by gene."""
    design = np.column_stack([np.ones(len(values)), *genes.values()])
    coefficients = np.linalg.lstsq(design, values, rcond=None)[0]
    return dict(zip(genes, coefficients[1:].tolist(), strict=True))


def world_rows(learner: str, seed: int, steps: int = STEPS) -> Iterator[dict[str, Any]]:
    """The mean of each measure in one world and its slopes on the genes, every 1,024 steps.

    Args:
        learner: Name of the learner in part A.
        seed: Seed of the world.
        steps: Its length [step].
    """
    config = config_of(learner)
    simulation = hedon.Simulation(config, [seed], threads=1)
    simulation.set_founders(spread_founders(config, Spread(-2.0, 2.0), "agent"))
    (world,) = simulation.worlds
    columns = world.layouts[0].gene_names
    agents = world.agents()
    genes = {gene: agents["genome"][:, columns.index(gene)] for gene in (SIGHT, FOOD, ACTION)}
    eaten = agents["eaten"][:, 0]
    for step in range(EVERY, steps + 1, EVERY):
        simulation.run(EVERY)
        total = world.agents()["eaten"][:, 0]
        measures = {"intake": (total - eaten) / EVERY} | probe(world, config)
        eaten = total
        for name, values in measures.items():
            row = {"learner": learner, "seed": seed, "step": step, "measure": name, "mean": float(values.mean())}
            yield row | slopes(genes, values)


def named_tests(rows: pl.DataFrame) -> pl.DataFrame:
    """The primary test and the secondary tests, in the order of expected.md.

    All are about changes from the baseline to the fast learner, in worlds with equal seeds, of means over the first
    `EARLY` or the last `LATE` steps.

    Args:
        rows: Rows from `world_rows` of all worlds.

    Returns:
        One row per test, with the columns of `named_test`, and "p_holm", which is null for the primary test.
    """

    def change(window: str, measure: str, gene: str) -> NDArray[np.float64]:
        steps = rows.filter(WINDOWS[window]).filter(pl.col("measure") == measure)
        means = steps.group_by("learner", "seed").agg(pl.col(gene).mean())
        paired = means.pivot(on="learner", index="seed", values=gene).sort("seed")
        return (paired["fast"] - paired["baseline"]).to_numpy()

    difference = change("early", "intake", SIGHT) - change("early", "intake", FOOD)
    tests = [named_test("primary: early intake, sight less food", difference)]
    tests += [
        named_test(f"{window} {measure}, {name}", change(window, measure, gene))
        for window, measure in CHANGES
        for name, gene in GENES.items()
    ]
    return holm_table(tests)


def answers(rows: pl.DataFrame) -> pl.DataFrame:
    """The tests, and whether each came out as expected; open until all worlds have run.

    Args:
        rows: Rows from `world_rows` of all worlds.
    """
    baseline = rows.filter((pl.col("learner") == "baseline") & (pl.col("measure") == "value") & WINDOWS["early"])
    values = {f"early value, {name}": float(np.mean(baseline[gene].to_numpy())) for name, gene in GENES.items()}
    ends = rows.filter(pl.col("step") == STEPS)
    complete = ends.select("learner", "seed").unique().height == WORLDS * len(LEARNERS)
    return answer_table("tests", named_tests(rows), {**BEHAVIOR, **early_values(values)}, complete=complete).rows


def _read(parser: argparse.ArgumentParser, files: Sequence[Path]) -> pl.DataFrame:
    """The rows of some tables; ends the program with a message if one cannot be read, or if a learner is missing."""
    tables = []
    for path in files:
        try:
            tables.append(pl.read_parquet(path))
        except pl.exceptions.PolarsError:
            parser.error(f"{path}: not a table that `run` wrote")
    rows = pl.concat(tables)
    require_groups(parser, rows["learner"], ("baseline", "fast"))
    return rows


def main(arguments: Sequence[str] | None = None) -> None:
    """Simulates worlds, or prints the tests of worlds."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    verbs = parser.add_subparsers(dest="verb", required=True)
    run = verbs.add_parser("run", help="simulate worlds of one learner")
    run.add_argument("learner", choices=LEARNERS)
    run.add_argument("first", type=int, help="seed of the first world")
    run.add_argument("last", type=int, help="seed of the last world")
    run.add_argument("file", type=Path, help="table to write (Parquet)")
    run.add_argument("--steps", type=int, default=STEPS)
    verbs.add_parser("tests", help="print the tests").add_argument("file", nargs="+", type=Path)
    options = parser.parse_args(arguments)
    if options.verb == "run":
        options.file.parent.mkdir(parents=True, exist_ok=True)
        seeds = range(options.first, options.last + 1)
        rows = pl.DataFrame([row for seed in seeds for row in world_rows(options.learner, seed, options.steps)])
        rows.cast({pl.Float64: pl.Float32}).write_parquet(options.file, compression="zstd", compression_level=19)
    else:
        require_files(parser, options.file)
        with pl.Config(tbl_rows=20, tbl_cols=12, fmt_str_lengths=60, tbl_width_chars=160):
            print(answers(_read(parser, options.file)))


if __name__ == "__main__":
    main()
