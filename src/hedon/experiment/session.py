"""The manifest that a session of a run writes at its start and at its end."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Protocol

from hedon.config.config import Config
from hedon.config.dump import SCHEMA, digest
from hedon.config.layout import layouts
from hedon.config.load import is_modified
from hedon.config.schema.evolution import GATED
from hedon.experiment.plan import RunPlan
from hedon.experiment.simulation import Simulation
from hedon.experiment.world import World
from hedon.record.digest import records_digest
from hedon.record.manifest import ChannelNote, Manifest, Session
from hedon.record.provenance import collect_provenance, utc_now
from hedon.record.schema import columns_of
from hedon.record.writer import Writer


class Planned(Protocol):
    """What a manifest needs from a plan: a `RunPlan`, or worlds that another program drives."""

    @property
    def config(self) -> Config:
        """Settings of the worlds."""
        ...

    @property
    def seeds(self) -> tuple[int, ...]:
        """One seed per world."""
        ...

    @property
    def steps(self) -> int:
        """Total steps of each world."""
        ...

    @property
    def frames(self) -> int:
        """Steps between two frames; 0 for none."""
        ...


def first_manifest(plan: Planned, simulation: Simulation, from_step: int = 0, worlds: Sequence[World] = ()) -> Manifest:
    """Manifest of a run that starts now, at step 0 or, for a branch, at a later one.

    Args:
        plan: Plan of the run.
        simulation: Simulation made from the plan.
        from_step: Step at which it starts [step].
        worlds: Worlds to record; all if empty.
    """
    config, worlds = plan.config, worlds or simulation.worlds
    manifest = Manifest(
        **asdict(columns_of(config)),
        seeds=plan.seeds,
        steps_asked=plan.steps,
        preset=config.preset,
        fidelity=config.fidelity,
        name=config.name,
        modified=is_modified(config),
        config_digest=digest(config),
        schema=SCHEMA,
        backend=simulation.engine.backend,
        threads=simulation.engine.threads,
        steps_done=tuple(world.step for world in worlds),
        extinct_steps=tuple(None for _ in plan.seeds),
        food_colors=tuple(food.color for food in config.food.values()),
        frames=plan.frames,
        channels=tuple(channel_notes(config)),
        obstacle_places=_places(worlds) if config.obstacle.count else (),
        rules=tuple(rule.source for rule in simulation.rules),
        **collect_provenance(),
    )
    return replace(manifest, sessions=(_session(manifest, from_step),))


def channel_notes(config: Config) -> Iterator[ChannelNote]:
    """Channels of each species: those observed besides rays and touch, those of the reward, and the gate."""
    for species, layout in layouts(config).items():
        for channel in layout.observed:
            yield ChannelNote(species, "observed", channel.name, "", channel.scale, channel.unit, channel.meaning)
        reward = config.species[species].reward
        for term in () if reward.rule else layout.terms:
            channel = term.channel
            yield ChannelNote(species, "paid", channel.name, term.gene, term.coef, channel.unit, channel.meaning)
        if reward.family in GATED and not reward.rule:
            yield ChannelNote(species, "gate", layout.gate.name, "", 1.0, layout.gate.unit, layout.gate.meaning)


def _places(worlds: Sequence[World]) -> tuple[tuple[tuple[tuple[float, float], ...], ...], ...]:
    """Corners of the obstacles of each world, rounded to a thousandth of a unit, for pictures."""
    return tuple(
        tuple(tuple((round(x, 3), round(y, 3)) for x, y in corners) for corners in world.obstacles.tolist())
        for world in worlds
    )


def next_manifest(manifest: Manifest, plan: RunPlan, simulation: Simulation, from_step: int) -> Manifest:
    """Manifest of a run that continues now: as before, with a new session at the end of the list.

    Args:
        manifest: Manifest at the end of the session before.
        plan: Plan with the total number of steps from now on.
        simulation: Simulation made from the plan, at `from_step`.
        from_step: Step at which it continues [step].
    """
    current = replace(
        manifest,
        backend=simulation.engine.backend,
        threads=simulation.engine.threads,
        **collect_provenance(),
    )
    return replace(
        manifest,
        status="running",
        ended=None,
        steps_asked=plan.steps,
        world_digests=(),
        records_digest=None,
        fault=None,
        sessions=(*manifest.sessions, _session(current, from_step)),
    )


@dataclass(frozen=True, slots=True)
class WorldEnd:
    """Where a world stopped, for the manifest.

    Attributes:
        step: Steps completed [step].
        extinct_step: Step of its extinction; None if any agent is alive [step].
        digest: Digest of its state; empty after a fault.
    """

    step: int
    extinct_step: int | None
    digest: str


def end_of(world: World, *, failed: bool = False) -> WorldEnd:
    """Current end of a world."""
    return WorldEnd(world.step, world.extinct_step, "" if failed else world.digest())


def last_manifest(
    manifest: Manifest, ends: Sequence[WorldEnd], status: str, seconds: float, writer: Writer
) -> Manifest:
    """Saves and returns the manifest of a session that ends now. Unless the session failed, first writes all rows to
    disk.

    Args:
        manifest: Manifest of the session so far.
        ends: Ends of its worlds.
        status: "finished", "interrupted" or "failed".
        seconds: Time spent on steps, over all sessions [s].
        writer: Writer that is open on the run's folder.

    Raises:
        RecordError: The rows or the manifest cannot be written.
    """
    now = utc_now()
    digests: tuple[str, ...] = ()
    records = None
    if status != "failed":
        writer.flush()
        digests = tuple(end.digest for end in ends)
        records = records_digest(writer.folder, manifest.columns)
    manifest = replace(
        manifest,
        status=status,
        ended=now,
        steps_done=tuple(end.step for end in ends),
        extinct_steps=tuple(end.extinct_step for end in ends),
        run_seconds=seconds,
        world_digests=digests,
        records_digest=records,
        sessions=(*manifest.sessions[:-1], replace(manifest.sessions[-1], ended=now)),
    )
    writer.save_manifest(manifest)
    return manifest


def _session(manifest: Manifest, from_step: int) -> Session:
    return Session(
        started=manifest.started,
        from_step=from_step,
        threads=manifest.threads,
        backend=manifest.backend,
        hedon_version=manifest.hedon_version,
        git_revision=manifest.git_revision,
        command_line=manifest.command_line,
    )
