"""Exports the pedigree of a world for phylogenetic tools, in the ALife data standard and in Newick format."""

from typing import NamedTuple

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import ALIVE, Genealogy, ancestry, genealogy
from hedon.config.problem import did_you_mean
from hedon.export.table import ExportError
from hedon.figure.style import png_bytes
from hedon.figure.tree import draw_tree
from hedon.record.reader import Run
from hedon.text import brief

TWO_PARENTS = (
    "children of this run have two parents, and ancestor_list names both: programs that expect a tree, such as the "
    "converters of the ALife standard, refuse it"
)


class Subtree(NamedTuple):
    """A part of a tree of the living: its text, and the step of its topmost fork or tip."""

    text: str
    top: int


def pedigree(run: Run, seed: int | None = None, species: str | None = None) -> pl.DataFrame:
    """The agents of one world, by agent_id.

    Args:
        run: The run.
        seed: Seed of the world; None if the run has only one.
        species: The species; None for all.

    Returns:
        The table `agents`. In a branch, agents alive at its start are roots unless their parents were alive too.

    Raises:
        ExportError: The world or species does not exist or is not specified, or ancestors are missing.
        RecordError: A part of the table is damaged.
    """
    seeds = run.manifest.seeds
    chosen_seed = seeds[0] if seed is None and len(seeds) == 1 else seed
    if chosen_seed not in seeds:
        problem = "say which world" if seed is None else f"--world {seed}: there is no such world"
        raise ExportError(f"{problem}: the run has seeds " + ", ".join(map(str, seeds)))
    agents = run.agents().filter(pl.col("seed") == chosen_seed).sort("agent_id")
    if species is not None:
        if species not in run.columns.species:
            listing = ", ".join(run.columns.species)
            raise ExportError(f"--species {brief(species)}: there is no such species (there are {listing})")
        agents = agents.filter(pl.col("species") == species) if run.columns.several else agents
    if run.manifest.parent is not None:
        agents = _rooted(agents, run.manifest.parent.step)
    gaps = genealogy(agents).gaps
    if gaps:
        raise ExportError(f"the parents of {gaps} agents are not recorded: a part of the run is missing")
    return agents


def _rooted(agents: pl.DataFrame, begin: int) -> pl.DataFrame:
    """The agents of a branch, without parents who died before its start [step]."""
    ids = agents["agent_id"].implode()
    roots = (pl.col("birth_step") <= begin) & ~pl.col("parent_id").is_in(ids)
    parent_columns = [name for name in ("parent_id", "mate_id") if name in agents.columns]
    return agents.with_columns(pl.when(~roots).then(pl.col(name)).alias(name) for name in parent_columns)


def last_step(run: Run, agents: pl.DataFrame) -> int:
    """The last step of a pedigree: the end of its world, or the last event if the run has not ended.

    Args:
        run: The run.
        agents: Agents of one world.
    """
    steps_done = run.manifest.steps_done[run.manifest.seeds.index(agents["seed"][0])]
    events = agents.select(pl.max_horizontal(pl.col("birth_step").max(), pl.col("death_step").max())).item()
    return max(steps_done, events)


def alife_table(agents: pl.DataFrame, genes: tuple[str, ...]) -> pl.DataFrame:
    """The pedigree in the ALife data standard for phylogenies (Lalejini et al. 2019).

    Args:
        agents: Agents of one world and species, by agent_id, as from `pedigree`.
        genes: Genome columns to include.

    Returns:
        `id`; `ancestor_list`, "[NONE]" for founders, with both parents if there are two; `origin_time` and
        `destruction_time` [step], "inf" for the living; then the species, if there are several, and the genes.
    """
    parent = pl.col("parent_id").cast(pl.String).fill_null("NONE")
    if "mate_id" in agents.columns:
        both_parents = pl.concat_str("parent_id", "mate_id", separator=",")
        parent = pl.when(pl.col("mate_id").is_null()).then(parent).otherwise(both_parents)
    return agents.select(
        pl.col("agent_id").alias("id"),
        pl.concat_str(pl.lit("["), parent, pl.lit("]")).alias("ancestor_list"),
        pl.col("birth_step").alias("origin_time"),
        pl.col("death_step").cast(pl.String).fill_null("inf").alias("destruction_time"),
        *[name for name in ("species", *genes) if name in agents.columns],
    )


def newick(agents: pl.DataFrame, now: int) -> bytes:
    """Trees of the living in Newick format, one line for each founder with living descendants.

    A tip is a living agent, named by its agent_id. A fork is a birth: one branch belongs to the child, the other is the
    parent's further life. A birth is omitted if one of its two branches has died out. Lengths are in steps, so all
    tips of a tree end at `now`; the length of a root is the time from its founder's birth to the first fork.

    Args:
        agents: Agents of one world and species, by agent_id, as from `pedigree`.
        now: Step at which the pedigree ends.

    Raises:
        ExportError: Children have two parents, so that there is no tree, or no agents are alive.
    """
    tree = require_tree(agents)
    if not tree.alive.any():
        raise ExportError("nobody lives at the end, so there is no tree of the living; --format alife has all agents")
    ids = agents["agent_id"].to_numpy()
    is_ancestor = ancestry(tree, np.flatnonzero(tree.alive))
    subtrees: dict[int, Subtree] = {}
    children: dict[int, list[int]] = {}
    for i in np.flatnonzero(is_ancestor)[::-1].tolist():  # children are listed after their parents
        subtrees[i] = _life(tree, i, str(ids[i]), now, children.pop(i, []), subtrees)
        if tree.parent[i] >= 0:
            children.setdefault(int(tree.parent[i]), []).append(i)
    roots = [i for i in sorted(subtrees) if tree.parent[i] < 0]
    return "".join(f"{subtrees[i].text}:{subtrees[i].top - tree.birth[i]};\n" for i in roots).encode()


def picture(agents: pl.DataFrame, now: int, genes: tuple[str, ...], gene: str | None) -> bytes:
    """The tree of the living as a PNG picture, colored by a gene; see `hedon.figure.tree`.

    Args:
        agents: Agents of one world and species, by agent_id, as from `pedigree`.
        now: Step at which the pedigree ends.
        genes: Genome columns of the agents.
        gene: Column that sets the colors; None for the first.

    Raises:
        ExportError: The gene does not exist, or children have two parents, so that there is no tree.
    """
    tree = require_tree(agents)
    recorded = [name for name in genes if name in agents.columns and agents[name].is_not_null().any()]
    name = gene if gene is not None else recorded[0]
    if name not in recorded:
        hint = did_you_mean(name, recorded)
        raise ExportError(f"--color {brief(name)}: there is no such gene (there are {', '.join(recorded)}){hint}")
    weight = agents[name].cast(pl.Float64).fill_null(0.0).to_numpy()
    return png_bytes(draw_tree(tree, weight, name, now))


def has_two_parents(agents: pl.DataFrame) -> bool:
    """Whether some of these agents have two parents, so that their pedigree is not a tree."""
    return "mate_id" in agents.columns and agents["mate_id"].is_not_null().any()


def require_tree(agents: pl.DataFrame) -> Genealogy:
    """The pedigree of agents that have one parent each.

    Raises:
        ExportError: Children have two parents, so that there is no tree.
    """
    if has_two_parents(agents):
        raise ExportError("children of this run have two parents: there is no tree; --format alife has both parents")
    return genealogy(agents)


def _life(tree: Genealogy, i: int, name: str, now: int, children: list[int], subtrees: dict[int, Subtree]) -> Subtree:
    """The subtree that starts with the birth of agent `i`; `children` are those with living descendants."""
    subtree = Subtree(name, now) if tree.death[i] == ALIVE else None
    for child in sorted(children, key=lambda agent: tree.birth[agent], reverse=True):
        branch, step = subtrees.pop(child), int(tree.birth[child])
        if subtree is None:
            subtree = branch
        else:
            subtree = Subtree(f"({branch.text}:{branch.top - step},{subtree.text}:{subtree.top - step})", step)
    assert subtree is not None, "only ancestors of the living, and the living, are asked for"
    return subtree
