"""The table `agents`: every agent once, of known descent, with a life that can have been."""

from collections.abc import Iterator

import polars as pl

from hedon.check.finding import Finding, break_rules
from hedon.record.manifest import Manifest

_KEYS = ("world", "agent_id")


def check_agents(agents: pl.DataFrame, manifest: Manifest, *, complete: bool) -> Iterator[Finding]:
    """What is wrong with the agents of a run.

    Args:
        agents: The dead and the living.
        manifest: Of the run; a branch's tables begin at its first session's step.
        complete: Whether all agents up to the last step must be there.
    """
    yield from break_rules(agents, "agents", _KEYS, _life_rules(manifest))
    unique = agents.unique(_KEYS, keep="first", maintain_order=True)
    family = _with_parents(unique)
    yield from break_rules(family, "agents", _KEYS, _family_rules(manifest, complete))
    yield from _cycles(unique)
    if complete:
        yield from _gaps(unique, manifest)


def first_step(manifest: Manifest) -> int:
    """The step at which the tables of a run begin: 0 unless it is a branch."""
    return manifest.sessions[0].from_step if manifest.parent and manifest.sessions else 0


def world_rules(manifest: Manifest) -> dict[str, pl.Expr]:
    """Rows of worlds that the run does not have, or with the seed of another."""
    worlds = pl.col("world").is_between(0, len(manifest.seeds) - 1)
    seed = pl.col("world").replace_strict(dict(enumerate(manifest.seeds)), default=None, return_dtype=pl.Int64)
    return {
        "of a world that the run does not have": ~worlds,
        "another seed than the world has in the manifest": pl.col("seed") != seed,
    }


def _life_rules(manifest: Manifest) -> dict[str, pl.Expr]:
    rules = {
        **world_rules(manifest),
        "more than one row of the same id": pl.struct(_KEYS).is_duplicated(),
        "died no later than it was born": pl.col("death_step") <= pl.col("birth_step"),
        "holds less energy than none": (pl.col("energy") < 0) | (pl.col("birth_energy") < 0),
        "no founder, and yet without a parent": pl.col("parent_id").is_null()
        & ((pl.col("generation") != 0) | (pl.col("birth_step") != 0)),
    }
    if manifest.status != "running" and len(manifest.steps_done) == len(manifest.seeds):
        last = pl.col("world").replace_strict(dict(enumerate(manifest.steps_done)), default=None, return_dtype=pl.Int64)
        rules["born or died after the last step of the run"] = pl.max_horizontal("birth_step", "death_step") > last
    return rules


def _family_rules(manifest: Manifest, complete: bool) -> dict[str, pl.Expr]:
    """Rules on an agent beside its parent. In a branch, those who had died before it stand in the parent's run."""
    child, known = pl.col("parent_id").is_not_null(), pl.col("parent_birth").is_not_null()
    counted, begun = pl.col("counted"), first_step(manifest)
    rules = {
        "names itself, or one younger, as its parent": pl.col("parent_id") >= pl.col("agent_id"),
        "another generation than one more than its parent's": pl.col("generation") != pl.col("parent_generation") + 1,
        "born no later than its parent": pl.col("birth_step") <= pl.col("parent_birth"),
        "born after its parent died": pl.col("birth_step") > pl.col("parent_death"),
    }
    if complete:
        rules["has a parent that is not there"] = child & ~known & (pl.col("birth_step") > begun)
        fewer = pl.col("children") < counted
        born_here = (pl.col("birth_step") > begun) | (begun == 0)
        rules["another number of children than it says"] = fewer | (born_here & (pl.col("children") != counted))
    return rules


def _with_parents(agents: pl.DataFrame) -> pl.DataFrame:
    parents = agents.select(
        "world",
        parent_id="agent_id",
        parent_generation="generation",
        parent_birth="birth_step",
        parent_death="death_step",
    )
    counts = agents.drop_nulls("parent_id").group_by("world", agent_id="parent_id").agg(counted=pl.len())
    family = agents.join(parents, on=["world", "parent_id"], how="left", maintain_order="left")
    family = family.join(counts, on=list(_KEYS), how="left", maintain_order="left")
    return family.with_columns(pl.col("counted").fill_null(0).cast(pl.Int64))


def _cycles(agents: pl.DataFrame) -> Iterator[Finding]:
    """Agents that are their own ancestors. Only a parent that is not older can begin a cycle."""
    suspects = agents.filter(pl.col("parent_id") >= pl.col("agent_id"))
    if not suspects.height:
        return
    rows = agents.drop_nulls("parent_id").select("world", "agent_id", "parent_id").iter_rows()
    parent = {(world, agent): ancestor for world, agent, ancestor in rows}
    for world, start in suspects.select(_KEYS).iter_rows():
        path = [start]
        while (above := parent.get((world, path[-1]))) is not None and above not in path:
            path.append(above)
        if above == start:
            circle = " → ".join(map(str, [*path, start]))
            yield Finding("agents", f"world {world}: a cycle, in which an agent is its own ancestor: {circle}")
            return


def _gaps(agents: pl.DataFrame, manifest: Manifest) -> Iterator[Finding]:
    """Ids that were never recorded, though later ones were."""
    begun = first_step(manifest)
    for world in range(len(manifest.seeds)):
        mine = agents.filter(pl.col("world") == world, (pl.col("birth_step") > begun) | (begun == 0))
        ids = mine["agent_id"].sort()
        if not ids.len():
            continue
        start = 0 if begun == 0 else int(ids[0])
        missing = sorted(set(range(start, int(ids[-1]))) - set(ids.to_list()))
        if missing:
            shown = ", ".join(map(str, missing[:5])) + (" …" if len(missing) > 5 else "")
            yield Finding(
                "agents", f"world {world} lacks {len(missing):,} agents, though later ones are there: {shown}"
            )
