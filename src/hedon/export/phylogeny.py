"""The pedigree of a world for the tools of phylogenetics: ALife data standard, and Newick."""

from typing import NamedTuple

import numpy as np
import polars as pl

from hedon.analysis.descent.genealogy import ALIVE, Genealogy, ancestry, genealogy
from hedon.config.problem import nearest
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
    """A part of a tree of the living: its text, and the step of its uppermost fork or tip."""

    text: str
    top: int


def pedigree(run: Run, seed: int | None = None, species: str | None = None) -> pl.DataFrame:
    """The agents of one world, by agent_id.

    Returns:
        The table `agents`; of a branch, those who lived when it began are roots unless their parents did too.

    Raises:
        ExportError: there is no such world or species, or it is not said which world; or ancestors are missing.
        RecordError: a part of the table is damaged.
    """
    seeds = run.manifest.seeds
    wanted = seeds[0] if seed is None and len(seeds) == 1 else seed
    if wanted not in seeds:
        which = "say which world" if seed is None else f"--world {seed}: there is no such world"
        raise ExportError(f"{which}: the run has seeds " + ", ".join(map(str, seeds)))
    agents = run.agents().filter(pl.col("seed") == wanted).sort("agent_id")
    if species is not None:
        if species not in run.columns.species:
            there = ", ".join(run.columns.species)
            raise ExportError(f"--species {brief(species)}: there is no such species (there are {there})")
        agents = agents.filter(pl.col("species") == species) if run.columns.several else agents
    if run.manifest.parent is not None:
        agents = _rooted(agents, run.manifest.parent.step)
    gaps = genealogy(agents).gaps
    if gaps:
        raise ExportError(f"the parents of {gaps} agents are not recorded: a part of the run is missing")
    return agents


def _rooted(agents: pl.DataFrame, begin: int) -> pl.DataFrame:
    """The agents of a branch without parents who had died when it began [step]."""
    known = agents["agent_id"].implode()
    roots = (pl.col("birth_step") <= begin) & ~pl.col("parent_id").is_in(known)
    lost = [name for name in ("parent_id", "mate_id") if name in agents.columns]
    return agents.with_columns(pl.when(~roots).then(pl.col(name)).alias(name) for name in lost)


def last_step(run: Run, agents: pl.DataFrame) -> int:
    """The step up to which a pedigree reaches: the end of its world, or its last event if the run has not ended."""
    done = run.manifest.steps_done[run.manifest.seeds.index(agents["seed"][0])]
    events = agents.select(pl.max_horizontal(pl.col("birth_step").max(), pl.col("death_step").max())).item()
    return max(done, events)


def alife_table(agents: pl.DataFrame, genes: tuple[str, ...]) -> pl.DataFrame:
    """The pedigree in the ALife data standard for phylogenies (Lalejini et al. 2019).

    Returns:
        `id`; `ancestor_list`, "[NONE]" for founders, with both parents where there are two; `origin_time` and
        `destruction_time` [step], "inf" for who lives; then the species, where there are several, and the genes.
    """
    parent = pl.col("parent_id").cast(pl.String).fill_null("NONE")
    if "mate_id" in agents.columns:
        both = pl.concat_str("parent_id", "mate_id", separator=",")
        parent = pl.when(pl.col("mate_id").is_null()).then(parent).otherwise(both)
    return agents.select(
        pl.col("agent_id").alias("id"),
        pl.concat_str(pl.lit("["), parent, pl.lit("]")).alias("ancestor_list"),
        pl.col("birth_step").alias("origin_time"),
        pl.col("death_step").cast(pl.String).fill_null("inf").alias("destruction_time"),
        *[name for name in ("species", *genes) if name in agents.columns],
    )


def newick(agents: pl.DataFrame, now: int) -> bytes:
    """Trees of the living in Newick's format, one on a line for each founder with living descendants.

    A tip is an agent that lives, called by its agent_id. A fork is a birth: one branch is the child's, the other the
    parent's further life. Births of whose two branches one has died out are left out. Lengths are in steps, so that all
    tips of a tree lie at `now`; the length of a root is the time from its founder's birth to the first fork.

    Raises:
        ExportError: children have two parents, so that there is no tree; or nobody lives.
    """
    tree = require_tree(agents)
    if not tree.alive.any():
        raise ExportError("nobody lives at the end, so there is no tree of the living; --format alife has all agents")
    ids = agents["agent_id"].to_numpy()
    kept = ancestry(tree, np.flatnonzero(tree.alive))
    found: dict[int, Subtree] = {}
    young: dict[int, list[int]] = {}
    for i in np.flatnonzero(kept)[::-1].tolist():  # children come after their parents
        found[i] = _life(tree, i, str(ids[i]), now, young.pop(i, []), found)
        if tree.parent[i] >= 0:
            young.setdefault(int(tree.parent[i]), []).append(i)
    roots = [i for i in sorted(found) if tree.parent[i] < 0]
    return "".join(f"{found[i].text}:{found[i].top - tree.birth[i]};\n" for i in roots).encode()


def picture(agents: pl.DataFrame, now: int, genes: tuple[str, ...], gene: str | None) -> bytes:
    """The tree of the living as a picture (PNG), colored by a gene; see `hedon.figure.tree`.

    Raises:
        ExportError: there is no such gene, or children have two parents, so that there is no tree.
    """
    tree = require_tree(agents)
    known = [name for name in genes if name in agents.columns and agents[name].is_not_null().any()]
    name = gene if gene is not None else known[0]
    if name not in known:
        near = nearest(name, known)
        hint = f"; did you mean {near}?" if near else ""
        raise ExportError(f"--color {brief(name)}: there is no such gene (there are {', '.join(known)}){hint}")
    weight = agents[name].cast(pl.Float64).fill_null(0.0).to_numpy()
    return png_bytes(draw_tree(tree, weight, name, now))


def has_two_parents(agents: pl.DataFrame) -> bool:
    """Whether some children of these have two parents, so that their pedigree is no tree."""
    return "mate_id" in agents.columns and agents["mate_id"].is_not_null().any()


def require_tree(agents: pl.DataFrame) -> Genealogy:
    """The pedigree of agents who have one parent each.

    Raises:
        ExportError: children have two parents, so that there is no tree.
    """
    if has_two_parents(agents):
        raise ExportError("children of this run have two parents: there is no tree; --format alife has both parents")
    return genealogy(agents)


def _life(tree: Genealogy, i: int, name: str, now: int, young: list[int], found: dict[int, Subtree]) -> Subtree:
    """The subtree that begins with the birth of agent `i`; `young` are its children with living descendants."""
    rest = Subtree(name, now) if tree.death[i] == ALIVE else None
    for child in sorted(young, key=lambda each: tree.birth[each], reverse=True):
        below, step = found.pop(child), int(tree.birth[child])
        if rest is None:
            rest = below
        else:
            rest = Subtree(f"({below.text}:{below.top - step},{rest.text}:{rest.top - step})", step)
    assert rest is not None, "only ancestors of the living, and the living, are asked for"
    return rest
