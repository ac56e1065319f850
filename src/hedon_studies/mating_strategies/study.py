"""Do agents that only forage and agents that seek mates live together? README.md has the claim and the rule."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from diptest import dipstat

import hedon.assay
import hedon.figure
from hedon.analysis import ResultTable, WorldRecord, last_agents, last_mean, make_table
from hedon.assay import Lines, by_gene, estimate_frequency, world_lines
from hedon.figure import NamedFigure
from hedon.study import Condition, Item, ItemInputs, Scale, Study, missing, missing_note
from hedon_studies.rule import Test, count_test, mean_test, verdict_table

FOLDER = Path(__file__).parent
SETTINGS = tomllib.loads((FOLDER / "study.toml").read_text(encoding="utf-8"))
MIXED, EVOLVING = SETTINGS["mixed"], SETTINGS["evolving"]
GENE = "w_see_agent"
SEEDS = tuple(range(SETTINGS["seeds"][0], SETTINGS["seeds"][1] + 1))
FORAGER, TRACKER = {GENE: MIXED["forager"]}, {GENE: MIXED["tracker"]}
NAMED = 3
"""Number of tests that the study names, in both of its items."""


def _mixed(share: float) -> Condition:
    parts = (f"see_agent={MIXED['forager']}:{share}", f"see_agent={MIXED['tracker']}:{1 - share:g}")
    changes = (*SETTINGS["overrides"], *MIXED["overrides"])
    return Condition(f"{share:.0%} foragers", SETTINGS["preset"], changes, founders=",".join(parts))


MIXTURES = {share: _mixed(share) for share in MIXED["shares"]}
EVOLVED = Condition("evolving", SETTINGS["preset"], (*SETTINGS["overrides"], *EVOLVING["overrides"]))
FEWEST = 100
"""Smallest number of agents born last for the test of clusters."""
RARE, COMMON = min(MIXTURES), max(MIXTURES)


def lines_of(world: WorldRecord) -> Lines:
    """The numbers of foragers and trackers over time."""
    return world_lines(world.agents, world.seed, by_gene(world.agents, FORAGER, TRACKER), world.last_step)


def invasion_tests(lines: Mapping[float, Sequence[Lines]]) -> tuple[Test, Test]:
    """Tests whether each type increases when it starts rare, from the worlds of each share of foragers."""
    tests = []
    for name, share, above in (("foragers", RARE, True), ("trackers", COMMON, False)):
        worlds = lines.get(share, ())
        tests.append(
            mean_test(
                f"{name} invade from {RARE:.0%}: change of the share of foragers",
                [group_lines.share[-1] - group_lines.share[0] for group_lines in worlds],
                len(worlds),
                sum(group_lines.ended for group_lines in worlds),
                above=above,
            )
        )
    return tests[0], tests[1]


def make_mixed(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and tables of foragers' fitness against their frequency, and of whether each type invades."""
    question = "Are foragers and trackers each fitter where they are rare?"
    lines = {
        share: [lines_of(world) for world in inputs.worlds[condition.label]]
        for share, condition in MIXTURES.items()
        if condition.label in inputs.worlds
    }
    note = missing_note(inputs, tuple(MIXTURES.values()), Scale(SEEDS, MIXED["steps"]))
    frequency = estimate_frequency(("foragers", "trackers"), lines) if len(lines) > 1 else None
    if frequency is None:
        drawn = hedon.figure.draw_message("needs worlds of two shares")
        yield NamedFigure("mating-strategies", question, drawn, missing(MIXTURES.values(), inputs))
    else:
        caption = "Dots: worlds that began with one share of foragers. Line: all of them together, with its interval."
        yield NamedFigure("mating-strategies", question, hedon.assay.draw_frequency(frequency), caption)
    yield verdict_table("mating_verdict", invasion_tests(lines), note, NAMED)
    if frequency is not None:
        yield from hedon.assay.frequency_tables(frequency)
    title = "Each world: the share of foragers at the start and at the end"
    yield make_table("mating_share_world", title, world_rows(lines), shown=False)


def world_rows(lines: Mapping[float, Sequence[Lines]]) -> list[dict[str, Any]]:
    """A row for each world, from the worlds of each share of foragers."""
    return [
        {
            "foragers": share,
            "seed": world.seed,
            "died out": world.ended,
            "start": float(world.share[0]),
            "end": float(world.share[-1]),
            "generations": float(world.generation[-1]),
        }
        for share, worlds in lines.items()
        for world in worlds
    ]


def is_clustered(world: WorldRecord) -> bool | None:
    """Whether the gene is further from one mode than every neutral gene of the same agents; None with too few agents.

    Relatives are similar in all genes, so neutral genes have clusters too, which are the effect of drift.
    """
    agents = last_agents(world.agents)
    if agents.height < FEWEST:
        return None
    dip = {
        name: float(np.asarray(dipstat(agents[name].to_numpy().astype(np.float64))))
        for name in (GENE, *world.neutral_names)
    }
    return all(dip[GENE] > dip[name] for name in world.neutral_names)


def cluster_test(rows: Sequence[dict[str, Any]]) -> Test:
    """Tests whether more worlds have clusters than if the gene were neutral, like those that it is compared with."""
    measured = [row for row in rows if row["clusters"] is not None]
    chance = 1 / (1 + rows[0]["neutral genes"]) if rows else 1.0
    count, extinct_count = (sum(row[name] for row in measured) for name in ("clusters", "died out"))
    return count_test(
        f"genomes form clusters: share of worlds less {chance:.2g}",
        count,
        len(measured),
        extinct_count,
        chance,
        above=True,
    )


def make_evolved(inputs: ItemInputs) -> Iterator[NamedFigure | ResultTable]:
    """Makes the figure and tables on whether two kinds of genomes evolve in one world."""
    rows = [
        {
            "seed": world.seed,
            "died out": world.extinct_step is not None,
            "agents": world.agents.height,
            "mean": last_mean(GENE, world),
            "clusters": is_clustered(world),
            "neutral genes": len(world.neutral_names),
        }
        for world in inputs.worlds.get(EVOLVED.label, ())
    ]
    note = missing_note(inputs, (EVOLVED,), Scale(SEEDS, EVOLVING["steps"]))
    yield verdict_table("mating_clusters_verdict", (cluster_test(rows),), note, NAMED)
    yield make_table("mating_world", "Each world: the gene of those born last", rows, shown=False)


STUDY = Study(
    "mating-strategies",
    "Mating strategies",
    "Elfwing & Doya (2014), 10.1371/journal.pone.0093622: agents that always choose food and agents that track mates "
    "when their energy is above a threshold live together. Is each of them fitter where it is rare?",
    (
        Item(
            "mating-frequency",
            "Fitness of foragers against their frequency",
            "The fitness curves cross at about 25 % of foragers.",
            make_mixed,
            tuple(MIXTURES.values()),
            Scale(SEEDS, MIXED["steps"]),
        ),
        Item(
            "mating-clusters",
            "Do both kinds evolve?",
            "In four of the seven fittest populations there were subpopulations of both kinds.",
            make_evolved,
            (EVOLVED,),
            Scale(SEEDS, EVOLVING["steps"]),
        ),
    ),
    (FOLDER / "expected.md").read_text(encoding="utf-8"),
)
