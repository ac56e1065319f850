"""Checks the table `agents`: every agent appears once, with known parents and a possible life."""

from collections.abc import Collection, Iterator
from itertools import islice, pairwise

import polars as pl

from hedon.check.finding import Finding, break_rules
from hedon.record.manifest import Manifest
from hedon.record.schema import CAUSES

_KEYS = ("world", "agent_id")


def check_agents(
    agents: pl.DataFrame, manifest: Manifest, pairs: Collection[str] | None, *, complete: bool
) -> Iterator[Finding]:
    """Checks the agents of a run.

    Args:
        agents: Rows of the table `agents`.
        manifest: Manifest of the run.
        pairs: Species whose children have two parents; None if unknown.
        complete: Whether all parts of the table are present.
    """
    yield from break_rules(agents, "agents", _KEYS, _life_rules(manifest))
    unique = agents.unique(_KEYS, keep="first", maintain_order=True)
    family = _with_parents(unique, manifest)
    yield from break_rules(family, "agents", _KEYS, _family_rules(manifest, pairs, complete))
    yield from _cycles(unique)
    if complete:
        yield from _gaps(unique, manifest)


def first_step(manifest: Manifest) -> int:
    """The step at which the tables of a run start: 0 unless it is a branch."""
    return manifest.sessions[0].from_step if manifest.parent and manifest.sessions else 0


def world_rules(manifest: Manifest) -> dict[str, pl.Expr]:
    """Rules for the world and seed of a row."""
    worlds = pl.col("world").is_between(0, len(manifest.seeds) - 1)
    seed = pl.col("world").replace_strict(dict(enumerate(manifest.seeds)), default=None, return_dtype=pl.Int64)
    return {
        "the run has no such world": ~worlds,
        "the seed is not the one in the manifest": pl.col("seed") != seed,
    }


def species_rules(manifest: Manifest) -> dict[str, pl.Expr]:
    """Rules for the species of a row; none if rows have no species."""
    return (
        {"the run has no such species": ~pl.col("species").is_in(manifest.species)} if manifest.columns.several else {}
    )


def _life_rules(manifest: Manifest) -> dict[str, pl.Expr]:
    rules = {
        **world_rules(manifest),
        **species_rules(manifest),
        "more than one row has this id": pl.struct(_KEYS).is_duplicated(),
        "died before its birth or in the same step": pl.col("death_step") <= pl.col("birth_step"),
        "has negative energy": (pl.col("energy") < 0) | (pl.col("birth_energy") < 0),
        "has no parent but is not a founder": pl.col("parent_id").is_null()
        & ((pl.col("generation") != 0) | (pl.col("birth_step") != 0)),
    }
    if manifest.columns.has_causes:
        dead, cause = pl.col("death_step").is_not_null(), pl.col("cause")
        rules["its cause of death is none that there is"] = ~cause.is_in(CAUSES)
        rules["died without a cause, or has one but lives"] = dead != cause.is_not_null()
    if manifest.status != "running" and len(manifest.steps_done) == len(manifest.seeds):
        last_step = pl.col("world").replace_strict(
            dict(enumerate(manifest.steps_done)), default=None, return_dtype=pl.Int64
        )
        rules["was born or died after the last step of the run"] = (
            pl.max_horizontal("birth_step", "death_step") > last_step
        )
    return rules


def _family_rules(manifest: Manifest, pairs: Collection[str] | None, complete: bool) -> dict[str, pl.Expr]:
    """Rules for an agent and its parents. Agents that died before a branch started are only in the parent run."""
    child, has_recorded_parent = pl.col("parent_id").is_not_null(), pl.col("parent_birth").is_not_null()
    child_count, start_step = pl.col("counted"), first_step(manifest)
    # The records of a killed run may lack one of two parents.
    has_all_parents = has_recorded_parent & (pl.col("mate_id").is_null() | pl.col("mate_generation").is_not_null())
    rules = {
        "its parent is itself or a younger agent": pl.col("parent_id") >= pl.col("agent_id"),
        "its generation is not one more than its parents'": has_all_parents
        & (pl.col("generation") != pl.max_horizontal("parent_generation", "mate_generation") + 1),
        "was born before its parent or in the same step": pl.col("birth_step") <= pl.col("parent_birth"),
        "was born after its parent died": pl.col("birth_step") > pl.col("parent_death"),
        "its parents are of another species": (pl.col("parent_species") != pl.col("species"))
        | (pl.col("mate_species") != pl.col("species")),
        "its two parents are one": pl.col("mate_id") == pl.col("parent_id"),
        "was born when its second parent did not live": (pl.col("birth_step") > pl.col("mate_death"))
        | (pl.col("birth_step") <= pl.col("mate_birth")),
    }
    if pairs is not None:
        # A branch may have changed the mating rule, so agents born before its start follow the old one.
        needs_two, is_new = pl.col("species").is_in(list(pairs)), pl.col("birth_step") > start_step
        rules["has a parent but no second one"] = is_new & needs_two & child & pl.col("mate_id").is_null()
        rules["has two parents, but its species has one"] = is_new & ~needs_two & pl.col("mate_id").is_not_null()
    if complete:
        rules["its parent is missing"] = child & ~has_recorded_parent & (pl.col("birth_step") > start_step)
        fewer = pl.col("children") < child_count
        born_here = (pl.col("birth_step") > start_step) | (start_step == 0)
        rules["its number of children is not the number of agents that name it as parent"] = fewer | (
            born_here & (pl.col("children") != child_count)
        )
    return rules


def _with_parents(agents: pl.DataFrame, manifest: Manifest) -> pl.DataFrame:
    """Adds to each agent the data of its parents, and the number of agents that list it as a parent."""
    if "species" not in agents.columns:
        agents = agents.with_columns(species=pl.lit(manifest.species[0], pl.String))
    family = agents if "mate_id" in agents.columns else agents.with_columns(mate_id=pl.lit(None, pl.Int64))
    ids = pl.concat(
        family.drop_nulls(column).select("world", agent_id=column).cast({"agent_id": pl.Int64})
        for column in ("parent_id", "mate_id")
    )
    for role in ("parent", "mate"):
        parents = agents.select(
            "world",
            pl.col("agent_id").alias(f"{role}_id"),
            pl.col("generation").alias(f"{role}_generation"),
            pl.col("birth_step").alias(f"{role}_birth"),
            pl.col("death_step").alias(f"{role}_death"),
            pl.col("species").alias(f"{role}_species"),
        )
        family = family.join(parents, on=["world", f"{role}_id"], how="left", maintain_order="left")
    counts = ids.group_by("world", "agent_id").agg(counted=pl.len())
    family = family.join(counts, on=list(_KEYS), how="left", maintain_order="left")
    return family.with_columns(pl.col("counted").fill_null(0).cast(pl.Int64))


def _cycles(agents: pl.DataFrame) -> Iterator[Finding]:
    """Agents that are their own ancestors. Every cycle has an agent whose parent is not older."""
    suspects = agents.filter(pl.col("parent_id") >= pl.col("agent_id"))
    if not suspects.height:
        return
    rows = agents.drop_nulls("parent_id").select("world", "agent_id", "parent_id").iter_rows()
    parent = {(world, agent): ancestor for world, agent, ancestor in rows}
    for world, start in suspects.select(_KEYS).iter_rows():
        path = [start]
        while (parent_id := parent.get((world, path[-1]))) is not None and parent_id not in path:
            path.append(parent_id)
        if parent_id == start:
            circle = " → ".join(map(str, [*path, start]))
            yield Finding("agents", f"world {world}: an agent is its own ancestor: {circle}")
            return


def _gaps(agents: pl.DataFrame, manifest: Manifest) -> Iterator[Finding]:
    """Missing IDs, if later ones are recorded."""
    start_step = first_step(manifest)
    for world in range(len(manifest.seeds)):
        world_agents = agents.filter(pl.col("world") == world, (pl.col("birth_step") > start_step) | (start_step == 0))
        ids = world_agents["agent_id"].sort()
        if not ids.len():
            continue
        start = 0 if start_step == 0 else int(ids[0])
        # IDs in a damaged file may be any number, so this loops over rows and not over the IDs between them.
        recorded_ids = [start - 1, *ids.unique().sort().to_list()]
        missing = recorded_ids[-1] + 1 - start - (len(recorded_ids) - 1)
        if missing:
            between = (missing_id for low, high in pairwise(recorded_ids) for missing_id in range(low + 1, high))
            examples = ", ".join(map(str, islice(between, 5))) + (" …" if missing > 5 else "")
            yield Finding(
                "agents", f"world {world}: {missing:,} agents are missing, though later ones are there: {examples}"
            )
