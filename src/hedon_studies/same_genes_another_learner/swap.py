"""Part C: does a reward win only with the learner with which it evolved?

The genomes that evolved in the two arms of a pair of part B compete in one world, once with each learner. transplant.py
describes `python -m hedon_studies.same_genes_another_learner.swap`.
"""

from typing import Any

import polars as pl

from hedon.analysis import WorldRecord
from hedon.assay import by_descent, world_lines
from hedon.record import Founders
from hedon_studies.same_genes_another_learner.answer import SWAP
from hedon_studies.same_genes_another_learner.evolution import ARMS
from hedon_studies.same_genes_another_learner.named_test import holm_table, named_test
from hedon_studies.same_genes_another_learner.transplant import Part, Treatment


def measure(world: WorldRecord, founders: Founders) -> dict[str, Any]:
    """The measures of one contest.

    Returns:
        Of the group whose genomes evolved under the fast learner: "share" among the living at the end, and "selection",
        its selection coefficient per generation. "generation" and "alive" describe the living at the end.
    """
    groups = founders.groups(world.seed, world.species_config.population.initial_count)
    first = by_descent(world.agents, [group == "fast" for group in groups])
    lines = world_lines(world.agents, world.seed, first, world.last_step)
    return {
        "share": float(lines.share[-1]),
        "selection": lines.selection,
        "generation": float(lines.generation[-1]),
        "alive": float(lines.count[-1].sum()),
    }


def named_tests(worlds: pl.DataFrame) -> pl.DataFrame:
    """The primary test and the secondary tests, in the order of expected.md.

    Returns:
        One row per test, with the columns of `named_test`, and "p_holm", which is null for the primary test.
    """
    shares = worlds.pivot(on="treatment", index="pair", values="share").drop_nulls().sort("pair")
    fast, slow = (shares[learner].to_numpy() for learner in ("fast", "slow"))
    rows = [
        named_test("primary: share of the fast-evolved, fast less slow learner", fast - slow),
        named_test("share of the fast-evolved less 1/2, fast learner", fast - 0.5),
        named_test("share of the fast-evolved less 1/2, slow learner", slow - 0.5),
    ]
    return holm_table(rows)


PART = Part(
    {learner: Treatment(learner, tuple(ARMS)) for learner in ARMS},
    pairs=60,
    steps=61_440,
    seed_shift=100,
    measure=measure,
    named_tests=named_tests,
    expected=SWAP,
)

if __name__ == "__main__":
    PART.main(__doc__ or "")
