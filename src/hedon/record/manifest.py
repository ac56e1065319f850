"""The manifest: how a run was made, in enough detail to repeat it, to judge it and to read its tables."""

import json
import re
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from hedon.record.atomic import write_atomically
from hedon.record.error import RecordError
from hedon.record.folder import MANIFEST
from hedon.record.schema import FORMAT_VERSION, Columns
from hedon.text import LINE, brief

if TYPE_CHECKING:
    from pydantic import TypeAdapter

MAX_COLUMNS = 1000
"""Largest number of food kinds and neutral genes in a manifest; each is a column of the tables."""
MAX_NUMBER = 2**63 - 1

STATUSES = ("running", "finished", "interrupted", "failed")


@dataclass(frozen=True)
class Session:
    """One session of a run, from start to end; a run that was resumed has several.

    Attributes:
        started, ended: ISO 8601, UTC; `ended` is None if the session is still running, or was killed.
        from_step: step at which it began [step].
        threads, backend, hedon_version, git_revision, command_line: as in the manifest, at the time.
    """

    started: str | None
    from_step: int
    threads: int | None = None
    backend: str | None = None
    hedon_version: str | None = None
    git_revision: str | None = None
    command_line: tuple[str, ...] = ()
    ended: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "command_line", tuple(self.command_line))


@dataclass(frozen=True)
class RuleSource:
    """The source text of a rule in Python.

    Attributes:
        file: Name of the file, as in the config of the run.
        name: Name of the function.
        digest: First 16 hexadecimal digits of the SHA-256 of the text.
        text: Text of the whole file.
        path: Original path of the file; empty in old manifests.
    """

    file: str
    name: str
    digest: str
    text: str
    path: str = ""

    @property
    def place(self) -> str:
        """The value of a config's rule that is pinned to this text."""
        return f"{self.file}:{self.name}@{self.digest}"


@dataclass(frozen=True)
class ChannelNote:
    """A channel: a number of an agent that is observed, paid for, or used as a gate.

    Attributes:
        species: name of the species.
        use: "observed", "paid" or "gate".
        name: of the channel.
        gene: what weighs it in the reward; empty for none.
        scale: what it is divided by, or its factor in the reward.
        unit: of the number as it is.
        meaning: as a phrase.
    """

    species: str
    use: str
    name: str
    gene: str
    scale: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class Parent:
    """The run that a branch started from.

    Attributes:
        folder: Name of the parent's folder.
        config_digest: Digest of the parent's config.
        step: Step of the checkpoint from which the branch started [step].
        seed: Seed of the parent's world from which all worlds of the branch continue, each with a new seed; None if
            each world continues its own past with its own seed.
    """

    folder: str
    config_digest: str
    step: int
    seed: int | None = None


@dataclass(frozen=True)
class Manifest:
    """The manifest of a run. Update it with `dataclasses.replace`.

    Attributes:
        food_kinds: names, in the order of the config; fixes the columns of the tables.
        neutral_count: number of neutral genes; fixes the columns of the tables.
        seeds: one per world.
        species: names, in the order of the config.
        rewards: names of the genes that have an effect on the reward; empty for one per food kind, and action.
        prey: names of the species that are eaten, by others or by their own kind.
        steps_asked: total steps that each world is to run [step].
        preset: name of the preset that the config is based on.
        fidelity: "corrected", "released" or "as_printed".
        name: name of the config: by default the preset, or the file without its ending.
        modified: whether any setting differs from the preset with the fidelity; None in old manifests.
        config_digest: digest of the resolved config.
        schema: version of the schema that this digest is of; None before 1.0.
        backend: what computed: an instruction set, or a device.
        threads: threads that the engine used.
        hedon_version, python, platform, cpu_count, git_revision, git_modified, command_line: the
            provenance; the revision is that of hedon's source checkout, None for an installed package.
        started, ended: ISO 8601, UTC, of the first start and the last end; `ended` is None until it ends.
        status: one of `STATUSES`.
        steps_done: steps completed, per world [step].
        extinct_steps: per world, the steps completed when the last agent died, or None.
        run_seconds: time spent on steps, for steps per second; None if it was not measured [s]. Steps that were
            removed when the run was resumed do not count.
        food_colors: color per food kind for figures, "#rrggbb"; empty for the default colors.
        frames: steps between two frames; 0 for no frames [step].
        sessions: one for each time that the run was started or resumed.
        parent: for a branch, the run that it started from: its folder, config_digest and step, and the seed of
            the world that has several futures, or null.
        world_digests: per world, the digest of its last state, as `World.digest()` gives it; empty until the end.
        records_digest: digest of all rows of all tables, no matter which parts hold them; None until the end.
        fault: the engine's message if the run stopped at a fault; None otherwise.
        obstacles: whether the worlds have obstacles; fixes the columns of the tables.
        obstacle_places: per world, the corners of each obstacle [u]; empty without obstacles.
        mating: whether some species has two parents.
        stores: names of the stores beside energy, of all species.
        levels: whether agents and frames have a column for each of them; not before 1.0.
        channels: what agents observe beside rays and touch, are paid for, and what opens the gate of their reward.
        causes: whether agents die of more than age and energy; None in old manifests.
        rules: the rules in Python, with their texts.
        format_version: of the run folder.
    """

    food_kinds: tuple[str, ...]
    neutral_count: int
    seeds: tuple[int, ...]
    steps_asked: int
    preset: str | None = None
    fidelity: str | None = None
    name: str | None = None
    modified: bool | None = None
    config_digest: str | None = None
    schema: str | None = None
    backend: str | None = None
    threads: int | None = None
    hedon_version: str | None = None
    python: str | None = None
    platform: str | None = None
    cpu_count: int | None = None
    git_revision: str | None = None
    git_modified: bool | None = None
    command_line: tuple[str, ...] = ()
    started: str | None = None
    ended: str | None = None
    status: str = "running"
    steps_done: tuple[int, ...] = ()
    extinct_steps: tuple[int | None, ...] = ()
    run_seconds: float | None = None
    food_colors: tuple[str, ...] = ()
    frames: int = 0
    sessions: tuple[Session, ...] = ()
    parent: Parent | None = None
    world_digests: tuple[str, ...] = ()
    records_digest: str | None = None
    fault: str | None = None
    species: tuple[str, ...] = ("agent",)
    rewards: tuple[str, ...] = ()
    prey: tuple[str, ...] = ()
    obstacles: bool = False
    mating: bool = False
    stores: tuple[str, ...] = ()
    levels: bool = False
    channels: tuple[ChannelNote, ...] = ()
    causes: bool | None = None
    obstacle_places: tuple[tuple[tuple[tuple[float, float], ...], ...], ...] = ()
    rules: tuple[RuleSource, ...] = ()
    format_version: int = FORMAT_VERSION

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, list):
                object.__setattr__(self, field.name, tuple(value))
        for problem in self._problems():
            raise RecordError(f"manifest: {problem}")

    @property
    def columns(self) -> Columns:
        """The properties that determine the columns of the tables."""
        return Columns(**{field.name: getattr(self, field.name) for field in fields(Columns)})

    def _problems(self) -> Iterator[str]:
        """Values that no run has, or from which tables and figures cannot be made."""
        if self.status not in STATUSES:
            yield f"status {brief(repr(self.status))} is not one of {', '.join(STATUSES)}"
        for kind in self.food_kinds:
            if not re.fullmatch(r"[a-z][a-z0-9_]{0,31}", kind):
                yield f"food_kinds: {brief(repr(kind))} is not the name of a food kind"
        for name in (*self.species, *self.rewards, *self.prey, *self.stores):
            if not re.fullmatch(r"[a-z][a-z0-9_]{0,63}", name):
                yield f"species, rewards, stores: {brief(repr(name))} is not the name of a species, a gene or a store"
        for color in self.food_colors:
            if not re.fullmatch(r"#[0-9a-fA-F]{6}", color):
                yield f'food_colors: {brief(repr(color))} is not a color "#rrggbb"'
        for name, low, high, value in (
            ("neutral_count", 0, MAX_COLUMNS, self.neutral_count),
            ("food_kinds", 0, MAX_COLUMNS, len(self.food_kinds)),
            ("steps_asked", 0, MAX_NUMBER, self.steps_asked),
            ("frames", 0, MAX_NUMBER, self.frames),
            *(("seeds", 0, MAX_NUMBER, seed) for seed in self.seeds),
            *(("steps_done", 0, MAX_NUMBER, steps) for steps in self.steps_done),
        ):
            if not low <= value <= high:
                yield f"{name} = {brief(str(value))}: must be from {low} to {high}"


def save_manifest(folder: Path, manifest: Manifest) -> None:
    """Writes the manifest atomically.

    Args:
        folder: Folder of the run.
        manifest: The manifest to write.

    Raises:
        RecordError: It cannot be written.
    """
    text = json.dumps(asdict(manifest), indent=2, ensure_ascii=False) + "\n"
    try:
        write_atomically(folder / MANIFEST, lambda file: file.write(text.encode()))
    except OSError as error:
        raise RecordError(f"cannot write the manifest in {folder}: {error}") from error


def load_manifest(folder: Path) -> Manifest:
    """Reads the manifest of a run. Unknown fields are ignored.

    Raises:
        RecordError: There is no manifest, it is damaged, or its format is newer.
    """
    path = folder / MANIFEST
    try:
        content = path.read_bytes()
        version = json.loads(content)["format_version"]
        manifest = None if version > FORMAT_VERSION else _manifests().validate_json(content, strict=True)
    except OSError as error:
        raise RecordError(f"cannot read the manifest {path}: {error}") from error
    except (ValueError, KeyError, TypeError, RecursionError, RecordError) as error:
        text = f"{error!r}" if isinstance(error, KeyError) else " ".join(str(error).split())
        raise RecordError(f"damaged manifest {path}: {brief(text, 2 * LINE)}") from error
    if manifest is None:
        raise RecordError(
            f"{path}: format {version} is newer than this hedon can read ({FORMAT_VERSION}): update hedon"
        )
    return manifest


@cache
def _manifests() -> "TypeAdapter[Manifest]":
    from pydantic import TypeAdapter

    return TypeAdapter(Manifest)
