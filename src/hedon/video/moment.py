"""Moments of a world from the frames of its run: recorded ones, and interpolated ones between two frames."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from hedon.config.config import Config
from hedon.config.expression import gene_column
from hedon.config.schema.arena import walls
from hedon.record.reader import Run, open_run
from hedon.record.snapshot import Snapshot, own_bodies
from hedon.video.error import VideoError

EVEN_STEPS = 128
"""Largest distance between frames for which agents are interpolated [step]; over longer times they turn too often."""


@dataclass(frozen=True)
class Footage:
    """The frames of one world.

    Attributes:
        run: The run, which must have frames.
        config: Config of the run.
        world: Index of the world in the run.
        first: First recorded step.
        last: Last recorded step.
    """

    run: Run
    config: Config
    world: int
    first: int
    last: int

    def moments(self, first: int, last: int, speed: int) -> Iterator[Snapshot]:
        """Yields the world at `first`, `first + speed`, … up to `last`.

        Frames are read part by part, so a long run needs no more memory than a short one.

        Args:
            first: First moment [step].
            last: Last possible moment [step].
            speed: Steps from one moment to the next.

        Raises:
            RecordError: A frame is damaged.
        """
        recorded = self._recorded(first - self.run.manifest.frames, last + self.run.manifest.frames)
        before, after = next(recorded, None), next(recorded, None)
        for step in range(first, last + 1, speed):
            while after is not None and after.step <= step:
                before, after = after, next(recorded, None)
            if before is None:
                return
            yield blend(before, after, step)

    def lifetime(self, agent: int) -> tuple[int, int]:
        """The first and the last recorded step of an agent.

        Raises:
            VideoError: No frame contains this agent.
        """
        found = _steps(self.run, (pl.col("world") == self.world) & (pl.col("id") == agent))
        if found is None:
            raise VideoError(f"--follow {agent}: no frame has this agent; `hedon export agents` lists them all")
        return found

    def usual_energy(self) -> float:
        """The energy that one in twenty agents exceeds, used as the end of the color scale."""
        parts = self.run.frame_parts("world", "energy")
        quantile = pl.concat(rows.filter(pl.col("world") == self.world)["energy"] for rows in parts).quantile(0.95)
        return 40.0 if quantile is None else max(float(quantile), 40.0)

    def _recorded(self, first: int, last: int) -> Iterator[Snapshot]:
        kept = pl.DataFrame()
        for part in self.run.frame_parts():
            rows = part.filter((pl.col("world") == self.world) & pl.col("step").is_between(first, last))
            kept = pl.concat([kept, rows]) if len(kept) else rows
            *whole, kept = kept.partition_by("step", maintain_order=True) or [kept]
            yield from map(self._snapshot, whole)  # the rest of the last frame may be in the next part
        if len(kept):
            yield self._snapshot(kept)

    @cached_property
    def _genomes(self) -> pl.DataFrame:
        """The genes that set body parameters, of all agents, by column."""
        names = {gene_column(path) for species in self.config.species.values() for path in species.genome.set}
        return self.run.agents().filter(pl.col("world") == self.world).select("agent_id", *names)

    def _genes(self, ids: pl.Series) -> dict[str, NDArray[np.float32]]:
        """The genes of agents that set body parameters, by column; NaN if a species lacks one."""
        if not any(species.genome.set for species in self.config.species.values()):
            return {}
        rows = pl.DataFrame({"agent_id": ids}).join(self._genomes, on="agent_id", how="left", maintain_order="left")
        return {name: rows[name].to_numpy() for name in rows.columns if name != "agent_id"}

    def _snapshot(self, rows: pl.DataFrame) -> Snapshot:
        config, manifest = self.config, self.run.manifest
        species, foods = list(config.species), list(config.food)
        agents = rows.filter(pl.col("id").is_not_null()).sort("id")
        food = rows.filter(pl.col("id").is_null())
        bodies = list(config.species.values())
        of = np.array([species.index(kind) for kind in agents["kind"]], np.int32)
        obstacles = manifest.obstacle_places[self.world] if manifest.obstacle_places else np.zeros((0, 3, 2))
        return Snapshot(
            world=self.world,
            seed=manifest.seeds[self.world],
            step=rows["step"][0],
            agent_id=agents["id"].to_numpy(),
            **{name: agents[name].to_numpy() for name in ("x", "y", "angle", "energy")},
            rays=np.zeros((len(agents), 0, 0)),
            species=of,
            own=own_bodies(config, of, self._genes(agents["id"])),
            food_kind=np.array([foods.index(kind) for kind in food["kind"]], np.int32),
            food_x=food["x"].to_numpy(),
            food_y=food["y"].to_numpy(),
            walls=np.asarray(walls(config.arena), np.float32).reshape(-1, 4),
            obstacles=np.asarray(obstacles, np.float32),
            radius=np.array([each.body.radius for each in bodies]),
            ray_count=np.array([each.sensor.ray_count for each in bodies]),
            ray_length=np.array([each.sensor.ray_length for each in bodies]),
            ray_spread=np.array([each.sensor.ray_spread for each in bodies]),
            mouth_spread=np.array([each.sensor.mouth_spread for each in bodies]),
            mouth_center=np.array([each.sensor.mouth_center for each in bodies]),
            food_kinds=tuple(foods),
            species_names=tuple(species),
            food_radius=config.world.food_radius,
        )


def open_footage(folder: Path, seed: int | None = None) -> Footage:
    """Opens the frames of one world of a run.

    Args:
        folder: Folder of the run.
        seed: Seed of the world; None for the first.

    Raises:
        VideoError: The run has no frames, or no such world.
        RecordError: The folder is not a run, or a part of its frames is damaged.
    """
    run = open_run(folder)
    seeds = run.manifest.seeds
    if seed is not None and seed not in seeds:
        raise VideoError(f"--world {seed}: there is no such world; the run has seeds " + ", ".join(map(str, seeds)))
    world = 0 if seed is None else seeds.index(seed)
    found = _steps(run, pl.col("world") == world)
    if found is None:
        raise VideoError(f"{run.path} has no frames of this world: record them with `hedon run --frames 64`")
    return Footage(run, run.config, world, *found)


def _steps(run: Run, wanted: pl.Expr) -> tuple[int, int] | None:
    """The first and the last step of frames with matching rows."""
    parts = [rows.filter(wanted)["step"] for rows in run.frame_parts("world", "step", "id")]
    known = pl.concat([pl.Series("step", [], pl.Int64), *parts])
    return (int(known[0]), int(known[-1])) if len(known) else None


def blend(before: Snapshot, after: Snapshot | None, step: int) -> Snapshot:
    """The world at a step between two frames: agents in both frames move evenly, and all else stays as before.

    Args:
        before: The earlier frame.
        after: The later frame; None if there is none.
        step: The step [step].
    """
    if after is None or step <= before.step or after.step - before.step > EVEN_STEPS:
        return replace(before, step=step)
    share = (step - before.step) / (after.step - before.step)
    _, here, there = np.intersect1d(before.agent_id, after.agent_id, assume_unique=True, return_indices=True)
    moved = {}
    for name in ("x", "y", "angle"):
        change = getattr(after, name)[there] - getattr(before, name)[here]
        if name == "angle":
            change -= 2 * np.pi * np.round(change / (2 * np.pi))
        moved[name] = getattr(before, name).copy()
        moved[name][here] += share * change
    return replace(before, step=step, **moved)
