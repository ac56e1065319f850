"""Part D: which rewards and which learners does a decoy mislead?

A decoy looks like food, and no agent can eat it. Genomes that evolved in part B live with decoys and without.
transplant.py describes `python -m hedon_studies.same_genes_another_learner.decoy`.
"""

from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.analysis import WorldRecord, food_per_agent_step, mean_alive
from hedon.record import Founders
from hedon_studies.same_genes_another_learner.answer import DECOY
from hedon_studies.same_genes_another_learner.evolution import ARMS
from hedon_studies.same_genes_another_learner.named_test import holm_table, named_test
from hedon_studies.same_genes_another_learner.transplant import Part, Treatment

SETTINGS = (
    "food.decoy.looks_like=normal",
    "food.decoy.gives.energy=0",
    "food.decoy.needs.energy=1e6",  # more than an agent can hold, so decoys stay
    "food.decoy.growth_rate=0",
    "food.decoy.gene.initial_sd=0",
)
COUNT = {"decoy": 100, "none": 0}
"""Number of decoys; worlds without them have the same kinds, and so the same networks."""


def measure(world: WorldRecord, founders: Founders) -> dict[str, Any]:
    """The measures of one world.

    Returns:
        "intake": foods eaten per agent and step. "unpaid": share of the energy charged that agents could not pay,
        because they had none. "alive": mean number alive.
    """
    charged, unpaid = (
        float(world.population.select(pl.sum_horizontal(columns).sum()).item())
        for columns in (("energy_basic", "energy_action"), ("energy_forgiven",))
    )
    return {
        "intake": food_per_agent_step(world.population, ["normal"]),
        "unpaid": unpaid / charged if charged else None,
        "alive": mean_alive(world.population),
    }


def losses(worlds: pl.DataFrame) -> dict[tuple[str, str], NDArray[np.float64]]:
    """The share of their intake that agents lose to decoys, in each pair, by genes and learner.

    Args:
        worlds: Rows of `worlds.csv`.
    """
    table = worlds.pivot(on="treatment", index="pair", values="intake").drop_nulls().sort("pair")
    return {
        (genes, learner): (1 - table[_name(genes, learner, "decoy")] / table[_name(genes, learner, "none")]).to_numpy()
        for genes in ARMS
        for learner in ARMS
    }


def named_tests(worlds: pl.DataFrame) -> pl.DataFrame:
    """The primary test and the secondary tests, in the order of expected.md.

    Returns:
        One row per test, with the columns of `named_test`, and "p_holm", which is null for the primary test.
    """
    loss = losses(worlds)
    misled = {learner: loss["fast", learner] - loss["slow", learner] for learner in ARMS}
    by_learner = {learner: (loss["slow", learner] + loss["fast", learner]) / 2 for learner in ARMS}
    rows = [
        named_test("primary: loss of intake, fast less slow learner", by_learner["fast"] - by_learner["slow"]),
        named_test("loss of intake, fast-evolved less slow-evolved, slow learner", misled["slow"]),
        named_test("loss of intake, fast-evolved less slow-evolved, fast learner", misled["fast"]),
        named_test("the same difference, fast less slow learner", misled["fast"] - misled["slow"]),
        *(
            named_test(f"loss of intake, {genes}-evolved, {learner} learner", each)
            for (genes, learner), each in loss.items()
        ),
    ]
    return holm_table(rows)


def _name(genes: str, learner: str, decoys: str) -> str:
    return f"{genes}-{learner}-{decoys}"


PART = Part(
    {
        _name(genes, learner, decoys): Treatment(
            learner, (genes,), (*SETTINGS, f"food.decoy.initial_count={count}", f"food.decoy.capacity={count}")
        )
        for genes in ARMS
        for learner in ARMS
        for decoys, count in COUNT.items()
    },
    pairs=30,
    steps=20_480,
    seed_shift=200,
    measure=measure,
    named_tests=named_tests,
    expected=DECOY,
)

if __name__ == "__main__":
    PART.main(__doc__ or "")
