"""Which worlds are wanted: settings, seeds and steps, all of them or the share of one machine."""

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
    """A world at a checkpoint, from which other worlds go on, each with chances of its own.

    Attributes:
        run: folder of the world's run.
        step: of the checkpoint [step].
        seed: of the world.
    """

    run: Path
    step: int
    seed: int


@dataclass
class Demand:
    """A setting that worlds are needed of, by one question or several.

    Attributes:
        config: the setting.
        digest: of the config: settings of equal digest share their worlds.
        steps: of each seed [step].
        frames: steps between two records of all positions; 0 where nobody needs them.
        founders: genomes that its worlds begin with; None where they are drawn from the setting's laws.
        networks: that agents begin with that never learn; None for new ones.
        rules: texts of the rules that the config is pinned to.
        name: of the folder of a new run; empty for one that tells the setting from all others.
        past: that its worlds share; None where each begins at its own beginning.
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
        """Whether the worlds of a run are of this setting and have this past."""
        parent, past = manifest.parent, self.past
        # The name of the old run's folder does not matter: setting, seed and step determine the world.
        begun = None if parent is None else (parent.config_digest, parent.step, parent.seed)
        wanted = None if past is None else (self.digest, past.step, past.seed)
        return manifest.config_digest == self.digest and begun == wanted

    def has_frames(self, run: Run) -> bool:
        """Whether a run recorded the positions that are needed."""
        every = run.manifest.frames
        return self.frames == 0 or (every > 0 and self.frames % every == 0)


def worlds_of(demands: Sequence[Demand]) -> int:
    """How many worlds some demands ask for."""
    return sum(len(demand.steps) for demand in demands)


def parse_part(text: str | None) -> tuple[int, int]:
    """The number of a part, from 1 on, and how many there are, from "3/10"; all of it for None.

    Raises:
        EnsembleError: the text is not such a part.
    """
    if text is None:
        return 1, 1
    first, _, second = text.partition("/")
    if first.isdecimal() and second.isdecimal() and len(text) < 20 and 1 <= int(first) <= int(second):
        return int(first), int(second)
    raise EnsembleError(f"--part = {text!r}: must be I/N, the part I of N, as in 3/10")


def part_of(demands: Sequence[Demand], part: tuple[int, int]) -> list[Demand]:
    """The share of some worlds that one of several machines makes: every N-th world, from the I-th on.

    Folders of named runs have the part's number in their names, so that machines do not meet in one.
    """
    number, count = part
    if count == 1:
        return list(demands)
    worlds = [(demand, seed) for demand in demands for seed in demand.steps][number - 1 :: count]
    shares = [
        replace(
            demand,
            steps={seed: demand.steps[seed] for of, seed in worlds if of is demand},
            name=demand.name and f"{demand.name}-{number}",
        )
        for demand in demands
    ]
    return [share for share in shares if share.steps]


def setting_name(config: Config) -> str:
    """What a setting is called: its preset and fidelity, and what it changes; no two settings have one name."""
    words = [f"{path} {format_value(new)}" for path, _, new in changed_settings(config)]
    return ", ".join([f"{config.preset} ({config.fidelity})", *words])
