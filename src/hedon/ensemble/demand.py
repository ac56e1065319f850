"""Specifies the worlds that are needed: settings, seeds and steps, for all machines or for one of several."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from hedon.config import Config
from hedon.config.load import changed_settings
from hedon.config.problem import format_value
from hedon.ensemble.error import EnsembleError
from hedon.record.founder import Founders
from hedon.record.manifest import Manifest, RuleSource
from hedon.record.network import Networks
from hedon.record.reader import Run


@dataclass(frozen=True)
class Past:
    """A world at a checkpoint, from which other worlds continue, each with its own random numbers.

    Attributes:
        run: Folder of the world's run.
        step: Step of the checkpoint [step].
        seed: Seed of the world.
    """

    run: Path
    step: int
    seed: int


@dataclass
class Demand:
    """A condition with the worlds of it that are needed.

    Attributes:
        config: Settings of the condition.
        digest: Digest of the config; conditions with equal digests share their worlds.
        steps: Steps needed of each seed's world [step].
        frames: Steps between two records of all positions; 0 if they are not needed [step].
        founders: Genomes of the founders; None to draw them from the config's distributions.
        networks: Networks of agents that never learn; None for new ones.
        rules: Source texts of the rules to which the config is pinned.
        name: Name of the folder of a new run; empty for a name derived from the settings.
        past: The past that its worlds share; None if each world starts at step 0.
    """

    config: Config
    digest: str
    steps: dict[int, int] = field(default_factory=dict)
    frames: int = 0
    founders: Founders | None = None
    networks: Networks | None = None
    rules: Sequence[RuleSource] = ()
    name: str = ""
    past: Past | None = None

    def holds(self, manifest: Manifest) -> bool:
        """Whether the worlds of a run have these settings and this past."""
        parent, past = manifest.parent, self.past
        # The name of the parent's folder does not matter: config, seed and step determine the world.
        actual_past = None if parent is None else (parent.config_digest, parent.step, parent.seed)
        expected_past = None if past is None else (self.digest, past.step, past.seed)
        return manifest.config_digest == self.digest and actual_past == expected_past

    def has_frames(self, run: Run) -> bool:
        """Whether a run recorded all positions that are needed."""
        interval = run.manifest.frames
        return self.frames == 0 or (interval > 0 and self.frames % interval == 0)


def worlds_of(demands: Sequence[Demand]) -> int:
    """The number of worlds in some demands."""
    return sum(len(demand.steps) for demand in demands)


def parse_part(text: str | None) -> tuple[int, int]:
    """Parses a part such as "3/10" into its number, from 1, and the number of parts; None stands for everything.

    Raises:
        EnsembleError: The text is not a part.
    """
    if text is None:
        return 1, 1
    first, _, second = text.partition("/")
    if first.isdecimal() and second.isdecimal() and len(text) < 20 and 1 <= int(first) <= int(second):
        return int(first), int(second)
    raise EnsembleError(f"--part = {text!r}: must be I/N, the part I of N, as in 3/10")


def part_of(demands: Sequence[Demand], part: tuple[int, int]) -> list[Demand]:
    """The worlds of one of several machines: every N-th world, starting with the I-th.

    The part's number is added to the names of named runs, so that machines do not share a folder.

    Args:
        demands: All worlds that are needed.
        part: Number I of the part, from 1, and the number N of parts.
    """
    number, count = part
    if count == 1:
        return list(demands)
    worlds = [(demand, seed) for demand in demands for seed in demand.steps][number - 1 :: count]
    shares = [
        replace(
            demand,
            steps={seed: demand.steps[seed] for owner, seed in worlds if owner is demand},
            name=demand.name and f"{demand.name}-{number}",
        )
        for demand in demands
    ]
    return [share for share in shares if share.steps]


def setting_name(config: Config) -> str:
    """The unique name of a condition: its preset and fidelity, and the settings that it changes."""
    words = [f"{path} {format_value(new)}" for path, _, new in changed_settings(config)]
    return ", ".join([f"{config.preset} ({config.fidelity})", *words])
